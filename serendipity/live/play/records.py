"""Every event with its time: kept, written down at once where there is a file, and exported."""

import json
from collections.abc import Iterable
from datetime import UTC, datetime
from pathlib import Path
from time import perf_counter
from typing import Any, Final

from serendipity.model import InputError, UsageError
from serendipity.writing.csv_text import as_csv as csv_of

Event = dict[str, Any]

COLUMNS: Final = (
    "participant",
    "time",
    "seconds",
    "event",
    "condition",
    "round",
    "scenario",
    "epoch",
    "action",
    "in_vain",
    "steps",
    "verdict",
    "reason",
    "human_cost",
    "team_cost",
    "alone_cost",
    "done",
    "question",
    "answer",
)
"""Of the CSV; an event has those that it is about."""


class Records:
    """The events of one person.

    Args:
        participant: goes into each event.
        file: is added to, line by line, or None.

    Attributes:
        events: so far.
    """

    def __init__(self, participant: str, file: Path | None = None) -> None:
        self._participant = participant
        self._file = file
        self._begun = perf_counter()
        self.events: list[Event] = []

    def add(self, event: str, **about: Any) -> None:
        """Record an event; it is on the disk when this returns.

        Raises:
            UsageError: the file can't be written.
        """
        told = {
            "participant": self._participant,
            "time": datetime.now(UTC).isoformat(timespec="milliseconds"),
            "seconds": round(perf_counter() - self._begun, 3),
            "event": event,
            **about,
        }
        self.events.append(told)
        if self._file is None:
            return
        try:
            with self._file.open("a", encoding="utf-8") as file:
                file.write(json.dumps(told, ensure_ascii=False) + "\n")
        except OSError as error:
            raise UsageError(f"{self._file} can't be written: {error.strerror}") from None


def read(file: Path) -> list[Event]:
    """The events that a file holds; a last line that was cut off is left out.

    Raises:
        InputError: a line is no event.
    """
    events = []
    lines = file.read_text(encoding="utf-8").split("\n")
    for number, line in enumerate(lines[:-1], start=1):
        try:
            event = json.loads(line)
        except (ValueError, RecursionError):  # no JSON, or nested too deeply
            event = None
        if not isinstance(event, dict):
            raise InputError("expected an event, as JSON", file, number)
        events.append(event)
    return events


def as_csv(events: Iterable[Event]) -> str:
    """Events as a table: a row each."""
    rows = [[_cell(event.get(column)) for column in COLUMNS] for event in events]
    return csv_of(COLUMNS, rows)


def _cell(value: Any) -> str:
    if value is None:
        return ""
    if isinstance(value, list):
        return "; ".join(map(str, value))
    return str(value).lower() if isinstance(value, bool) else str(value)
