"""A file to which each finished task is appended, so that a killed run can go on.

A line is a JSON object and is written at once.  A line that a kill has cut off is
dropped when the journal is opened again; its task is simply done again.
"""

import json
import os
from pathlib import Path
from typing import Any, Final

from serendipity.evaluation.reproduction.rows import Row
from serendipity.evaluation.reproduction.work import TaskRows
from serendipity.model import InputError, UsageError
from serendipity.model.numbers import unrounded
from serendipity.model.schemas import schema_fault
from serendipity.writing.lines import append

SCHEMA: Final = "serendipity.journal/1"
"""Of each line; lines of the first versions have none."""

_BEGINS: Final = (json.dumps({"schema": SCHEMA})[:-1].encode(), b'{"test": ')
"""What a line begins with, so that the end of another file is not taken for one that was cut off."""


class Journal:
    """Rows of finished tasks on disk.

    Args:
        path: the file; made when the first task is finished.
    """

    def __init__(self, path: Path) -> None:
        self.path = path

    def read(self) -> list[TaskRows]:
        """What is there already; a line that was cut off is removed from the file.

        Raises:
            InputError: the file is something else than a journal.
        """
        try:
            text = self.path.read_bytes()
        except FileNotFoundError:
            return []
        except OSError as error:
            raise InputError(f"can't be read: {error.strerror}", self.path) from None
        whole, _, cut_off = text.rpartition(b"\n")
        records = [self._record(line, i) for i, line in enumerate(whole.splitlines(), start=1)]
        if cut_off:
            if not any(cut_off.startswith(begin[: len(cut_off)]) for begin in _BEGINS):
                raise InputError("expected a journal of `serendipity reproduce`", self.path)
            os.truncate(self.path, len(text) - len(cut_off))
        return records

    def append(self, record: TaskRows) -> None:
        """Add a finished task; on return it is on disk.

        Raises:
            UsageError: the file can't be written; it is then as it was before.
        """
        rows = [row.to_dict() | {"discount": unrounded(row.discount)} for row in record.rows]
        told = {"schema": SCHEMA, "test": record.test, "fingerprint": record.fingerprint, "rows": rows}
        try:
            append(self.path, json.dumps(told))
        except OSError as error:
            raise UsageError(f"journal: {self.path} can't be written: {error.strerror}") from None

    def _record(self, line: bytes, number: int) -> TaskRows:
        try:
            data: dict[str, Any] = json.loads(line)
            if fault := schema_fault(data.get("schema", SCHEMA), SCHEMA):
                raise InputError(f"journal: {fault}", self.path, number)
            rows = tuple(Row.from_dict(row) for row in data["rows"])
            return TaskRows(data["test"], data["fingerprint"], rows)
        except (AttributeError, ValueError, KeyError, TypeError, RecursionError):
            raise InputError("expected a journal of `serendipity reproduce`", self.path, number) from None
