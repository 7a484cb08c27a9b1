"""Fills the reference pages: `--help` of every command, signatures and docstrings of every public name."""

import inspect
import re
import shlex
from typing import Any

from typer.main import get_command

import serendipity
from serendipity.cli.app import app

HELP = re.compile(r"^<!-- help: (.*?) -->$", re.MULTILINE)
PUBLIC = re.compile(r"^<!-- public: (.*?) -->$", re.MULTILINE)

LONGEST = 90


def on_page_markdown(markdown: str, **_: Any) -> str:
    """Replace the markers of a page."""
    markdown = HELP.sub(lambda found: help_text(found[1]), markdown)
    return PUBLIC.sub(lambda found: description(found[1]), markdown)


def help_text(command: str) -> str:
    """What `serendipity COMMAND --help` prints, as a block."""
    at: Any = get_command(app)
    context = at.make_context("serendipity", [], resilient_parsing=True)
    for word in shlex.split(command):
        at = at.commands[word]
        context = at.make_context(word, [], parent=context, resilient_parsing=True)
    return f"```text\n{at.get_help(context)}\n```"


def description(name: str) -> str:
    """A public name: its signature and its docstring."""
    value = getattr(serendipity, name)
    doc = re.sub(r":(?:func|class|meth):`~?(?:[\w.]+\.)?(\w+)`", r"`\1`", inspect.getdoc(value) or "")
    return "\n".join([f"### {name}", "", "```text", signature(name, value), "", doc, "```", ""])


def signature(name: str, value: Any) -> str:
    """How a name is called: a parameter a line where one line is too long for them."""
    if inspect.isclass(value) and issubclass(value, Exception):
        return f"exception {name}"
    kind = "class" if inspect.isclass(value) else "def"
    called = inspect.signature(value)
    line = f"{kind} {name}{called}"
    if len(line) <= LONGEST:
        return line
    parts = [f"    {parameter}," for parameter in called.parameters.values()]
    return "\n".join([f"{kind} {name}(", *parts, ")"])
