"""The commands, each loaded when somebody asks for it: all of them take longer than most answers."""

from collections.abc import Callable, Iterator, Mapping
from functools import wraps
from importlib import import_module
from typing import Any, Final

import typer
from typer.core import TyperGroup
from typer.main import get_command

from serendipity.cli.groups import spread
from serendipity.cli.help_examples import epilog
from serendipity.cli.options import overwriting
from serendipity.cli.streams.manner import Manner

NAMES: Final = (
    *("plan", "check-task", "verify", "check-proof", "simulate", "execute", "explain", "interruptions"),
    *("recognise", "reproduce", "show", "solve", "crosscheck", "bench"),
    *("examples", "generate", "play", "serve"),
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
        for option in set(parameter.opts) & overwriting.WRITTEN:
            written[str(parameter.name)] = option
    return command


def _overwriting_nothing(function: Callable[..., int], written: Mapping[str, str]) -> Callable[..., int]:
    """A command that is not begun where what it writes would replace what it reads."""

    @wraps(function)
    def call(**values: Any) -> int:
        overwriting.check(values, written)
        return function(**values)

    return call
