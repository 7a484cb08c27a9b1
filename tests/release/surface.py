"""The public surface as text: names, signatures, commands, options, exit codes and schemas.

python -m tests.release.surface          writes surface.txt anew
"""

import inspect
import re
from collections.abc import Iterator
from importlib import import_module
from pathlib import Path
from typing import Any, get_origin

from typer.main import get_command

from serendipity.cli.app import app
from serendipity.cli.exit_codes import ExitCode

ROOT = Path(__file__).resolve().parents[2]
WRITTEN = Path(__file__).parent / "surface.txt"
MODULES = (
    "serendipity",
    "serendipity.aio",
    "serendipity.execution",
    "serendipity.robot",
    "serendipity.up",
    "serendipity.testing",
    "serendipity.testing.league",
)

PARTS = {"serendipity.Deadline": {"check", "elapsed", "left", "reached", "within"}}
"""Classes of which only these methods are public; the others are for loops and tables of our own."""

_SCHEMA = re.compile(r'"(serendipity\.[a-z-]+/[0-9]+)"')
_MOVED = (("pathlib._local.", "pathlib."), ("collections.abc.", ""), ("fractions.", ""), ("typing.", ""))
"""What signatures say otherwise in other versions of Python, or at greater length than is needed."""

_INNER = r"\[((?:[^][]|\[[^][]*\])*)\]"
_OPTIONAL, _UNION = re.compile(f"Optional{_INNER}"), re.compile(f"Union{_INNER}")
_COMMA = re.compile(r", (?![^[]*\])")
"""Unions as Python 3.14 writes them; commas within brackets stay."""


def surface() -> str:
    """All of it, a name or an option a line."""
    return "".join(f"{line}\n" for line in (*_names(), *_commands(), *_codes(), *_schemas()))


def _names() -> Iterator[str]:
    for module in map(import_module, MODULES):
        for name in sorted(getattr(module, "__all__", ())):
            value = getattr(module, name)
            if inspect.isclass(value):
                yield from _class(f"{module.__name__}.{name}", value)
            elif get_origin(value) is not None:  # a type by another name
                yield f"{module.__name__}.{name} = {_annotation(value)}"
            elif callable(value):
                yield f"{module.__name__}.{name}{_signature(value)}"
            else:
                yield f"{module.__name__}.{name}"


def _class(path: str, kind: type) -> Iterator[str]:
    bases = ", ".join(base.__name__ for base in kind.__bases__ if base is not object)
    yield f"{path}{f' < {bases}' if bases else ''}: {_signature(kind)}"
    ours = [base for base in kind.__mro__ if base.__module__.startswith("serendipity")]
    names = {name for base in ours for name in vars(base) if not name.startswith("_")}
    for name in sorted(names & PARTS.get(path, names)):
        value = inspect.getattr_static(kind, name)
        if isinstance(value, staticmethod | classmethod):
            value = value.__func__
        if isinstance(value, property) and value.fget is not None:
            yield f"{path}.{name} -> {_annotation(inspect.signature(value.fget).return_annotation)}"
        elif inspect.isfunction(value):
            yield f"{path}.{name}{_signature(value)}"


def _signature(value: Any) -> str:
    try:
        return _plain(str(inspect.signature(value)))
    except ValueError:  # written in C
        return "(...)"


def _annotation(value: Any) -> str:
    return _plain(inspect.formatannotation(value))


def _plain(text: str) -> str:
    for old, new in _MOVED:
        text = text.replace(old, new)
    text = _UNION.sub(lambda found: _COMMA.sub(" | ", found[1]), _OPTIONAL.sub(r"\1 | None", text))
    text = text.replace("NoneType", "None").replace(" = Ellipsis", " = ...")
    return re.sub(r"serendipity(_[a-z]+)?(\.\w+)+\.(?=\w)", "", text)


def _commands() -> Iterator[str]:
    root: Any = get_command(app)
    yield from _command("serendipity", root)


def _command(path: str, command: Any) -> Iterator[str]:
    for parameter in sorted(command.params, key=lambda each: (each.param_type_name, each.name)):
        words = " ".join([*parameter.opts, *parameter.secondary_opts])
        values = getattr(parameter.type, "choices", None)
        yield f"$ {path} {words}: {'|'.join(map(str, values)) if values else parameter.type.name}"
    if not command.params:
        yield f"$ {path}"
    for name, inner in sorted(getattr(command, "commands", {}).items()):
        yield from _command(f"{path} {name}", inner)


def _codes() -> Iterator[str]:
    return (f"exit {code.value} {code.name}" for code in ExitCode)


def _schemas() -> Iterator[str]:
    """The schemas in the code, whatever else is said about them."""
    found = {
        schema
        for package in ("serendipity", "verify", "serendipity_live", "serendipity_testing")
        for path in (ROOT / package).rglob("*.py")
        for schema in _SCHEMA.findall(path.read_text(encoding="utf-8"))
    }
    return (f"schema {schema}" for schema in sorted(found))


if __name__ == "__main__":
    WRITTEN.write_text(surface(), encoding="utf-8")
