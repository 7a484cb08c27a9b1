"""Windows and the steps of composite plans."""

from dataclasses import dataclass
from typing import Any

from serendipity.model.errors import UsageError


@dataclass(frozen=True, slots=True, order=True)
class Window:
    """The half-open interval of epochs ``[start, end)`` (xi1, xi2 of the paper; semantics 3.1).

    Raises:
        UsageError: not ``1 <= start < end``.
    """

    start: int
    end: int

    def __post_init__(self) -> None:
        if not 1 <= self.start < self.end:
            raise UsageError(f"window: expected 1 <= start < end, got [{self.start}, {self.end})")

    def __len__(self) -> int:
        return self.end - self.start

    def to_dict(self) -> dict[str, Any]:
        """The JSON object."""
        return {"start": self.start, "end": self.end}


@dataclass(frozen=True, slots=True, order=True)
class Step:
    """An action in an epoch of a composite plan; a joint action is one step."""

    epoch: int
    action: int


@dataclass(frozen=True, slots=True)
class PlanStep:
    """One action of a reported plan; a joint action is one step with all its agents.

    Attributes:
        epoch: from 1.
        agents: names of the participants.
        action: its PDDL text without brackets.
        cost: what it costs the team, discounted, in the domain's unit.
    """

    epoch: int
    agents: tuple[str, ...]
    action: str
    cost: float

    def to_dict(self) -> dict[str, Any]:
        """The JSON object of a step; plain values only."""
        return {
            "epoch": self.epoch,
            "agents": list(self.agents),
            "action": self.action,
            "cost": self.cost,
        }
