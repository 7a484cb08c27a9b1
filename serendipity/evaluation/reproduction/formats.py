"""A run as CSV and as JSON."""

from collections.abc import Sequence
from typing import Any, Final

from serendipity.evaluation.reproduction.rows import COLUMNS
from serendipity.evaluation.reproduction.run import Reproduction
from serendipity.evaluation.reproduction.tables import Entry, Tables, Times, plain
from serendipity.writing.csv_text import as_csv

SCHEMA: Final = "serendipity.reproduction/1"


def rows_as_csv(run: Reproduction) -> str:
    """The rows, one a line, below the names of ``COLUMNS``."""
    return as_csv(COLUMNS, (row.cells() for row in run.rows))


def as_json(run: Reproduction, tables: Tables) -> dict[str, Any]:
    """The JSON object (schema ``serendipity.reproduction/1``)."""
    return {
        "schema": SCHEMA,
        "complete": run.complete,
        "modes": list(run.modes),
        "discounts": [float(discount) for discount in run.discounts],
        "rows": [row.to_dict() for row in run.rows],
        "table_1": [*map(plain, tables.costs)],
        "table_2": [*map(plain, tables.times)],
        "examples": [*map(plain, tables.examples)],
    }


def table_as_csv(lines: Sequence[Entry] | Sequence[Times]) -> str:
    """Table I or II, one entry a line."""
    objects = [*map(plain, lines)]
    cells = (["" if value is None else value for value in item.values()] for item in objects)
    return as_csv(list(objects[0]), cells)
