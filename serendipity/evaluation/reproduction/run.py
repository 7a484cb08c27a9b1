"""A folder of tasks through modes x discounts: in parallel, and resumable."""

import json
from collections.abc import Callable, Generator, Iterable, Iterator, Sequence
from contextlib import closing
from dataclasses import dataclass
from fractions import Fraction
from os import PathLike
from pathlib import Path
from time import time
from typing import Any, Final

from search.kernel.library import library
from serendipity.evaluation.measuring.record import Lines
from serendipity.evaluation.measuring.suites import chosen
from serendipity.evaluation.reproduction.packed import PackedRows
from serendipity.evaluation.reproduction.pool import on_dask
from serendipity.evaluation.reproduction.rows import KINDS, Row
from serendipity.evaluation.reproduction.suite import find_tasks
from serendipity.evaluation.reproduction.work import Assignment, Call, TaskRows, killed, solve
from serendipity.model import Deadline, InputError, Options, UsageError
from serendipity.model.arguments import DEADLINE, FUNCTION, LIST, PATH, TEXT, WHOLE, expect, expect_or_none
from serendipity.model.keywords import Mode
from serendipity.model.numbers import Number, unrounded
from serendipity.model.resources.processes import in_processes
from serendipity.model.schemas import schema_fault
from serendipity.model.table import Table, Tabular
from serendipity.model.task.task import several

SCHEMA: Final = "serendipity.journal/1"
"""Of each line; lines of the first versions have none."""

_BEGINS: Final = (json.dumps({"schema": SCHEMA})[:-1].encode(), b'{"test": ')


class Journal:
    """Rows of finished tasks on disk; a task whose line was cut off is simply done again."""

    def __init__(self, path: Path) -> None:
        self.path = path
        self._lines = Lines(path, "a journal of `serendipity reproduce`", _BEGINS)

    def read(self) -> Iterator[TaskRows]:
        """The finished tasks that are there already, one by one; errors as of :meth:`Lines.read`."""
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


MODES: Final[tuple[Mode, ...]] = ("individual", "serendipity", "communication", "composite")
DISCOUNTS: Final = ("0", "0.1", "0.3", "0.5", "0.7", "0.9")
"""The discounts of the paper's Table I."""


@dataclass(frozen=True, slots=True)
class Progress:
    """Progress of a run, in tasks.

    Attributes:
        done: finished, those of an earlier run included.
        total: all of them.
        opportunities: rows so far in which a robot helps.
    """

    done: int
    total: int
    opportunities: int


@dataclass(frozen=True, slots=True, repr=False)
class Reproduction(Tabular):
    """The rows of a run, in the order task, mode, discount."""

    modes: tuple[str, ...]
    discounts: tuple[Fraction, ...]
    rows: Sequence[Row]

    def __repr__(self) -> str:
        return f"Reproduction({len(self.rows)} rows, {self.unproved} of them unproved)"

    def table(self) -> Table:
        """The rows, with the columns of the CSV."""
        return Table(KINDS, tuple(tuple(row.to_dict().values()) for row in self.rows))

    @property
    def unproved(self) -> int:
        """The number of rows for which a limit came before the proof."""
        return sum(not row.proved and row.status != "error" for row in self.rows)

    @property
    def errors(self) -> dict[str, str]:
        """By task whatever is broken in it: the first reason."""
        return {row.test: row.reason or "" for row in reversed(self.rows) if row.status == "error"}

    @property
    def complete(self) -> bool:
        """True if every row is proved."""
        return all(row.proved for row in self.rows)


def reproduce(
    folder: str | PathLike[str],
    *,
    modes: Iterable[Mode] = MODES,
    discounts: Iterable[Number] = DISCOUNTS,
    jobs: int = 1,
    journal: str | PathLike[str] | None = None,
    dask: str | None = None,
    on_progress: Callable[[Progress], None] | None = None,
    time_limit: float | None = None,
    memory_limit: float | None = None,
    deadline: Deadline | None = None,
) -> Reproduction:
    """Solve every task of a folder in every mode at every discount; a broken task is rows of its own.

    Args:
        folder: its subfolders are tasks, each with a folder per agent and ``superagent/``.
        modes: which modes.
        discounts: which discounts, 0 to 1.
        jobs: number of processes.
        journal: file to which finished tasks are appended; what it holds already is not
            done again unless it is not proved, or the task's files have changed since.
        dask: address of a Dask scheduler, ``"local"``, or None.
        on_progress: called at the start and after each task.
        time_limit: seconds for each row, and for reading a task, or None.  Rows for which it is
            not enough are ``feasible`` or ``unknown``.
        memory_limit: what each process may have in memory, in MiB, or None.
        deadline: of the whole run: rows that it leaves no time for are ``unknown``.  What else
            it watches than the time is looked at after each task.

    Raises:
        UsageError: an argument is wrong.
        InputError: the folder or the journal can't be read.
        SerendipityError: the Dask cluster is gone.
    """
    expect(PATH, folder=folder)
    expect(LIST, modes=modes, discounts=discounts)
    expect(WHOLE, jobs=jobs)
    expect_or_none(PATH, journal=journal)
    expect_or_none(TEXT, dask=dask)
    expect_or_none(FUNCTION, on_progress=on_progress)
    expect_or_none(DEADLINE, deadline=deadline)
    calls = _calls(modes, discounts)
    if jobs < 1:
        raise UsageError(f"jobs: expected at least 1, got {jobs}")
    tasks = find_tasks(Path(folder))
    book = None if journal is None else Journal(Path(journal))
    rows = PackedRows(tasks, calls)
    for record in () if book is None else book.read():
        rows.put(record, proved=True)
    whole = deadline or Deadline()
    options, left = Options(time_limit=time_limit, memory_limit=memory_limit), whole.left()
    limits = (options.time_limit, options.memory_limit, None if left is None else time() + left)
    missing = zip(tasks, map(rows.missing, range(len(tasks))), strict=True)
    assignments = [Assignment(task, of, *limits) for task, of in missing if of]
    report = on_progress or (lambda _: None)
    done = len(tasks) - len(assignments)
    helped = sum(row.opportunity for row in rows)
    report(Progress(done, len(tasks), helped))
    with closing(_work(assignments, jobs, dask)) as records:
        for record in records:
            if book is not None:
                book.append(record)
            rows.put(record)
            done += 1
            helped += sum(row.opportunity for row in record.rows)
            report(Progress(done, len(tasks), helped))
            if whole.reached() is not None:
                break
    each_mode, each_discount = (tuple(dict.fromkeys(values)) for values in zip(*calls, strict=True))
    return Reproduction(each_mode, each_discount, rows)


def _calls(modes: Iterable[str], discounts: Iterable[Number]) -> tuple[Call, ...]:
    wanted, levels = tuple(dict.fromkeys(several(modes, "modes"))), tuple(discounts)
    if not wanted or not levels:
        raise UsageError("modes, discounts: expected at least one of each")
    chosen(wanted, dict.fromkeys(MODES), "modes")
    exact = dict.fromkeys(Options(discount=level).discount for level in levels)
    return tuple(Call(mode, discount) for mode in wanted for discount in exact)


def _work(assignments: Sequence[Assignment], jobs: int, dask: str | None) -> Generator[TaskRows]:
    if not assignments:
        return
    library()  # says once if there is none, and not once for each process
    if dask is not None:
        yield from on_dask(solve, assignments, dask, jobs)
    elif jobs == 1:
        yield from map(solve, assignments)
    else:
        yield from in_processes(solve, assignments, jobs, killed)
