"""Where agents and objects are in a state, in vehicles too."""

from collections import defaultdict
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from itertools import chain

from serendipity.model import GroundAction
from serendipity.model.task.actions import State
from serendipity.pictures.map.names import Parts, parts, verb_and_rest, without
from serendipity.pictures.map.places import Places, Whereabouts


class Finder:
    """Where agents and objects are."""

    def __init__(self, places: Places) -> None:
        self._places = places

    def shown(self, state: State, going: Iterable[GroundAction]) -> State:
        """A state in which all is where it was until what moves it, and still goes on, has ended."""
        facts = self._places.facts
        timings = [action.timing for action in going if action.timing is not None]
        left = [t.start_delete for t in timings if facts.isdisjoint(t.start_add)]
        return state | facts.intersection(chain.from_iterable(left))

    def agents(self, state: State) -> dict[int, str]:
        """The place of each agent that is in one; who rides is where the vehicle is."""
        found: dict[int, str] = {}
        for agent in sorted(self._places.positions.keys() | self._places.riding.keys()):
            places = self._places.positions.get(agent, {})
            place = next((place for f, place in places.items() if f in state), None)
            if place is None:
                ridden = (name for f, name in self._places.riding.get(agent, {}).items() if f in state)
                told = self._places.objects.get(next(ridden, ""), {})
                place = next((where.place for f, where in told.items() if f in state), None)
            if place is not None:
                found[agent] = place
        return found

    def objects(self, state: State) -> dict[str, Whereabouts]:
        """Where each object is, who rides it, and who holds or rides what carries it."""
        told = {
            name: next((where for f, where in of.items() if f in state), Whereabouts())
            for name, of in self._places.objects.items()
        }
        riders: dict[str, tuple[int, ...]] = defaultdict(tuple)
        for agent, riding in self._places.riding.items():
            vehicle = next((name for f, name in riding.items() if f in state), None)
            if vehicle is not None:
                riders[vehicle] += (agent,)
        return {name: self._resolved(name, told, riders) for name in told}

    def _resolved(
        self, name: str, told: dict[str, Whereabouts], riders: Mapping[str, tuple[int, ...]]
    ) -> Whereabouts:
        """Where an object is: what is in a box in a van is where the van is, and with who rides it."""
        where = told[name]
        for _ in told:
            if where.carrier is None or where.carrier not in told:
                break
            aboard = riders.get(where.carrier)
            where = Whereabouts(holder=aboard[0]) if aboard else told[where.carrier]
        return replace(where, carrier=told[name].carrier, riders=riders.get(name, ()))

    def places_of(self, action: GroundAction, agent: int) -> dict[int, str]:
        """Facts that tell where an agent is while it acts, with the place."""
        found = dict(self._places.positions.get(agent, {}))
        for vehicle in self.vehicles(action, agent):
            told = self._places.objects[vehicle]
            found |= {f: where.place for f, where in told.items() if where.place is not None}
        return found

    def target(self, action: GroundAction, agent: int) -> str | None:
        """The place that an agent's own action leads to; None where it leads nowhere."""
        places = {} if action.joint else self.places_of(action, agent)
        return next((places[fact] for fact in action.add if fact in places), None)

    def phrase(self, action: GroundAction, agents: Sequence[str]) -> tuple[str, str]:
        """An action in two short lines, without who does it and where they are; a move is "go to" a place."""
        place = self.target(action, action.participants[0])
        if place is not None:
            return "go to", place
        verb, detail = verb_and_rest(action.name, [agents[i] for i in action.participants])
        here: list[Parts] = []
        for agent in action.participants:
            places = self.places_of(action, agent)
            here += [parts(places[fact]) for fact in action.pre if fact in places]
            here += map(parts, self.vehicles(action, agent))
        return verb, " ".join(without(here, tuple(detail.split()))) or detail

    def vehicles(self, action: GroundAction, agent: int) -> list[str]:
        """What an agent is in or on while it acts."""
        riding = self._places.riding.get(agent, {})
        still = {riding[f] for f in action.add if f in riding}
        return [
            riding[f] for f in action.pre if f in riding and (f not in action.delete or riding[f] in still)
        ]
