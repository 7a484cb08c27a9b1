"""Where agents and objects are in a state, in vehicles too."""

from typing import Final

from serendipity.model import GroundAction
from serendipity.model.task.actions import State
from serendipity.show.map.places import Places, Whereabouts

NOWHERE: Final = Whereabouts()


class Finder:
    """Where agents and objects are.

    Args:
        places: the map of their task.
    """

    def __init__(self, places: Places) -> None:
        self._places = places

    def agents(self, state: State) -> dict[int, str]:
        """The place of each agent that is in one; who rides is where the vehicle is."""
        found = {}
        for agent, places in self._places.positions.items():
            place = next((place for f, place in places.items() if f in state), None)
            if place is None and agent in self._places.riding:
                place = self._vehicle_at(self._places.riding[agent], state)
            if place is not None:
                found[agent] = place
        return found

    def _vehicle_at(self, riding: dict[int, str], state: State) -> str | None:
        told = next((self._places.objects[name] for f, name in riding.items() if f in state), {})
        return next((where.place for f, where in told.items() if f in state), None)

    def objects(self, state: State) -> dict[str, Whereabouts]:
        """Where each object is.  Who rides is drawn instead of the vehicle, and holds what it carries."""
        told = {
            name: next((where for f, where in of.items() if f in state), NOWHERE)
            for name, of in self._places.objects.items()
        }
        riders = {
            vehicle: Whereabouts(holder=agent)
            for agent, riding in self._places.riding.items()
            for f, vehicle in riding.items()
            if f in state
        }
        told |= riders
        for _ in told:  # what is in a box in a van is where the van is
            told = {name: told[where.carrier] if where.carrier else where for name, where in told.items()}
        return told | dict.fromkeys(riders, NOWHERE)

    def places_of(self, action: GroundAction, agent: int) -> dict[int, str]:
        """Facts that tell where an agent is while it acts, with the place."""
        found = dict(self._places.positions.get(agent, {}))
        for vehicle in self.vehicles(action, agent):
            told = self._places.objects[vehicle]
            found |= {f: where.place for f, where in told.items() if where.place is not None}
        return found

    def vehicles(self, action: GroundAction, agent: int) -> list[str]:
        """What an agent is in or on while it acts."""
        riding = self._places.riding.get(agent, {})
        return [riding[f] for f in action.pre if f in riding and f not in action.delete]
