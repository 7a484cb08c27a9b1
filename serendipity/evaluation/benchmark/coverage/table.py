"""Rows as a table, and back from CSV."""

import csv
from collections.abc import Iterable
from dataclasses import fields
from pathlib import Path
from typing import Any, Final

from serendipity.evaluation.benchmark.contenders import Outcome
from serendipity.evaluation.benchmark.coverage.rows import Row
from serendipity.model.errors import InputError
from serendipity.model.table import Table, columns_of
from serendipity.pddl.parsing.files import read_text
from serendipity.writing.csv_text import as_text

_OWN: Final = tuple(field for field in fields(Row) if field.name != "outcome")
_FIELDS: Final = (*_OWN, *fields(Outcome))

_READ: Final[dict[Any, Any]] = {
    str: as_text,
    int: int,
    float: float,
    bool: "True".__eq__,
    float | None: lambda cell: float(cell) if cell else None,
}
"""By type, how a cell is read."""


def as_table(rows: Iterable[Row]) -> Table:
    """The rows, with what the contender said behind what it was asked."""
    asked, said = columns_of(Row), columns_of(Outcome)
    cells = (
        (*(getattr(row, name) for name in asked), *(getattr(row.outcome, name) for name in said))
        for row in rows
    )
    return Table(asked | said, tuple(cells))


def read_rows(path: Path) -> list[Row]:
    """The rows of such a file; several may stand in it one after another.

    Raises:
        InputError: it is something else.
    """
    header = [field.name for field in _FIELDS]
    rows = []
    for line, text in enumerate(read_text(path).splitlines(), start=1):
        try:
            (cells,) = csv.reader([text])
            if cells == header:
                continue
            of = {field.name: _READ[field.type](cell) for field, cell in zip(_FIELDS, cells, strict=True)}
        except (ValueError, csv.Error):
            raise InputError("expected a row that `serendipity bench` has written", path, line) from None
        outcome = Outcome(**{field.name: of.pop(field.name) for field in fields(Outcome)})
        rows.append(Row(**of, outcome=outcome))
    if not rows:
        raise InputError("expected rows that `serendipity bench` has written, got none", path)
    return rows
