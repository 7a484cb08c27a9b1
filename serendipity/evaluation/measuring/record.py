"""Jobs in processes, and files that grow by a line of JSON: work that was stopped goes on where it was."""

import json
import os
from collections.abc import Callable, Iterable, Iterator
from functools import partial
from pathlib import Path
from typing import Any, TypeVar

from serendipity.model.errors import InputError, UsageError
from serendipity.model.resources.processes import in_processes
from serendipity.writing.together import append

J = TypeVar("J")
T = TypeVar("T")


class Lines:
    """JSON values on disk, one a line; one that a kill has cut off is dropped when they are read again.

    By what its lines begin with, the end of another file is not taken for one that was cut off.
    """

    def __init__(self, path: Path, what: str, begins: tuple[bytes, ...]) -> None:
        self.path, self._what, self._begins = path, what, begins

    def read(self, decoded: Callable[[Any, int], T]) -> Iterator[T]:
        """What the values that are there stand for, one by one; an InputError where the file is another.

        ``decoded`` gets a value and the number of its line; it may fail like a look-up.
        """
        cut_off, whole = b"", 0
        try:
            with self.path.open("rb") as lines:
                for number, line in enumerate(lines, start=1):
                    if not line.endswith(b"\n"):
                        cut_off = line
                        break
                    whole += len(line)
                    yield self._value(decoded, line, number)
        except FileNotFoundError:
            return
        except OSError as error:
            raise InputError(f"can't be read: {error.strerror}", self.path) from None
        if cut_off:
            if not any(cut_off.startswith(begin[: len(cut_off)]) for begin in self._begins):
                raise InputError(f"expected {self._what}", self.path)
            os.truncate(self.path, whole)

    def _value(self, decoded: Callable[[Any, int], T], line: bytes, number: int) -> T:
        try:
            return decoded(json.loads(line), number)
        except (AttributeError, ValueError, KeyError, TypeError, RecursionError):
            raise InputError(f"expected {self._what}", self.path, number) from None

    def append(self, value: Any) -> None:
        """Add a line, which is on disk on return; or a UsageError, and the file is as it was before."""
        try:
            append(self.path, json.dumps(value))
        except OSError as error:
            raise UsageError(f"journal: {self.path} can't be written: {error.strerror}") from None


def measured(
    jobs: Iterable[J], work: Callable[[J], Any], file: Path | None = None, *, processes: int = 1
) -> Iterator[tuple[J, Any]]:
    """Each job and what it came to: plain values, as JSON has them.

    Args:
        jobs: values that are told apart by their ``repr``.
        work: a function of a module.
        file: where results are written as they come, and not worked out again if they are there; or None.
        processes: how many; with several, jobs come as they are finished.
    """
    lines = None if file is None else Lines(file, "a record of what was measured", (b'["',))
    known = {} if lines is None else dict(lines.read(lambda pair, _: pair))
    todo = []

    def noted(job: J, found: Any) -> tuple[J, Any]:
        if lines is not None:
            lines.append([repr(job), found])
        return job, found

    for job in jobs:
        if repr(job) in known:
            yield job, known[repr(job)]
        elif processes > 1:
            todo.append(job)
        else:
            yield noted(job, work(job))
    for job, found in in_processes(partial(_with_job, work), todo, processes):
        yield noted(job, found)


def _with_job(work: Callable[[J], Any], job: J) -> tuple[J, Any]:
    return job, work(job)


def apart(work: Callable[..., T], *given: Any) -> T:
    """Result of a module's function in a process of its own; a SerendipityError where two were killed."""
    (found,) = in_processes(partial(_called, work), [given], 1)
    return found


def _called(work: Callable[..., T], given: tuple[Any, ...]) -> T:
    return work(*given)
