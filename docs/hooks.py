"""Fills the reference pages: `--help` of every command, signatures and docstrings of every public name."""

import inspect
import re
from collections.abc import Iterator, Mapping
from types import ModuleType
from typing import Any

from typer.main import get_command

import serendipity
import serendipity.testing
from serendipity.cli.app import app

COMMANDS = "<!-- every command -->"
PUBLIC = re.compile(r"^<!-- public: (.*?) -->$", re.MULTILINE)
KIT = "<!-- every name of the testing kit -->"
OTHERS = "<!-- public names not listed above -->"
LONGEST = 90


def on_page_markdown(markdown: str, **_: Any) -> str:
    """Replace the markers of a page."""
    if COMMANDS in markdown:
        markdown = markdown.replace(COMMANDS, "\n".join(every_command()))
    if OTHERS in markdown:
        listed = {"__version__", *PUBLIC.findall(markdown)}
        rest = [name for name in serendipity.__all__ if name not in listed]
        markdown = markdown.replace(OTHERS, "\n".join(f"<!-- public: {name} -->" for name in rest))
    if KIT in markdown:
        names = [description(name, serendipity.testing) for name in serendipity.testing.__all__]
        markdown = markdown.replace(KIT, "\n".join(names))
    return PUBLIC.sub(lambda found: description(found[1], serendipity), markdown)


def every_command() -> Iterator[str]:
    """For each command what `serendipity COMMAND --help` prints, under a heading."""
    root: Any = get_command(app)
    context = root.make_context("serendipity", [], resilient_parsing=True)
    yield from _commands(root, context, "")


def _commands(group: Any, context: Any, above: str) -> Iterator[str]:
    for name, command in group.commands.items():
        inner = command.make_context(name, [], parent=context, resilient_parsing=True)
        if hasattr(command, "commands"):
            yield from _commands(command, inner, f"{above}{name} ")
        else:
            yield from (f"## {above}{name}", "", "```text", command.get_help(inner), "```", "")


def description(name: str, package: ModuleType) -> str:
    """A public name: its signature and its docstring."""
    value = getattr(package, name)
    doc = re.sub(r":(?:func|class|meth):`~?(?:[\w.]+\.)?(\w+)`", r"`\1`", text(value))
    return "\n".join([f"### {name}", "", "```text", signature(name, value), "", doc, "```", ""])


def text(value: Any) -> str:
    """A docstring; of functions by name, what each of them is for."""
    if isinstance(value, Mapping):
        return "\n".join(
            f"{name}: {(inspect.getdoc(each) or '').splitlines()[0]}" for name, each in value.items()
        )
    if isinstance(value, tuple):
        return "\n".join(map(str, value))
    return inspect.getdoc(value) or ""


def signature(name: str, value: Any) -> str:
    """How a name is called: a parameter a line where one line is too long for them."""
    if not callable(value):
        return name
    if inspect.isclass(value) and issubclass(value, Exception):
        return f"exception {name}"
    kind = "class" if inspect.isclass(value) else "def"
    called = inspect.signature(value)
    line = f"{kind} {name}{called}"
    if len(line) <= LONGEST:
        return line
    parts = [f"    {parameter}," for parameter in called.parameters.values()]
    return "\n".join([f"{kind} {name}(", *parts, ")"])
