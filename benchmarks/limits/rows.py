"""Rows: what was measured of one command on one task, and the files that they are in."""

import csv
from collections.abc import Iterable
from dataclasses import astuple, dataclass, fields
from pathlib import Path

SHARE, EXTRA = 0.1, 0.05
"""What may be added to a limit: of it, and seconds."""

FOUND = (0, 3)
"""Exit codes of an answer, or a proof that there is none."""


@dataclass(frozen=True, slots=True)
class Row:
    """One command on one task.

    Attributes:
        time_limit: seconds.
        memory_limit: MiB, or None.
        code: exit code; None where it was killed.
        over: seconds over the time limit.
        waited: seconds that the process waited for a processor.
        peak: most memory, in MiB.
    """

    command: str
    task: str
    time_limit: float
    memory_limit: float | None
    code: int | None
    over: float
    waited: float
    peak: float

    @classmethod
    def read(cls, cells: dict[str, str]) -> "Row":
        """A row as it was written."""
        numbers = [None if cells[field.name] == "" else float(cells[field.name]) for field in fields(cls)[2:]]
        row = cls(cells["command"], cells["task"], *numbers)  # type: ignore[arg-type]
        return row if row.code is None else cls(*astuple(row)[:4], int(row.code), *astuple(row)[5:])

    @property
    def kept(self) -> bool:
        """Whether the time limit was kept, and the process was not killed."""
        return self.code is not None and self.beyond <= 0

    @property
    def beyond(self) -> float:
        """Seconds beyond what may be added to the limit."""
        return self.over - SHARE * self.time_limit - EXTRA

    @property
    def answered(self) -> bool:
        """Whether there was an answer, or a proof that there is none."""
        return self.code in FOUND

    @property
    def memory_over(self) -> float:
        """Share of the memory limit by which the peak is above it."""
        return 0.0 if self.memory_limit is None else self.peak / self.memory_limit - 1

    @property
    def key(self) -> tuple[object, ...]:
        """What was measured: there is one row of each."""
        return self.command, self.task, self.time_limit, self.memory_limit


def read_rows(file: Path | None) -> list[Row]:
    """The rows of a file, if there is one."""
    if file is None or not file.exists():
        return []
    with file.open(newline="", encoding="utf-8") as text:
        return [*map(Row.read, csv.DictReader(text))]


def add_rows(file: Path | None, rows: Iterable[Row]) -> None:
    """Write rows at the end of a file, which is made where there is none."""
    if file is None:
        return
    begins = not file.exists()
    with file.open("a", newline="", encoding="utf-8") as text:
        writer = csv.writer(text)
        if begins:
            writer.writerow(field.name for field in fields(Row))
        writer.writerows(map(astuple, rows))
