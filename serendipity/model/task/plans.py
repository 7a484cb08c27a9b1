"""Windows, the steps of composite plans, and plans of the human's in which they wait."""

from collections.abc import Iterable
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


class TimedPlan(tuple[int, ...]):
    """A human plan with waiting in it: action ids, as other human plans, with the epochs in which they begin.

    Without waiting a plan is a plain tuple: each action begins when the one before has ended.

    Args:
        actions: ids, in order.
        starts: the epoch in which each begins, from 1.
        length: the number of epochs, waiting at the end included.
    """

    starts: tuple[int, ...]
    length: int

    def __new__(cls, actions: Iterable[int], starts: Iterable[int], length: int) -> "TimedPlan":
        """A plan; nothing is checked."""
        plan = super().__new__(cls, tuple(actions))
        plan.starts = tuple(starts)
        plan.length = length
        return plan

    def __getnewargs__(self) -> tuple[Any, ...]:
        return tuple(self), self.starts, self.length

    def __eq__(self, other: object) -> bool:
        same = isinstance(other, TimedPlan) and (self.starts, self.length) == (other.starts, other.length)
        return same and tuple(self) == tuple(other)  # type: ignore[arg-type]

    def __ne__(self, other: object) -> bool:
        return not self == other

    def __hash__(self) -> int:
        return hash((tuple(self), self.starts, self.length))

    def __repr__(self) -> str:
        return f"TimedPlan({tuple(self)}, {self.starts}, {self.length})"


PlanEntry = str | tuple[int, str]
"""An action's name, or the epoch in which it begins, from 1, and its name."""


def checked_entries(entries: Iterable[PlanEntry], what: str) -> tuple[PlanEntry, ...]:
    """The entries of a plan that is given: all of them names, or all of them with epochs.

    Args:
        entries: a list, or whatever can be gone through.
        what: how an error calls it.

    Raises:
        UsageError: it is a text, or has something else in it.
    """
    listed = isinstance(entries, Iterable) and not isinstance(entries, str)
    found = tuple(entries) if listed else ()
    timed = [_timed(entry) for entry in found]
    if not listed or not all(isinstance(e, str) or t is not None for e, t in zip(found, timed, strict=True)):
        raise UsageError(f"{what}: expected a list of names, got {entries!r:.50}")
    if not any(timed):
        return found
    if not all(timed):
        raise UsageError(f"{what}: expected an epoch with each action, or with none of them")
    return tuple(entry for entry in timed if entry is not None)


def _timed(entry: object) -> tuple[int, str] | None:
    if not (isinstance(entry, tuple | list) and len(entry) == 2):
        return None
    epoch, name = entry
    whole = isinstance(epoch, int) and not isinstance(epoch, bool)
    return (epoch, name) if whole and isinstance(name, str) else None
