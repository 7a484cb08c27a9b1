"""The rows of a run in little memory: their bytes from the start on, an object where somebody looks at it."""

from collections.abc import Sequence
from functools import lru_cache
from math import isnan, nan
from struct import Struct
from typing import Final, overload

from serendipity.evaluation.reproduction.rows import Row
from serendipity.evaluation.reproduction.suite import TaskFolder
from serendipity.evaluation.reproduction.work import Call, TaskRows
from serendipity.model import Window
from serendipity.model.numbers import as_written

_BYTES: Final = Struct("<5d2qB?")
"""Four costs, seconds, both ends of the window, status, opportunity."""

_STATUSES: Final = ("unknown", "feasible", "infeasible", "optimal")
_NOTHING: Final = _BYTES.pack(nan, nan, nan, nan, 0.0, 0, 0, 0, False)


class PackedRows(Sequence[Row]):
    """A row for each task and call, in their order; ``unknown`` until it is put there."""

    def __init__(self, tasks: Sequence[TaskFolder], calls: Sequence[Call]) -> None:
        self._tasks, self._calls = tasks, calls
        self._starts = {(task.test, task.fingerprint): i * len(calls) for i, task in enumerate(tasks)}
        self._bytes = bytearray(_NOTHING * len(self))
        self._as_they_are: dict[int, Row] = {}  # those that bytes don't say all of

    def __len__(self) -> int:
        return len(self._tasks) * len(self._calls)

    @overload
    def __getitem__(self, at: int) -> Row: ...

    @overload
    def __getitem__(self, at: slice) -> tuple[Row, ...]: ...

    def __getitem__(self, at: int | slice) -> Row | tuple[Row, ...]:
        if isinstance(at, slice):
            return tuple(self[i] for i in range(len(self))[at])
        of, call = divmod(range(len(self))[at], len(self._calls))
        task = self._tasks[of]
        place = self._starts[task.test, task.fingerprint] + call
        return self._as_they_are.get(place) or self._row(task.test, place)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, PackedRows) and len(self) == len(other) and all(map(Row.__eq__, self, other))

    def __hash__(self) -> int:
        return hash(self[:])

    def __repr__(self) -> str:
        return f"Rows({len(self)})"

    def missing(self, at: int) -> tuple[Call, ...]:
        """The calls of a task whose rows are not proved."""
        start = at * len(self._calls)
        return tuple(call for i, call in enumerate(self._calls) if not self[start + i].proved)

    def put(self, found: TaskRows, *, proved: bool = False) -> None:
        """Take over those that are asked about; with ``proved`` those only that no limit could change."""
        start = self._starts.get((found.test, found.fingerprint))
        if start is None:
            return
        for row in found.rows:
            call = Call(row.mode, row.discount)
            if call in self._calls and (row.proved or not proved):
                self._put(start + self._calls.index(call), row)

    def _put(self, place: int, row: Row) -> None:
        costs = (row.cost, row.human_cost, row.best_tie, row.worst_tie)
        figures = (nan if cost is None else float(cost) for cost in costs)
        window = (0, 0) if row.window is None else (row.window.start, row.window.end)
        status = _STATUSES.index(row.status) if row.status in _STATUSES else 0
        values = (*figures, row.seconds, *window, status, row.opportunity)
        _BYTES.pack_into(self._bytes, place * _BYTES.size, *values)
        self._as_they_are.pop(place, None)
        if self._row(row.test, place) != row:
            self._as_they_are[place] = row

    def _row(self, test: str, place: int) -> Row:
        *figures, seconds, start, end, status, helps = _BYTES.unpack_from(self._bytes, place * _BYTES.size)
        cost, human_cost, best, worst = (None if isnan(x) else _exact(x) for x in figures)
        window, call = Window(start, end) if end else None, self._calls[place % len(self._calls)]
        return Row(test, *call, _STATUSES[status], cost, human_cost, helps, window, seconds, best, worst)


_exact: Final = lru_cache(maxsize=1024)(as_written)
