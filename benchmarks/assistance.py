"""Silent assistance on the published problems.

    python -m benchmarks.assistance [FOLDER] [--only WORD] [--ties NAME,...] [--time-limit S] [--composite S]

Prints a table (problem, ties, status, lower and upper value as ``human, supporter``, CPU
seconds with loading), whether the values stand in their order (semantics 7), and a summary by
domain.  The order: both together without turns <= optimistic <= fixed, and optimistic <=
expected <= robust; where a value is not proved its bounds must not contradict it.  *Together*
is the bound that the search prunes with; with ``--composite SECONDS`` it is also worked out
as the joint plan of mode ``composite`` (no horizon, strict interference, the supporter a
millionth of the price), and must lie between that bound and optimistic.
"""

import sys
from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from pathlib import Path
from statistics import median
from typing import Annotated, Any

import typer

import serendipity
from benchmarks.problems import PROBLEMS, silent, silent_task
from search import PreparedTask
from search.modes.assistance import joint_optimum
from serendipity import Task
from serendipity.evaluation.measuring.figures import timed
from serendipity.evaluation.measuring.tables import as_markdown, grouped, table
from serendipity.model.errors import LimitReachedError
from serendipity.model.resources.deadline import Deadline
from serendipity.model.telling import Grid, Line

ORDER = (
    *(("bound", "composite"), ("composite", "optimistic"), ("bound", "optimistic")),
    *(("optimistic", "fixed"), ("optimistic", "expected"), ("expected", "robust")),
)

Costs = tuple[Fraction, Fraction]
NOTHING = (Fraction(0), Fraction(0))


@dataclass(frozen=True, slots=True)
class Value:
    """What something is worth: a lower and an upper bound (None where none is known, or none is finite)."""

    name: str
    what: str
    lower: Costs
    upper: Costs | None
    status: str = ""
    seconds: float = 0.0


def main(
    folder: Annotated[Path, typer.Argument()] = PROBLEMS / "spa",
    only: str = "",
    ties: str = "optimistic,fixed,expected,robust",
    time_limit: float = 60,
    composite: float | None = None,
) -> None:
    """Run all problems under all ties; exit code 1 where values do not stand in their order."""
    rows: list[Value] = []
    for name, prime, supporter in silent(folder):
        if only in name:
            task = silent_task(prime, supporter)
            rows.append(_bound(name, task, time_limit))
            rows += [] if composite is None else [_composite(name, task, composite)]
            rows += [
                _solved(name, silent_task(prime, supporter), each, time_limit) for each in ties.split(",")
            ]
            print(name, file=sys.stderr, flush=True)
    wrong = [fault for values in grouped(rows, lambda row: row.name).values() for fault in _faults(values)]
    solved = [row for row in rows if row.status]
    head = ("problem", "ties", "status", "lower", "upper", "seconds")
    lines = [(r.name, r.what, r.status, _told(r.lower), _told(r.upper), f"{r.seconds:.3f}") for r in solved]
    order = f"In order: all but {len(wrong)} pairs of values. {' '.join(wrong)}"
    print(as_markdown([Grid(head, lines), _summary(solved), Line(order)]), end="")
    sys.exit(bool(wrong))


def _solved(name: str, task: Task, ties: Any, time_limit: float) -> Value:
    result, took = timed(lambda: serendipity.plan(task, mode="assistance", ties=ties, time_limit=time_limit))
    assert result.bounds is not None, "every answer of the mode has bounds"
    return Value(name, ties, result.bounds.lower, result.bounds.upper, result.status, took)


def _bound(name: str, task: Task, time_limit: float) -> Value:
    try:
        value = joint_optimum(PreparedTask(task), Deadline(time_limit))
    except LimitReachedError:
        value = None
    return Value(name, "bound", NOTHING if value is None else value, value)


def _composite(name: str, task: Task, seconds: float) -> Value:
    """The joint optimum as mode ``composite`` sees it; without bounds where it is not proved."""
    strict: dict[str, Any] = {"discount": "0.999999", "interference": "strict", "time_limit": seconds}
    result = serendipity.plan(task, mode="composite", horizon="inf", **strict)
    if result.status != "optimal" or result.plan is None:
        return Value(name, "composite", NOTHING, None)
    totals = {True: Fraction(0), False: Fraction(0)}
    for step in result.plan:
        totals[step.agents == (result.human,)] += task.actions[task.named[step.action][0]].cost
    value = totals[True], totals[False]
    return Value(name, "composite", value, value)


def _faults(values: Sequence[Value]) -> list[str]:
    """The pairs of values of one problem that do not stand in their order, as far as they are known."""
    known = {value.what: value for value in values}
    pairs = [(known[less], known[more]) for less, more in ORDER if less in known and more in known]
    return [
        f"{one.name}: {one.what} is above {other.what}."
        for one, other in pairs
        if other.upper is not None and one.lower > other.upper
    ]


def _summary(rows: Sequence[Value]) -> Grid:
    return table(
        ("domain", "ties"),
        grouped(rows, lambda row: (row.name.split("/")[0], row.what)),
        {
            "proved": lambda of: f"{sum(row.status in ('optimal', 'infeasible') for row in of)} of {len(of)}",
            "median s": lambda of: f"{median(row.seconds for row in of):.3f}",
            "longest s": lambda of: f"{max(row.seconds for row in of):.3f}",
        },
    )


def _told(costs: Costs | None) -> str:
    return "-" if costs is None else ", ".join(map(str, costs))


if __name__ == "__main__":
    main.__doc__ = __doc__
    typer.run(main)
