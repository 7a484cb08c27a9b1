"""Whether a proof's programs and those made a second time are about the same plans."""

from collections.abc import Callable, Mapping
from fractions import Fraction
from typing import Any

from serendipity.model import Result, Task
from serendipity_testing.oracle import Alone, Moment
from serendipity_testing.pseudo_boolean.opb import PseudoBooleanProblem
from serendipity_testing.pseudo_boolean.question import NotMadeError, question_of
from serendipity_testing.pseudo_boolean.second import program

Solver = Callable[[PseudoBooleanProblem], int | None]
"""The least objective of a problem; None where nothing satisfies it."""


def difference(task: Task, result: Result, entry: Mapping[str, Any], least: Solver) -> str | None:
    """How a program of a proof file differs from the one made a second time; None: it doesn't.

    Where the entry has a solution, the optimum has to be one above its limit; else nothing may be at or
    below the limit.
    """
    optimum, limit = _optimum(task, result, entry, least), entry["limit"]
    if optimum is None:
        return "a solution, where the second program has none" if "solution" in entry else None
    if limit is None:
        return f"no plan, where the second program has one of {optimum}"
    proved = (limit + 1) * Fraction(entry["unit"])
    if optimum < proved or ("solution" in entry and optimum != proved):
        return f"an optimum of {proved}, where the second program's is {optimum}"
    return None


def _optimum(task: Task, result: Result, entry: Mapping[str, Any], least: Solver) -> Fraction | None:
    """What a plan of those asked about costs at least; the human alone is searched state by state."""
    if entry["name"].startswith("the human alone, ") and entry["name"].endswith(" states"):
        if task.needs_time or result.options.head_start:
            raise NotMadeError("semantics 10")
        if "/" not in entry["unit"]:
            raise NotMadeError(f"unit {entry['unit']}")
        worth = Alone(task).worth(Moment(task.init))
        return None if worth is None else worth[0]
    problem, unit = program(question_of(task, result, entry))
    found = least(problem)
    return None if found is None else found * unit
