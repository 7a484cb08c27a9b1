"""Silent assistance on the published problems.

    python -m benchmarks.assistance [FOLDER] [--only WORD] [--ties NAME,...] [--time-limit S]

Prints a table (problem, ties, status, lower and upper value as ``human, supporter``, CPU seconds with
loading), a summary by domain, and the values that do not stand in their order (semantics 7): optimistic <=
fixed, and optimistic <= expected <= robust; where one is not proved its bounds must not contradict it.
"""

import sys
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from statistics import median
from typing import Annotated, Any

import typer

import serendipity
from benchmarks.problems import PROBLEMS, silent, silent_task
from serendipity.evaluation.measuring.figures import timed
from serendipity.evaluation.measuring.tables import as_markdown, grouped, table
from serendipity.model.telling import Grid, Line

ORDER = (("optimistic", "fixed"), ("optimistic", "expected"), ("expected", "robust"))


@dataclass(frozen=True, slots=True)
class Row:
    """The answer to a problem under some ties: its bounds are pairs of costs, None where none is finite."""

    name: str
    ties: str
    status: str
    bounds: Any
    seconds: float


def main(
    folder: Annotated[Path, typer.Argument()] = PROBLEMS / "spa",
    only: str = "",
    ties: str = "optimistic,fixed,expected,robust",
    time_limit: float = 60,
) -> None:
    """Run all problems under all ties; exit code 1 where values do not stand in their order."""
    rows: list[Row] = []
    for name, *pairs in silent(folder):
        if only in name:
            rows += [_solved(name, pairs, each, time_limit) for each in ties.split(",")]
            print(name, file=sys.stderr, flush=True)
    wrong = [fault for of in grouped(rows, lambda row: row.name).values() for fault in _faults(of)]
    head = ("problem", "ties", "status", "lower", "upper", "seconds")
    lines = [
        (
            *(row.name, row.ties, row.status),
            *(_told(row.bounds.lower), _told(row.bounds.upper), f"{row.seconds:.3f}"),
        )
        for row in rows
    ]
    order = f"In order: all but {len(wrong)} pairs of values. {' '.join(wrong)}"
    print(as_markdown([Grid(head, lines), _summary(rows), Line(order)]), end="")
    sys.exit(bool(wrong))


def _solved(name: str, pairs: Any, ties: Any, time_limit: float) -> Row:
    task = silent_task(*pairs)
    result, took = timed(lambda: serendipity.plan(task, mode="assistance", ties=ties, time_limit=time_limit))
    return Row(name, ties, result.status, result.bounds, took)


def _faults(rows: Sequence[Row]) -> Iterator[str]:
    """The pairs of values of one problem that do not stand in their order, as far as they are known."""
    known = {row.ties: row.bounds for row in rows}
    for less, more in ORDER:
        if less in known and more in known and (most := known[more].upper) and known[less].lower > most:
            yield f"{rows[0].name}: {less} is above {more}."


def _summary(rows: Sequence[Row]) -> Grid:
    return table(
        ("domain", "ties"),
        grouped(rows, lambda row: (row.name.split("/")[0], row.ties)),
        {
            "proved": lambda of: f"{sum(row.status in ('optimal', 'infeasible') for row in of)} of {len(of)}",
            "median s": lambda of: f"{median(row.seconds for row in of):.3f}",
            "longest s": lambda of: f"{max(row.seconds for row in of):.3f}",
        },
    )


def _told(costs: Any) -> str:
    return "-" if costs is None else ", ".join(map(str, costs))


if __name__ == "__main__":
    main.__doc__ = __doc__
    typer.run(main)
