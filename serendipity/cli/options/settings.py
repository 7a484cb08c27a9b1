"""Settings of a project: agents and options that need not be given again with every command.

They stand in ``serendipity.toml``, or in ``[tool.serendipity]`` of a ``pyproject.toml``, in the working
directory or the nearest folder above it that has one of them.  The command line overrides them.
"""

from collections.abc import Mapping
from contextvars import ContextVar
from dataclasses import dataclass, field, fields
from pathlib import Path
from typing import Any, Final

from serendipity.model import INFINITE, InputError, Options, UsageError

COMMANDS: Final = (
    *("plan", "check-task", "verify", "check-proof", "simulate", "execute", "explain"),
    *("interruptions", "front", "recognise", "learn", "show", "solve", "play"),
)
"""Commands about one task: those that settings are for."""

OPTIONS: Final = tuple(each.name for each in fields(Options))
AGENTS: Final = ("human", "robots", "agents", "team")

_NAMESAKES: Final = {"execute": ("ties", "human_model", "mode"), "simulate": ("human_model",)}
"""By command, its options that mean something else."""

_FILE: Final = "serendipity.toml"
_SHARED: Final = "pyproject.toml"
_TABLE: Final = "tool.serendipity"


@dataclass(frozen=True, slots=True)
class Settings:
    """What a file says.

    Attributes:
        file: where it stands; None without any.
        robots: names of robots, for tasks that are DOMAIN PROBLEM.
        agents: words of ``--agent``, for when the command line names no task.
        team: the word of ``--team`` beside them.
        options: fields of ``Options``, as texts and flags.
    """

    file: Path | None = None
    human: str | None = None
    robots: tuple[str, ...] = ()
    agents: tuple[str, ...] = ()
    team: str | None = None
    options: Mapping[str, Any] = field(default_factory=dict)


_NONE: Final = Settings()
_in_force: ContextVar[Settings] = ContextVar("settings", default=_NONE)
"""Of the command that is running."""


def begin(command: str) -> dict[str, Any]:
    """Put the settings for the working directory in force; its options, where the command line has none."""
    try:
        found = find(Path.cwd())
    except FileNotFoundError:  # somebody has removed it
        found = _NONE
    _in_force.set(found)
    others = _NAMESAKES.get(command, ())
    return {name: value for name, value in found.options.items() if name not in others}


def in_force() -> Settings:
    """The settings of the command that is running; those of no file where it heeds none."""
    return _in_force.get()


def origin(message: str) -> str:
    """Where an option was set that an error is about, if it is one of the settings."""
    known = in_force()
    return f" (settings: {known.file})" if message.partition(":")[0] in known.options else ""


def find(folder: Path) -> Settings:
    """The settings for a working directory: those of the nearest folder, from it upwards, that has some."""
    for place in (folder, *folder.parents):
        own, shared = place / _FILE, place / _SHARED
        if _there(own):
            return _read(_Table(own, _parsed(own)))
        if _there(shared) and (values := _ours(shared)) is not None:
            return _read(_Table(shared, values, f"{_TABLE}."))
    return Settings()


@dataclass(frozen=True, slots=True)
class _Table:
    """The table with settings in a file; ``prefix`` is what its keys have in front there."""

    file: Path
    values: Mapping[str, Any]
    prefix: str = ""

    def wrong(self, key: str, expected: str, value: object) -> InputError:
        return InputError(f"{self.prefix}{key}: expected {expected}, got {value!r:.50}", self.file)

    def text(self, key: str) -> str | None:
        value = self.values.get(key)
        if value is not None and (not isinstance(value, str) or not value):
            raise self.wrong(key, "a name", value)
        return value

    def pair(self, key: str, value: object) -> str:
        """Two files, which are meant from the folder of the settings on, as a command line names them."""
        if not _texts(value) or len(value) != 2:  # type: ignore[arg-type]
            raise self.wrong(key, '["DOMAIN", "PROBLEM"]', value)
        return ",".join(str(self.file.parent / name) for name in value)  # type: ignore[attr-defined]


def _read(table: _Table) -> Settings:
    for key in table.values:
        if key not in (*AGENTS, *OPTIONS):
            expected = f"expected {', '.join(AGENTS)}, or an option of `plan` such as window_weight"
            raise InputError(f"{table.prefix}{key}: there is no such setting; {expected}", table.file)
    robots = table.values.get("robots", [])
    if not _texts(robots):
        raise table.wrong("robots", "a list of names", robots)
    pairs = table.values.get("agents", {})
    if not isinstance(pairs, dict):
        raise table.wrong("agents", 'a table of NAME = ["DOMAIN", "PROBLEM"]', pairs)
    team = table.values.get("team")
    if team is not None and not pairs:
        raise table.wrong("team", "agents beside it", team)
    return Settings(
        file=table.file,
        human=table.text("human"),
        robots=tuple(robots),
        agents=tuple(f"{name}={table.pair(f'agents.{name}', files)}" for name, files in pairs.items()),
        team=None if team is None else table.pair("team", team),
        options={name: _option(table, name) for name in OPTIONS if name in table.values},
    )


def _option(table: _Table, name: str) -> str | bool:
    """An option as the command line would have it."""
    value = table.values[name]
    if not isinstance(value, bool | int | float | str):
        raise table.wrong(name, "a text, a number, true or false", value)
    given: dict[str, Any] = {"mode": _mode_for(name, value), name: value}
    try:
        Options(**given)
    except UsageError as error:
        raise InputError(f"{table.prefix}{error}", table.file) from None
    return value if isinstance(value, bool) else str(value)


def _mode_for(name: str, value: object) -> str:
    """A mode in which a value is legal, if it is in any: which one is asked for shows later."""
    if name == "keep_prefix":
        return "communication"
    return "composite" if name == "horizon" and value == INFINITE else "serendipity"


def _texts(value: object) -> bool:
    return isinstance(value, list) and all(isinstance(text, str) and text for text in value)


def _ours(file: Path) -> dict[str, Any] | None:
    """Our table in a file that others have tables in, too; None where it has none, whatever else is wrong."""
    try:
        mentioned = f"[{_TABLE}".encode() in file.read_bytes()
    except OSError:
        return None
    if not mentioned:
        return None
    found = _parsed(file).get("tool", {}).get("serendipity")
    return found if isinstance(found, dict) else None


def _there(file: Path) -> bool:
    try:
        return file.is_file()
    except OSError:  # in a folder that nobody may look into
        return False


def _parsed(file: Path) -> dict[str, Any]:
    import tomllib

    from serendipity.cli.files.reading import read_text

    try:
        return tomllib.loads(read_text(file))
    except tomllib.TOMLDecodeError as error:
        raise InputError(f"expected TOML: {error}", file) from None
    except RecursionError:
        raise InputError("expected TOML: it is nested too deeply", file) from None
