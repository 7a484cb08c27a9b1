"""Every event with its time: kept, written down at once where there is a file, and exported."""

import json
from collections.abc import Iterable
from datetime import UTC, datetime
from itertools import count
from pathlib import Path
from typing import Any, Final, NamedTuple

from serendipity.model import UsageError
from serendipity.writing.csv_text import as_csv as csv_of
from serendipity.writing.together import append

Event = dict[str, Any]

_FIRST: Final = ("participant", "time", "event", "condition", "round", "scenario", "epoch", "action")
"""Columns of the CSV that come first; all others follow in the order in which they come up."""


class Download(NamedTuple):
    """A file that is answered: its text, its media type, and its name where it is to be saved."""

    text: str
    kind: str
    name: str | None = None


class Records:
    """The events of one person."""

    def __init__(self, participant: str, file: Path | None = None, events: Iterable[Event] = ()) -> None:
        self._participant = participant
        self.file = file
        self.events = list(events)

    def add(self, event: str, **about: Any) -> Event:
        """Record an event on the disk; where that fails (UsageError), the file is as it was before."""
        now = datetime.now(UTC).isoformat(timespec="milliseconds")
        told = {"participant": self._participant, "time": now, "event": event, **about}
        if self.file is not None:
            if not self.events:
                made(self.file.parent, "--records")
            try:
                append(self.file, json.dumps(told, ensure_ascii=False))
            except OSError as error:
                raise UsageError(f"{self.file} can't be written: {error.strerror}") from None
        self.events.append(told)
        return told


def read(file: Path) -> tuple[list[Event], list[str]]:
    """The events that a file holds, and what is wrong with it, line by line.

    A last line that was cut off, when the power failed, is left out without a word, and ended, so that
    what is added begins a line of its own.
    """
    events, faults = [], []
    *lines, cut = file.read_bytes().split(b"\n")
    if cut:
        with file.open("ab") as opened:
            opened.write(b"\n")
    for number, line in enumerate(lines, start=1):
        try:
            event = json.loads(line.decode())
        except (ValueError, RecursionError):  # no UTF-8, no JSON, or nested too deeply
            event = None
        if isinstance(event, dict) and isinstance(event.get("event"), str):
            events.append(event)
        else:
            faults.append(f"{file.name}:{number}: expected an event, as JSON in UTF-8; it is left out")
    return events, faults


def as_json(value: object, name: str) -> Download:
    """A value, to be saved as JSON."""
    return Download(json.dumps(value, ensure_ascii=False, indent=1), "application/json", name)


def as_csv(events: Iterable[Event]) -> str:
    """Events as a table, a row each, with everything that is in them; lists and objects as JSON."""
    rows = list(events)
    columns = list(dict.fromkeys((*_FIRST, *(key for event in rows for key in event))))
    return csv_of(columns, [[cell(event.get(column)) for column in columns] for event in rows])


def cell(value: Any) -> str:
    """A value in a table."""
    if value is None:
        return ""
    return value if isinstance(value, str) else json.dumps(value, ensure_ascii=False)


def record_in(place: Path) -> Path:
    """Where what is played from now on is recorded.

    Args:
        place: a file that is there, to go on with; or a folder, which the first event makes, for a new file
            named after the time.
    """
    if place.is_file():
        return place
    begun = datetime.now().astimezone().strftime("%Y-%m-%d-%H%M%S")
    numbered = (f"{begun}{f'-{number}' if number > 1 else ''}.jsonl" for number in count(1))
    return next(file for name in numbered if not (file := place / name).exists())


def made(folder: Path, option: str) -> None:
    """Make a folder where it is missing."""
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise UsageError(f"{option}: {folder} can't be made: {(error.strerror or '').lower()}") from None
