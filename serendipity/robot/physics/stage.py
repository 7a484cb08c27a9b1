"""An adapter whose robots are figures in physics, in the building of the task."""

from collections.abc import Iterator, Mapping, Sequence
from itertools import product
from math import cos, sin
from typing import Final

from serendipity.model import GroundAction, Task, UsageError
from serendipity.model.task.actions import apply
from serendipity.model.task.execution import variant_named
from serendipity.pictures.map.layout import lay_out
from serendipity.pictures.map.names import parts
from serendipity.pictures.map.places import Whereabouts, find_places
from serendipity.pictures.scene.finder import Finder
from serendipity.robot.adapter import Epoch, Order, Report
from serendipity.robot.physics import deeds
from serendipity.robot.physics.building import CELL, Point, Rooms
from serendipity.robot.physics.deeds import Deed, StuckError, in_turn, together
from serendipity.robot.physics.engine import RATE, Colour, Engine
from serendipity.robot.physics.figure import Kit, Walker
from serendipity.robot.physics.film import Film

EPOCH: Final = 5.0
"""Seconds of an epoch."""

_PERSON: Final[tuple[Colour, Colour]] = (0.9, 0.48, 0.1, 1), (0.97, 0.82, 0.2, 1)
_ROBOTS: Final[tuple[Colour, ...]] = ((0.2, 0.38, 0.85, 1), (0.1, 0.55, 0.5, 1), (0.55, 0.25, 0.7, 1))
_FACE: Final[Colour] = (0.92, 0.92, 0.96, 1)
_SPEED: Final = 0.3
_PERSONS_SPEED: Final = 0.36
_LONGEST: Final = 3
"""Epochs that an epoch lasts at most, where the person needs so long."""


class Stage:
    """Figures in a building.

    Args:
        task: where things stand; it has to have a map.
        epoch: how many seconds an epoch lasts at least, 5 by default, until the person is done, too.
        rubble: kilograms of it in doorways, by pairs of places.

    Raises:
        UsageError: pybullet is missing, there is no such doorway, or the task has no map.
    """

    def __init__(
        self,
        task: Task,
        *,
        epoch: float | None = None,
        rubble: Mapping[tuple[str, str], float] | None = None,
        film: Film | None = None,
    ) -> None:
        places = find_places(task)
        self._finder = Finder(places)
        agents = self._finder.agents(task.init)
        if not agents:
            raise UsageError("adapter: pybullet is for tasks with a map, on which agents are somewhere")
        self._task = task
        self._epoch = EPOCH if epoch is None else epoch
        self._engine = engine = Engine()
        self._building = Rooms(engine, lay_out(places))
        self._figures = {agent: self._figure(agent, place) for agent, place in agents.items()}
        self._kits: dict[str, Kit] = {}
        medkits = _medkits(task)
        for number, name in enumerate(places.objects):
            self._kits[name] = Kit(engine, _shelf((-2.0, 0.0), number), first_aid=name in medkits)
        self._begun: dict[Order, _Errand] = {}
        for pair, kilograms in (rubble or {}).items():
            self._heap(*pair, kilograms)
        bodies = [figure.body for figure in self._figures.values()]
        for one, other in product(bodies, bodies):  # figures are not in each other's way
            engine.call("setCollisionFilterPair", one, other, -1, -1, 0)
        self._settle(task.init)
        self._film = film
        if film is not None:
            named = {task.agents[agent]: figure for agent, figure in self._figures.items()}
            film.begin(engine, self._building, named, self._kits)

    # -- the adapter

    def execute(self, epoch: Epoch) -> Sequence[Report]:
        """See :class:`serendipity.robot.Adapter`."""
        self._settle(epoch.state)
        kept = {order: self._begun.get(order) or self._errand(order, epoch.state) for order in epoch.orders}
        person = (self._task.agents[self._task.human],)
        own = None if epoch.human is None else self._errand(Order(person, epoch.human), epoch.state)
        errands = [*kept.values(), *([] if own is None else [own])]
        for moment in range(round(_LONGEST * self._epoch * RATE)):
            if moment >= self._epoch * RATE and (own is None or own.over):
                break
            self._moment(epoch.number, errands)
        self._begun = {order: errand for order, errand in kept.items() if not errand.over}
        return [errand.report() for errand in kept.values()]

    def close(self) -> None:
        """See :class:`serendipity.robot.Adapter`."""
        self._engine.close()

    # -- moments

    def _moment(self, epoch: int, errands: "Sequence[_Errand]") -> None:
        busy: set[int] = set()
        for errand in errands:
            if errand.go_on():
                busy |= errand.agents
        for agent, figure in self._figures.items():
            if agent not in busy:
                figure.rest()
        self._engine.step()
        if self._film is not None:
            self._film.watch(epoch)

    # -- from actions to deeds

    def _errand(self, order: Order, state: frozenset[int]) -> "_Errand":
        action = self._task.actions[variant_named(self._task, order.action, order.agents, state)]
        agents = frozenset(agent for agent in action.participants if agent in self._figures)
        return _Errand(agents, in_turn(self._deeds(action, state)))

    def _deeds(self, action: GroundAction, state: frozenset[int]) -> Iterator[Deed]:
        """What an action comes to: go where it begins, then where it leads, and do what it does to things."""
        after = apply(state, action)
        here, there = self._finder.agents(state), self._finder.agents(after)
        agents = [agent for agent in action.participants if agent in self._figures]
        moved = [agent for agent in agents if here.get(agent) != there.get(agent)]
        yield together(
            [self._to(agent, here[agent]) for agent in agents if agent not in moved and agent in here]
        )
        yield together([self._to(agent, there[agent]) for agent in moved if agent in there])
        things = list(self._things(state, after))
        yield from things
        if not moved and not things:
            yield deeds.wait([self._figures[agent] for agent in agents], deeds.WORK)

    def _things(self, state: frozenset[int], after: frozenset[int]) -> Iterator[Deed]:
        before, then = self._finder.objects(state), self._finder.objects(after)
        for name, kit in self._kits.items():
            was, will = self._holder(before[name]), self._holder(then[name])
            if was is will:
                continue
            if was is None:
                assert will is not None
                yield deeds.take(will, _SPEED, kit)
            else:
                yield deeds.put(was, kit) if will is None else deeds.hand(was, will, _SPEED, kit)

    def _holder(self, where: Whereabouts) -> Walker | None:
        return None if where.holder is None else self._figures.get(where.holder)

    def _to(self, agent: int, place: str) -> Deed:
        """Walk to one's spot in a place, from wherever one is."""
        figure, building = self._figures[agent], self._building
        here = building.place_at(figure.at)
        points = [*(building.way(here, place) if here != place else ()), self._spot(agent, place)]
        speed = _PERSONS_SPEED if agent == self._task.human else _SPEED
        return in_turn(deeds.walk(figure, speed, point, place) for point in points)

    # -- where things stand

    def _figure(self, agent: int, place: str) -> Walker:
        colours = _PERSON
        if agent != self._task.human:
            colours = _ROBOTS[self._task.robots.index(agent) % len(_ROBOTS)], _FACE
        return Walker(self._engine, self._spot(agent, place), *colours)

    def _spot(self, agent: int, place: str) -> Point:
        """Where in a place an agent stands, so that nobody is in anybody's way."""
        x, y = self._building.middles[place]
        across = 0.22 * (2 * agent / max(1, len(self._task.agents) - 1) - 1)
        return x + across, y + (0.13 if agent % 2 else -0.13)

    def _settle(self, state: frozenset[int]) -> None:
        """Things are where the world has them, whoever has brought them there."""
        for number, (name, where) in enumerate(self._finder.objects(state).items()):
            kit, holder = self._kits[name], self._holder(where)
            if holder is not None and kit.holder is not holder:
                kit.put(holder.at)
                kit.take(holder)
            elif where.place is not None and where.place in self._building.middles:
                lies = kit.holder is None and self._building.place_at(kit.place[:2]) == where.place
                if not (lies and kit.place[0] > -CELL / 2):
                    kit.put(_shelf(self._building.middles[where.place], number))

    def _heap(self, a: str, b: str, kilograms: float) -> None:
        way = self._building.way(a, b) if {a, b} <= self._building.middles.keys() else ()
        if not way:
            raise UsageError(f"rubble: there is no doorway between {a} and {b}")
        x, y = (way[1][0] + way[2][0]) / 2, (way[1][1] + way[2][1]) / 2
        self._engine.box((0.3, 0.3, 0.12), (x, y, 0.06), (0.45, 0.42, 0.4, 1), kilograms)


def _shelf(middle: Point, number: int) -> Point:
    """Where in a place the thing of that number lies: round the edge."""
    angle = 0.7 + 1.1 * number
    radius = 0.225 / max(abs(cos(angle)), abs(sin(angle)), 0.75)
    return middle[0] + radius * cos(angle), middle[1] + radius * sin(angle)


def _medkits(task: Task) -> frozenset[str]:
    """What takes part in actions that speak of a medkit (``pick_up_medkit robot mk1 room3``)."""
    named = (parts(action.name) for action in task.actions)
    return frozenset(word for schema, *rest in named if "medkit" in schema for word in rest)


class _Errand:
    """A deed for an order: whose, how long for, and what became of it."""

    def __init__(self, agents: frozenset[int], deed: Deed) -> None:
        self.agents = agents
        self._deed = deed
        self._moments = 0
        self._failed = ""
        self.over = False

    def go_on(self) -> bool:
        """One more moment; whether it is at it still."""
        if self.over:
            return False
        self._moments += 1
        try:
            next(self._deed)
        except StopIteration:
            self.over = True
        except StuckError as stuck:
            self.over, self._failed = True, str(stuck)
        return not self.over

    def report(self) -> Report:
        """What there is to say at the end of an epoch."""
        seconds = round(self._moments / RATE, 2)
        if not self.over:
            return Report("running", seconds)
        return Report("failed" if self._failed else "done", seconds, self._failed)
