"""A run as CSV and as JSON."""

from collections.abc import Sequence
from typing import Any, Final

from serendipity.evaluation.reproduction.rows import COLUMNS
from serendipity.evaluation.reproduction.run import Reproduction
from serendipity.evaluation.reproduction.tables import Entry, ExampleAnswer, Times
from serendipity.writing.csv_text import as_csv

SCHEMA: Final = "serendipity.reproduction/1"


def rows_as_csv(run: Reproduction) -> str:
    """The rows, one a line, below the names of ``COLUMNS``."""
    return as_csv(COLUMNS, (row.cells() for row in run.rows))


def table_1_as_csv(entries: Sequence[Entry]) -> str:
    """Table I, one entry a line."""
    return _csv_of([entry.to_dict() for entry in entries])


def table_2_as_csv(times: Sequence[Times]) -> str:
    """Table II, one mode a line."""
    return _csv_of([time.to_dict() for time in times])


def as_json(
    run: Reproduction, entries: Sequence[Entry], times: Sequence[Times], answers: Sequence[ExampleAnswer]
) -> dict[str, Any]:
    """The JSON object (schema ``serendipity.reproduction/1``)."""
    return {
        "schema": SCHEMA,
        "complete": run.complete,
        "modes": list(run.modes),
        "discounts": [float(discount) for discount in run.discounts],
        "rows": [row.to_dict() for row in run.rows],
        "table_1": [entry.to_dict() for entry in entries],
        "table_2": [time.to_dict() for time in times],
        "examples": [answer.to_dict() for answer in answers],
    }


def _csv_of(objects: Sequence[dict[str, Any]]) -> str:
    lines = (["" if value is None else value for value in item.values()] for item in objects)
    return as_csv(list(objects[0]), lines)
