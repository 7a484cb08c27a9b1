"""Fills the page of commands: `--help` of each."""

import re
from collections.abc import Iterator
from typing import Any

from typer.main import get_command

from serendipity.cli.app import app

COMMANDS = "<!-- every command -->"
FETCHED = re.compile(
    r"""<(?:script|img|iframe)[^>]*\ssrc=["']?(?:https?:)?//[^>]*>|<link[^>]*\srel="(?!canonical)[^>]*\shref="https?:[^>]*>"""
)


def on_page_markdown(markdown: str, **_: Any) -> str:
    """Replace the marker of the page."""
    return markdown.replace(COMMANDS, "\n".join(every_command())) if COMMANDS in markdown else markdown


def on_post_page(output: str, page: Any, **_: Any) -> str:
    """See that the page fetches nothing from elsewhere.

    Raises:
        RuntimeError: it does.
    """
    if found := FETCHED.search(output):
        raise RuntimeError(f"{page.file.src_uri} would fetch from elsewhere: {found[0]}")
    return output


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
