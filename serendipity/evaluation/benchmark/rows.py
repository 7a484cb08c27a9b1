"""Rows: a call and a contender's answer; as a table, and back from CSV."""

import csv
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, fields
from pathlib import Path
from typing import Any, Final

from serendipity.evaluation.benchmark.contenders import Outcome
from serendipity.evaluation.measuring.tables import grouped
from serendipity.model.errors import InputError
from serendipity.model.table import Table, columns_of
from serendipity.pddl.parsing.files import read_text
from serendipity.writing.csv_text import as_text


@dataclass(frozen=True, slots=True)
class BenchRow:
    """A call and a contender's answer.

    Attributes:
        domain: of the problem; of a series, its axis; empty for tasks in folders.
        task: its name; in a series its value on the axis.
        human: who is the human.
        robots: who are robots, with blanks between them.
        alone: whether the human is known to have a plan alone.
        mode: as the benchmark calls it.
        discount: of what robots do.
        contender: who answers.
        outcome: the answer, and what it took.
    """

    domain: str
    task: str
    human: str
    robots: str
    alone: bool
    mode: str
    discount: float
    contender: str
    outcome: Outcome


_ASKED: Final = [field.name for field in fields(BenchRow) if field.name != "outcome"]

_READ: Final[dict[Any, Any]] = {
    str: as_text,
    int: int,
    float: float,
    bool: "True".__eq__,
    float | None: lambda cell: float(cell) if cell else None,
}
"""By type, how a cell is read."""


def as_table(rows: Iterable[BenchRow]) -> Table:
    """The rows, with what the contender said behind what it was asked."""
    asked, said = columns_of(BenchRow), columns_of(Outcome)
    cells = (
        (*(getattr(row, name) for name in asked), *(getattr(row.outcome, name) for name in said))
        for row in rows
    )
    return Table(asked | said, tuple(cells))


def read_rows(path: Path) -> list[BenchRow]:
    """The rows of such a file, or of several one after another; an InputError for something else."""
    rows: list[BenchRow] = []
    header: list[str] = []
    for line, text in enumerate(read_text(path).splitlines(), start=1):
        try:
            (cells,) = csv.reader([text])
            if cells[: len(_ASKED)] == _ASKED:
                header = cells
                continue
            rows.append(_row(dict(zip(header, cells, strict=True))))
        except (KeyError, TypeError, ValueError, csv.Error):
            raise InputError("expected a row that `serendipity bench` has written", path, line) from None
    if not rows:
        raise InputError("expected rows that `serendipity bench` has written, got none", path)
    return rows


def _row(cells: dict[str, str]) -> BenchRow:
    """A row by its cells, which may lack what the program did not write then."""
    own, said = (
        {each.name: _READ[each.type](cells[each.name]) for each in fields(kind) if each.name in cells}
        for kind in (BenchRow, Outcome)
    )
    return BenchRow(**own, outcome=Outcome(**said))


def disagreements(rows: Sequence[BenchRow]) -> Iterator[str]:
    """Calls of which contenders have proved what can't all be true, in words."""
    for of in grouped(rows, lambda row: (row.domain, row.task, row.mode, row.discount)).values():
        if told := _told(of):
            row = of[0]
            yield f"{f'{row.domain} {row.task}'.strip()}, {row.mode} at {row.discount:g}: {told}"


def _told(rows: Sequence[BenchRow]) -> str:
    proved = {row.contender: row.outcome.cost for row in rows if row.outcome.proved}
    if len(set(proved.values())) > 1:
        told = (f"{name} {'no plan' if cost is None else cost}" for name, cost in proved.items())
        return f"the proved optima differ: {', '.join(told)}"
    costs = [(row.outcome.cost, row.contender) for row in rows if row.outcome.cost is not None]
    bounds = [(row.outcome.lower_bound, row.contender) for row in rows if row.outcome.lower_bound is not None]
    if len({name for _, name in (*costs, *bounds)}) > 1 and costs and bounds:
        (cost, who), (bound, other) = min(costs), max(bounds)
        if cost < bound:
            return f"a plan of {who} costs {cost}, and {other} says at least {bound}"
    return ""
