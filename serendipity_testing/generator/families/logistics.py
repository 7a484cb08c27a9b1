"""Parcels that several vehicles deliver."""

from collections.abc import Sequence
from itertools import pairwise, permutations
from random import Random

from serendipity.model import Task
from serendipity_testing.builders import Builder
from serendipity_testing.generator.families.parts import pairs, prices, with_goals

_Roads = list[tuple[str, str]]


def logistics(dice: Random, size: int, agents: tuple[str, ...]) -> Task:
    """Parcels to deliver; agents, the human first, are vehicles with roads and room for one, two or all.

    One parcel may take two to load it, and a pair of vehicles may reload where they meet.
    """
    price = prices(dice)
    places = [f"p{i}" for i in range(dice.randint(2, 3) + size // 3)]
    roads = [(dice.choice(places[:i]), places[i]) for i in range(1, len(places))]
    parcels = {f"b{k}": dice.choice(places) for k in range(size)}
    heavy = dice.choice(list(parcels)) if dice.random() < 0.2 else ""
    fleet = [_Vehicle(dice, agents, who, roads) for who in range(len(agents))]
    builder, start = Builder(agents, "logistics"), []
    for parcel, place in parcels.items():
        holder = dice.choice(fleet)
        aboard = dice.random() < 0.15 and holder.takes()
        start.append(f"in_{parcel}_{holder.name}" if aboard else f"at_{parcel}_{place}")
    for vehicle in fleet:
        start += [f"at_{vehicle.name}_{dice.choice(vehicle.places)}", *vehicle.level]
        vehicle.drive(builder, price())
        for parcel in parcels:
            helped = dice.choice([pair for pair in pairs(agents) if vehicle.who in pair])
            vehicle.carry(builder, parcel, helped if parcel == heavy else (vehicle.who,), price(), price())
    pair = dice.choice(pairs(agents))
    if dice.random() < 0.3:
        _reload(builder, [fleet[who] for who in pair], list(parcels), price())
    wanted = {parcel: dice.choice([p for p in places if p != place]) for parcel, place in parcels.items()}
    asked = dice.sample(list(parcels), dice.choice((size, dice.randint(1, size))))
    goal = [f"at_{parcel}_{wanted[parcel]}" for parcel in asked]
    if dice.random() < 0.25:
        goal.append(f"at_{agents[0]}_{dice.choice(fleet[0].places)}")
    wishes = [f"at_{parcel}_{place}" for parcel, place in wanted.items() if parcel not in asked]
    wishes += [f"at_{vehicle.name}_{dice.choice(vehicle.places)}" for vehicle in fleet[1:]]
    return with_goals(dice, builder, start, goal, wishes)


class _Vehicle:
    """An agent that drives."""

    def __init__(self, dice: Random, agents: tuple[str, ...], who: int, roads: _Roads) -> None:
        self.who, self.name = who, agents[who]
        self.room = dice.choice((0, 0, 1, 2))
        """For so many parcels; 0 for all."""
        self._left = self.room
        self._roads = roads if dice.random() < 0.7 else dice.sample(roads, dice.randint(1, len(roads)))
        self.places = sorted({place for road in self._roads for place in road})

    @property
    def level(self) -> list[str]:
        """The fact that says how much room is left."""
        return [f"room_{self.name}_{self._left}"] if self.room else []

    def takes(self) -> bool:
        """Take a parcel from the start, if there is room for it."""
        if self.room and not self._left:
            return False
        self._left -= 1
        return True

    def drive(self, builder: Builder, cost: str) -> None:
        """Along roads, both ways."""
        for road in self._roads:
            for here, there in permutations(road):
                where = f"at_{self.name}_{here}"
                builder.action(
                    f"drive_{here}_{there}", (self.who,), where, f"at_{self.name}_{there} !{where}", cost
                )

    def carry(self, builder: Builder, parcel: str, team: tuple[int, ...], up: str, down: str) -> None:
        """Load it, where all of the team are, and unload it; both for each level of room."""
        inside = f"in_{parcel}_{self.name}"
        into = f"_{self.name}" if len(team) > 1 else ""
        for place in self.places:
            outside, there = f"at_{parcel}_{place}", f"at_{self.name}_{place}"
            met = " ".join(f"at_{builder.agents[who]}_{place}" for who in team)
            for more, less, level in self._levels():
                what = f"{parcel}_{place}{level}"
                taken, left = f"{inside} !{outside}", f"{outside} !{inside}"
                if level:
                    taken, left = f"{taken} {less} !{more}", f"{left} {more} !{less}"
                builder.action(f"load_{what}{into}", team, f"{met} {outside} {more}", taken, up)
                builder.action(f"unload_{what}", (self.who,), f"{there} {inside} {less}", left, down)

    def _levels(self) -> list[tuple[str, str, str]]:
        """Facts of room before loading and after it, and what tells the actions apart."""
        if not self.room:
            return [("", "", "")]
        levels = [f"room_{self.name}_{k}" for k in range(self.room + 1)]
        return [(more, less, f"_{k}") for k, (less, more) in enumerate(pairwise(levels))]


def _reload(builder: Builder, pair: Sequence[_Vehicle], parcels: Sequence[str], cost: str) -> None:
    """From one vehicle into the other where both are, as long as both have room for all."""
    one, other = pair
    if one.room or other.room:
        return
    for giver, taker in permutations(pair):
        for parcel in parcels:
            for place in sorted({*giver.places} & {*taker.places}):
                inside = f"in_{parcel}_{giver.name}"
                builder.action(
                    f"reload_{parcel}_{place}_{taker.name}",
                    (one.who, other.who),
                    f"at_{giver.name}_{place} at_{taker.name}_{place} {inside}",
                    f"in_{parcel}_{taker.name} !{inside}",
                    cost,
                )
