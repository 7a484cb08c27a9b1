"""Files that a command line names twice: to read and to write, or to write for two purposes."""

from collections.abc import Iterator, Mapping
from contextlib import suppress
from pathlib import Path
from typing import Any, Final

from serendipity.model import UsageError

WRITTEN: Final = frozenset(
    ("-o", "--save-plan", "--proof", "--heat-map", "--log", "--clip", "--plot", "--report", "--journal")
)
"""Options that name a file to be written."""

_PAIRS: Final = ("agent", "team")
"""Parameters whose texts are DOMAIN,PROBLEM, the first behind NAME=."""


def check(values: Mapping[str, Any], options: Mapping[str, str]) -> None:
    """Complain about an answer that would take the place of what it was made of, or of another one.

    Args:
        values: of each parameter of a command, by its name.
        options: what each parameter that names a file to be written is called on the command line.

    Raises:
        UsageError: a file would be read and written, or written twice.
    """
    read = {place for name, value in values.items() if name not in options for place in _places(name, value)}
    written: dict[Path, str] = {}
    for name, option in options.items():
        for place in _places(name, values.get(name)):
            if place in read:
                raise UsageError(f"{option}: expected another file than {values[name]}, which is read")
            if place in written:
                raise UsageError(f"{option}: expected another file than {written[place]} names")
            written[place] = option


def _places(name: str, value: object) -> Iterator[Path]:
    """Files that a value names and that can be replaced: devices can't, and nobody writes to folders."""
    if isinstance(value, Path):
        place = value.resolve()
        with suppress(OSError):  # a name that is too long: whoever reads or writes it says so
            if place.is_file() or not place.exists():
                yield place
    elif isinstance(value, list):
        for part in value:
            yield from _places(name, part)
    elif isinstance(value, str) and name in _PAIRS:
        for file in value.rpartition("=")[2].split(","):
            yield from _places(name, Path(file))
