"""The unit of work: one task, read once, through some modes and discounts."""

from dataclasses import dataclass
from fractions import Fraction
from pathlib import Path
from time import perf_counter, time
from typing import Final

from serendipity.evaluation.reproduction.rows import Row, exact_cost
from serendipity.facade.loading import load
from serendipity.facade.planning import plan
from serendipity.model import Deadline, Result, Task
from serendipity.model.errors import LIMITS

_TIED: Final = ("serendipity",)
"""Modes whose cost depends on which of the human's optimal plans the human follows."""


@dataclass(frozen=True, slots=True)
class Call:
    """What to solve a task with."""

    mode: str
    discount: Fraction


@dataclass(frozen=True, slots=True)
class Limits:
    """Limits that other processes can be told.

    Attributes:
        time_limit: seconds for reading a task, and for each call; or None.
        memory_limit: what a process may have in memory, in MiB, or None.
        until: when the whole run has to be over, by the clock of ``time.time()``, or None.
    """

    time_limit: float | None = None
    memory_limit: float | None = None
    until: float | None = None

    def from_now(self) -> Deadline:
        """The limits of what begins now."""
        left = None if self.until is None else max(self.until - time(), 0.0)
        return Deadline(left).within(self.time_limit, self.memory_limit)


@dataclass(frozen=True, slots=True)
class Assignment:
    """A task, the calls that are still to be made for it, and their limits."""

    test: str
    path: Path
    fingerprint: str
    calls: tuple[Call, ...]
    limits: Limits


@dataclass(frozen=True, slots=True)
class TaskRows:
    """What an assignment came to."""

    test: str
    fingerprint: str
    rows: tuple[Row, ...]


def solve(assignment: Assignment) -> TaskRows:
    """Read the task and make the calls; what a limit leaves no time or memory for is ``unknown``.

    Raises:
        InputError: a file of the task is wrong.
    """
    try:
        task = load(assignment.path, deadline=assignment.limits.from_now())
    except LIMITS:
        rows = tuple(unknown(assignment.test, call) for call in assignment.calls)
    else:
        rows = tuple(_row(assignment, task, call) for call in assignment.calls)
    return TaskRows(assignment.test, assignment.fingerprint, rows)


def unknown(test: str, call: Call) -> Row:
    """The row of a call that a limit left no time for."""
    return Row(
        test=test,
        mode=call.mode,
        discount=call.discount,
        status="unknown",
        cost=None,
        human_cost=None,
        opportunity=False,
        window=None,
        seconds=0.0,
        best_tie=None,
        worst_tie=None,
    )


def _row(assignment: Assignment, task: Task, call: Call) -> Row:
    start, limits = perf_counter(), assignment.limits.from_now()
    result = plan(task, mode=call.mode, discount=call.discount, deadline=limits)
    seconds = perf_counter() - start
    best, worst = _ties(task, call, result, limits)
    return Row(
        test=assignment.test,
        mode=call.mode,
        discount=call.discount,
        status=result.status,
        cost=exact_cost(result.cost),
        human_cost=exact_cost(result.human_cost),
        opportunity=result.opportunity,
        window=result.window,
        seconds=seconds,
        best_tie=best,
        worst_tie=worst,
    )


def _ties(
    task: Task, call: Call, result: Result, limits: Deadline
) -> tuple[Fraction | None, Fraction | None]:
    """Least and greatest cost over the human's optimal plans."""
    if call.mode not in _TIED or result.cost is None:
        return exact_cost(result.cost), exact_cost(result.cost)
    best, worst = (
        plan(task, mode=call.mode, discount=call.discount, ties=ties, deadline=limits)
        for ties in ("optimistic", "robust")
    )
    if best.status != "optimal" or worst.status != "optimal":
        return None, None
    return exact_cost(best.cost), exact_cost(worst.cost)
