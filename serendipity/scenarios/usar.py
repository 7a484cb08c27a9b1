"""A search-and-rescue task (the paper's section II) before it is PDDL: who and what is where."""

from dataclasses import dataclass
from typing import Final

from serendipity.model.errors import UsageError
from serendipity.scenarios.building import Building

HUMAN: Final = "commx"


@dataclass(frozen=True, slots=True)
class Usar:
    """A building, its agents, its medkits, and where the human has to conduct triage.

    Attributes:
        name: the PDDL problem's name.
        building: the map.
        robots: names of the robots; the human is ``commx``.
        agents_at: location of each agent, the human first.
        medkits_at: location of each medkit: ``mk1``, ``mk2``...
        triage_in: where the human has to conduct triage.

    Raises:
        UsageError: a location is not in the building, or positions and agents differ in number.
    """

    name: str
    building: Building
    robots: tuple[str, ...]
    agents_at: tuple[str, ...]
    medkits_at: tuple[str, ...]
    triage_in: str

    def __post_init__(self) -> None:
        if len(self.agents_at) != len(self.robots) + 1:
            raise UsageError("usar: expected one position for each agent")
        known = set(self.building.locations)
        for place in (*self.agents_at, *self.medkits_at, self.triage_in):
            if place not in known:
                raise UsageError(f"usar: there is no location '{place}' in the building")

    @property
    def agents(self) -> dict[str, str]:
        """Location of each agent by name, the human first."""
        return dict(zip((HUMAN, *self.robots), self.agents_at, strict=True))

    @property
    def medkits(self) -> dict[str, str]:
        """Location of each medkit by name."""
        return {f"mk{i}": place for i, place in enumerate(self.medkits_at, start=1)}
