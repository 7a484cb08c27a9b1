"""Texts of unknown origin, made fit for a terminal, a page, a picture or a JSON file.

Names come from files, and files from anywhere: a name may hold characters that move a terminal's
cursor, that turn the direction of writing round, or that nobody sees.
"""

import re
from typing import Final

LONGEST: Final = 300
"""Characters of a message to people."""

_NOT_PLAIN: Final = re.compile(r"[^\n\x20-\x7e]")


def printable(text: str) -> str:
    r"""A text on one line; characters that can't be seen are written as their codes, as ``\u202e``."""
    if text.isprintable():
        return text
    return "".join(c if c.isprintable() else c.encode("unicode_escape").decode("ascii") for c in text)


def message(text: str, longest: int = LONGEST) -> str:
    """A message to people: on one line, printable, and without its middle where it is longer."""
    line = printable(" ".join(text.split()))
    if len(line) <= longest:
        return line
    half = (longest - 3) // 2
    return f"{line[: longest - 3 - half]} … {line[len(line) - half :]}"


def markup(text: str) -> str:
    """A text for a page or an SVG: printable, and without any meaning in HTML."""
    from html import escape

    return escape(printable(text))


def printable_json(text: str) -> str:
    r"""A JSON text with the characters that can't be seen escaped, as JSON has it: ``\u202e``."""
    return _NOT_PLAIN.sub(_escaped, text)


def _escaped(found: re.Match[str]) -> str:
    character = found[0]
    if character.isprintable():
        return character
    units = character.encode("utf-16-be", "surrogatepass")
    return "".join(f"\\u{units[i]:02x}{units[i + 1]:02x}" for i in range(0, len(units), 2))
