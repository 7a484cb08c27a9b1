"""Files that grow by a line of JSON, so that work that was stopped goes on where it was."""

import json
import os
from collections.abc import Callable
from pathlib import Path
from typing import Any, TypeVar

from serendipity.model.errors import InputError, UsageError
from serendipity.writing.together import append

T = TypeVar("T")


class Lines:
    """JSON values on disk, one a line; one that a kill has cut off is dropped when they are read again.

    Args:
        path: the file; made when the first line is written.
        what: is expected in it, for errors.
        begins: what its lines begin with, so that the end of another file is not taken for one
            that was cut off.
    """

    def __init__(self, path: Path, what: str, begins: tuple[bytes, ...]) -> None:
        self.path, self._what, self._begins = path, what, begins

    def read(self, decoded: Callable[[Any, int], T]) -> list[T]:
        """The values that are there already.

        Args:
            decoded: what a value on a line of some number stands for; it may fail like a look-up.

        Raises:
            InputError: the file is something else.
        """
        try:
            text = self.path.read_bytes()
        except FileNotFoundError:
            return []
        except OSError as error:
            raise InputError(f"can't be read: {error.strerror}", self.path) from None
        whole, _, cut_off = text.rpartition(b"\n")
        values = []
        for number, line in enumerate(whole.splitlines(), start=1):
            try:
                values.append(decoded(json.loads(line), number))
            except (AttributeError, ValueError, KeyError, TypeError, RecursionError):
                raise InputError(f"expected {self._what}", self.path, number) from None
        if cut_off:
            if not any(cut_off.startswith(begin[: len(cut_off)]) for begin in self._begins):
                raise InputError(f"expected {self._what}", self.path)
            os.truncate(self.path, len(text) - len(cut_off))
        return values

    def append(self, value: Any) -> None:
        """Add a line; on return it is on disk.

        Raises:
            UsageError: the file can't be written; it is then as it was before.
        """
        try:
            append(self.path, json.dumps(value))
        except OSError as error:
            raise UsageError(f"journal: {self.path} can't be written: {error.strerror}") from None


class Record:
    """Results of jobs, each found again by its key.

    Args:
        file: where it stands; None: nowhere but in memory.
    """

    def __init__(self, file: Path | None = None) -> None:
        self._lines = None if file is None else Lines(file, "a record of what was measured", (b'["',))
        self._known: dict[str, Any] = dict(self._lines.read(lambda pair, _: pair) if self._lines else ())

    def __contains__(self, key: str) -> bool:
        return key in self._known

    def __getitem__(self, key: str) -> Any:
        return self._known[key]

    def add(self, key: str, found: Any) -> None:
        """Note what a job has come to, and write it down at once."""
        self._known[key] = found
        if self._lines is not None:
            self._lines.append([key, found])
