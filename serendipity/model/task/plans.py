"""Windows, the steps of composite plans, and plans of the human's in which they wait."""

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any

from serendipity.model.errors import PlanError, UsageError
from serendipity.model.task.actions import NOOP


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
        duration: epochs that it takes; in JSON only where it is not 1.
    """

    epoch: int
    agents: tuple[str, ...]
    action: str
    cost: float
    duration: int = 1

    @property
    def end(self) -> int:
        """The epoch with which it ends."""
        return self.epoch + self.duration - 1

    def to_dict(self) -> dict[str, Any]:
        """The JSON object of a step; plain values only."""
        longer = {} if self.duration == 1 else {"duration": self.duration}
        return {
            "epoch": self.epoch,
            "agents": list(self.agents),
            "action": self.action,
            "cost": self.cost,
            **longer,
        }


@dataclass(frozen=True, slots=True)
class PlanTimes:
    """The times of a reported human plan, where actions take several epochs or the human waits.

    Attributes:
        starts: the epoch in which each action begins, from 1.
        durations: epochs that each takes.
        epochs: the length of the plan, waiting at its end included.

    Raises:
        UsageError: the lists differ in length, an action begins before the one before has ended, or the plan
            is shorter than what is in it.
    """

    starts: tuple[int, ...]
    durations: tuple[int, ...]
    epochs: int

    def __post_init__(self) -> None:
        if len(self.starts) != len(self.durations):
            numbers = f"{len(self.starts)} and {len(self.durations)}"
            raise UsageError(f"times: expected as many starts as durations, got {numbers}")
        over = 0
        for start, duration in zip(self.starts, self.durations, strict=True):
            if start <= over:
                raise UsageError(f"times: expected an epoch from {over + 1} on, got {start}")
            over = start + duration - 1
        if self.epochs < over:
            raise UsageError(f"times: expected at least {over} epochs, got {self.epochs}")

    @property
    def plain(self) -> bool:
        """Whether they say no more than the order of the actions: each takes one epoch, none is left out."""
        count = len(self.starts)
        return self.starts == (*range(1, count + 1),) and self.epochs == sum(self.durations) == count

    @property
    def waits_at_end(self) -> bool:
        """Whether the human waits after the last action."""
        return self.epochs > (self.starts[-1] + self.durations[-1] - 1 if self.starts else 0)

    def entries(self, names: "Iterable[str]") -> "tuple[PlanEntry, ...]":
        """The plan as callers give it: names with epochs; a last ``noop`` says until when they wait."""
        return (*self.timed(names),)

    def timed(self, names: "Iterable[str]") -> list[tuple[int, str]]:
        """The same as a list of pairs."""
        return [*zip(self.starts, names, strict=True), *([(self.epochs, NOOP)] if self.waits_at_end else [])]


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


def unknown_action(step: int, name: str) -> PlanError:
    """The error of a human plan that has an action which the task has not."""
    return PlanError(f"human plan, step {step}: there is no action '{name}' in the task", step=step)


def left_after(entries: Iterable[PlanEntry], epochs: int) -> tuple[tuple[int, str], ...]:
    """What is left of the entries of a plan with epochs when some of these have passed."""
    timed = (entry for entry in entries if not isinstance(entry, str))
    return tuple((epoch - epochs, name) for epoch, name in timed if epoch > epochs)


def checked_entries(entries: Iterable[PlanEntry], what: str) -> tuple[PlanEntry, ...]:
    """The entries of a plan that is given: all of them names, or all of them with epochs.

    Args:
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
