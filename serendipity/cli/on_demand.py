"""The commands, each loaded when somebody asks for it: all of them take longer than most answers.

None is begun where a file is named twice: to read and to write, or to write for two purposes.
"""

from collections.abc import Callable, Iterator, Mapping
from contextlib import suppress
from functools import wraps
from importlib import import_module
from pathlib import Path
from typing import Any, Final

import typer
from typer.core import TyperGroup
from typer.main import get_command

from serendipity.cli.groups import spread
from serendipity.cli.help_examples import epilog
from serendipity.cli.streams.manner import Manner
from serendipity.model import UsageError

NAMES: Final = (
    *("plan", "check-task", "verify", "check-proof", "simulate", "execute", "explain", "interruptions"),
    "front",
    *("recognise", "learn", "reproduce", "show", "solve", "crosscheck", "league", "bench"),
    *("examples", "generate", "play", "serve", "mcp"),
)
"""As ``--help`` lists them: each a function in a module, both of its name, or a group ``app`` there."""


class Commands(TyperGroup):
    """The commands as a group that loads the one that is called."""

    def __init__(self, **attributes: Any) -> None:
        super().__init__(**attributes)
        self.commands = _OnDemand()  # type: ignore[assignment]


class _OnDemand(Mapping[str, Any]):
    """What typer makes of each command, by name."""

    def __init__(self) -> None:
        self._made: dict[str, Any] = {}

    def __getitem__(self, name: str) -> Any:
        if name not in NAMES:
            raise KeyError(name)
        if name not in self._made:
            self._made[name] = _command(name)
        return self._made[name]

    def __iter__(self) -> Iterator[str]:
        return iter(NAMES)

    def __len__(self) -> int:
        return len(NAMES)


def _command(name: str) -> Any:
    function = name.replace("-", "_")
    module = import_module(f"serendipity.cli.commands.{function}")
    group = getattr(module, "app", None)
    if group is not None:
        return get_command(group)
    single = typer.Typer(add_completion=False, rich_markup_mode=None)
    written: dict[str, str] = {}
    single.command(name, epilog=epilog(name))(
        _overwriting_nothing(spread(getattr(module, function), Manner), written)
    )
    command = get_command(single)
    for parameter in command.params:
        for option in set(parameter.opts) & WRITTEN:
            written[str(parameter.name)] = option
    return command


def _overwriting_nothing(function: Callable[..., int], written: Mapping[str, str]) -> Callable[..., int]:
    """A command that is not begun where what it writes would replace what it reads."""

    @wraps(function)
    def call(**values: Any) -> int:
        check(values, written)
        return function(**values)

    return call


WRITTEN: Final = frozenset(
    (
        *("-o", "--save-plan", "--proof", "--heat-map", "--log", "--clip", "--plot", "--report", "--journal"),
        *("--picture", "--tables"),
    )
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
            if any(_takes(place, other) for other in read):
                raise UsageError(f"{option}: expected another file than {values[name]}, which is read")
            for other, first in written.items():
                if _takes(place, other) or _takes(other, place):
                    raise UsageError(f"{option}: expected another file than {first} writes")
            written[place] = option


def _takes(place: Path, other: Path) -> bool:
    """Whether what is written to a place takes another one: a proof for VeriPB has several files."""
    if place.suffix != ".pbp":
        return place == other
    from serendipity.writing.veripb import is_of

    return is_of(other, place)


def _places(name: str, value: object) -> Iterator[Path]:
    """Files that a value names and that can be replaced: devices can't, and nobody writes to folders."""
    if isinstance(value, Path) and name == "tables":
        yield from _places("", [Path(f"{value}{number}.csv") for number in (1, 2)])
    elif isinstance(value, Path):
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
