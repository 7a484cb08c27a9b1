"""What was measured, a line of JSON for each part, so that a measurement that was stopped goes on."""

import json
from collections.abc import Iterator
from pathlib import Path
from typing import Any


class Record:
    """Lines of a file, each found again by its key.

    Args:
        file: where they are; None: nowhere but in memory.
    """

    def __init__(self, file: Path | None) -> None:
        self._file = file
        self._known: dict[str, Any] = {}
        if file is not None and file.exists():
            self._known = dict(_whole_lines(file))

    def __contains__(self, key: str) -> bool:
        return key in self._known

    def get(self, key: str) -> Any:
        """What was found; None where there is nothing."""
        return self._known.get(key)

    def add(self, key: str, found: Any) -> None:
        """Note a part, and write it down at once."""
        self._known[key] = found
        if self._file is not None:
            with self._file.open("a") as file:
                file.write(json.dumps([key, found]) + "\n")


def _whole_lines(file: Path) -> Iterator[tuple[str, Any]]:
    """What was written to its end; the file is cut behind that."""
    text = file.read_text()
    whole = text[: text.rfind("\n") + 1]
    if whole != text:
        file.write_text(whole)
    for line in whole.splitlines():
        key, found = json.loads(line)
        yield key, found
