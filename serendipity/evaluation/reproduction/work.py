"""The unit of work: one task, read once, through some modes and discounts."""

import logging
from fractions import Fraction
from time import perf_counter, time
from typing import Final, NamedTuple

from serendipity.evaluation.reproduction.rows import Row, exact_cost
from serendipity.evaluation.reproduction.suite import TaskFolder
from serendipity.facade.loading import load
from serendipity.facade.planning import plan
from serendipity.model import Deadline, Result, Task
from serendipity.model.errors import LIMITS, told
from serendipity.model.keywords import Ties

log = logging.getLogger("serendipity.reproduce")

_BEST_AND_WORST: Final[tuple[Ties, ...]] = ("optimistic", "robust")


class Call(NamedTuple):
    """Mode and discount of a planning call."""

    mode: str
    discount: Fraction


class Assignment(NamedTuple):
    """A task, the calls that are still to be made for it, and limits that other processes can be told.

    Attributes:
        time_limit: seconds for reading a task, and for each call; or None.
        memory_limit: what a process may have in memory, in MiB, or None.
        until: when the whole run has to be over, by the clock of ``time.time()``, or None.
    """

    task: TaskFolder
    calls: tuple[Call, ...]
    time_limit: float | None = None
    memory_limit: float | None = None
    until: float | None = None

    def from_now(self) -> Deadline:
        """The limits of what begins now."""
        left = None if self.until is None else max(self.until - time(), 0.0)
        return Deadline(left).within(self.time_limit, self.memory_limit)


class TaskRows(NamedTuple):
    """The rows of an assignment, by the task's name and fingerprint."""

    test: str
    fingerprint: str
    rows: tuple[Row, ...]


def solve(assignment: Assignment) -> TaskRows:
    """Read the task and make the calls.

    What a limit leaves no time or memory for is ``unknown``, what is broken an ``error``.
    """
    given = assignment.task
    try:
        task = load(given.path, deadline=assignment.from_now())
    except LIMITS:
        rows = tuple(unknown(given.test, call) for call in assignment.calls)
    except Exception as error:  # one broken task does not end a suite
        return failed(assignment, _logged(error))
    else:
        rows = tuple(_row(assignment, task, call) for call in assignment.calls)
    return TaskRows(given.test, given.fingerprint, rows)


def failed(assignment: Assignment, reason: str) -> TaskRows:
    """The rows of a task that could not be worked on."""
    given = assignment.task
    rows = tuple(unknown(given.test, call, "error", reason) for call in assignment.calls)
    return TaskRows(given.test, given.fingerprint, rows)


def killed(assignment: Assignment) -> TaskRows:
    """The rows of a task whose processes were killed."""
    return failed(assignment, "its process was killed, and again when it was tried once more")


def _logged(error: Exception) -> str:
    log.debug("the error came from here", exc_info=True)
    return told(error)


def unknown(test: str, call: Call, status: str = "unknown", reason: str | None = None) -> Row:
    """The row of a call that a limit left no time for, or that has no answer for another reason."""
    return Row(test, *call, status, None, None, False, None, 0.0, None, None, reason)


def _row(assignment: Assignment, task: Task, call: Call) -> Row:
    test, start, limits = assignment.task.test, perf_counter(), assignment.from_now()
    try:
        result = plan(task, deadline=limits, **call._asdict())
        seconds = perf_counter() - start
        best, worst = _ties(task, call, result, limits)
    except LIMITS:
        return unknown(test, call)
    except Exception as error:  # see above
        return unknown(test, call, "error", _logged(error))
    cost, human_cost, helps = exact_cost(result.cost), exact_cost(result.human_cost), result.opportunity
    return Row(test, *call, result.status, cost, human_cost, helps, result.window, seconds, best, worst)


def _ties(
    task: Task, call: Call, result: Result, limits: Deadline
) -> tuple[Fraction | None, Fraction | None]:
    """Least and greatest cost over the human's optimal plans, on which other modes do not depend."""
    if call.mode != "serendipity" or result.cost is None:
        return exact_cost(result.cost), exact_cost(result.cost)
    best, worst = (plan(task, ties=ties, deadline=limits, **call._asdict()) for ties in _BEST_AND_WORST)
    if best.status != "optimal" or worst.status != "optimal":
        return None, None
    return exact_cost(best.cost), exact_cost(worst.cost)
