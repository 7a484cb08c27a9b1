"""A file to which each finished task is appended, so that a killed run can go on."""

import json
from pathlib import Path
from typing import Any, Final

from serendipity.evaluation.measuring.record import Lines
from serendipity.evaluation.reproduction.rows import Row
from serendipity.evaluation.reproduction.work import TaskRows
from serendipity.model import InputError
from serendipity.model.numbers import unrounded
from serendipity.model.schemas import schema_fault

SCHEMA: Final = "serendipity.journal/1"
"""Of each line; lines of the first versions have none."""

_BEGINS: Final = (json.dumps({"schema": SCHEMA})[:-1].encode(), b'{"test": ')


class Journal:
    """Rows of finished tasks on disk; a task whose line was cut off is simply done again.

    Args:
        path: the file; made when the first task is finished.
    """

    def __init__(self, path: Path) -> None:
        self.path = path
        self._lines = Lines(path, "a journal of `serendipity reproduce`", _BEGINS)

    def read(self) -> list[TaskRows]:
        """The finished tasks that are there already; errors as of :meth:`Lines.read`."""
        return self._lines.read(self._record)

    def append(self, record: TaskRows) -> None:
        """Add a finished task; errors as of :meth:`Lines.append`."""
        rows = [row.to_dict() | {"discount": unrounded(row.discount)} for row in record.rows]
        self._lines.append(
            {"schema": SCHEMA, "test": record.test, "fingerprint": record.fingerprint, "rows": rows}
        )

    def _record(self, data: Any, number: int) -> TaskRows:
        if fault := schema_fault(data.get("schema", SCHEMA), SCHEMA):
            raise InputError(f"journal: {fault}", self.path, number)
        return TaskRows(data["test"], data["fingerprint"], tuple(map(Row.from_dict, data["rows"])))
