"""The unit of work: one task, read once, through some modes and discounts."""

from dataclasses import dataclass
from fractions import Fraction
from pathlib import Path
from time import perf_counter
from typing import Final

from serendipity.model import Result, Task
from serendipity.pddl import load
from serendipity.planning import plan
from serendipity.reproduction.rows import Row, exact_cost

_TIED: Final = ("serendipity",)
"""Modes whose cost depends on which of his optimal plans the human follows."""


@dataclass(frozen=True, slots=True)
class Call:
    """What to solve a task with."""

    mode: str
    discount: Fraction


@dataclass(frozen=True, slots=True)
class Assignment:
    """A task and the calls that are still to be made for it."""

    test: str
    path: Path
    fingerprint: str
    calls: tuple[Call, ...]


@dataclass(frozen=True, slots=True)
class TaskRows:
    """What an assignment came to."""

    test: str
    fingerprint: str
    rows: tuple[Row, ...]


def solve(assignment: Assignment) -> TaskRows:
    """Read the task and make the calls.

    Raises:
        InputError: a file of the task is wrong.
    """
    task = load(assignment.path)
    rows = tuple(_row(assignment.test, task, call) for call in assignment.calls)
    return TaskRows(assignment.test, assignment.fingerprint, rows)


def _row(test: str, task: Task, call: Call) -> Row:
    start = perf_counter()
    result = plan(task, mode=call.mode, discount=call.discount)
    seconds = perf_counter() - start
    best, worst = _ties(task, call, result)
    return Row(
        test=test,
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


def _ties(task: Task, call: Call, result: Result) -> tuple[Fraction | None, Fraction | None]:
    """Least and greatest cost over the human's optimal plans."""
    cost = exact_cost(result.cost)
    if call.mode not in _TIED or cost is None:
        return cost, cost
    answers = plan(task, mode=call.mode, discount=call.discount, ties="optimistic").statistics["ties"]
    costs = [Fraction(str(answer["cost"])) for answer in answers]
    return min(costs), max(costs)
