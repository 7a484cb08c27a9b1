"""Fills pages from the code: `--help` of each command, the search's tables of strategies and bounds."""

import re
from collections.abc import Callable, Iterable, Iterator
from typing import Any

from typer.main import get_command

from search.bounds.registry import BOUNDS
from search.strategies.portfolio import STRATEGIES, TURNS
from serendipity.cli.app import app

FETCHED = re.compile(
    r"""<(?:script|img|iframe)[^>]*\ssrc=["']?(?:https?:)?//[^>]*>|<link[^>]*\srel="(?!canonical)[^>]*\shref="https?:[^>]*>"""
)


def on_page_markdown(markdown: str, **_: Any) -> str:
    """Replace the markers of the page."""
    for marker, lines in FILLED.items():
        if marker in markdown:
            markdown = markdown.replace(marker, "\n".join(lines()))
    return markdown


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


def every_strategy() -> Iterator[str]:
    """A line for each strategy."""
    yield from _table(
        ("strategy", "what it does"), ((f"`{name}`", does) for name, does in STRATEGIES.items())
    )


def every_turn() -> Iterator[str]:
    """A line for each turn, in their order."""
    yield from _table(
        ("turn", "of", "what it does", "where", "share of the time left", "limit"),
        (
            (
                f"`{turn.name}`",
                f"`{turn.strategy}`",
                turn.does,
                f"`{turn.applies.__name__}`",
                f"{turn.share:.0%}",
                f"{turn.limit:,}" if turn.limit else "",
            )
            for turn in TURNS
        ),
    )


def every_bound() -> Iterator[str]:
    """A line for each bound."""
    heads = ("bound", "source", "admissible for", "needs", "asked by", "in")
    yield from _table(
        heads, ((*bound[:1], *bound[2:], f"`{bound.home.partition(':')[0]}`") for bound in BOUNDS)
    )


def _table(heads: tuple[str, ...], rows: Iterable[tuple[str, ...]]) -> Iterator[str]:
    yield ""
    for cells in (heads, ("---",) * len(heads), *rows):
        yield f"| {' | '.join(cells)} |"
    yield ""


FILLED: dict[str, Callable[[], Iterator[str]]] = {
    "<!-- every command -->": every_command,
    "<!-- every strategy -->": every_strategy,
    "<!-- every turn -->": every_turn,
    "<!-- every bound -->": every_bound,
}
"""What stands on a page where a marker does."""
