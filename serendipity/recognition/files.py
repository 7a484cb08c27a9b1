"""Files of candidate goals and of observed actions.

Goals: a JSON list of ``{"name": ..., "goal": [literals], "prior": ...}``, or a goal a line,
``prior: literal, literal`` (without ``prior:`` it is 1).  Observations: an action a line, as in
the file of ``--human-plan``, or a JSON list of names.  ``#`` and ``;`` start a comment.
"""

import json
import re
from os import PathLike
from typing import Any, Final, NamedTuple, NoReturn

from serendipity.model import InputError
from serendipity.model.task import canonical_name
from serendipity.pddl.parsing.files import read_text

_COMMENT: Final = re.compile(r"[;#].*")
_EPOCH: Final = re.compile(r"^-?\s*\d+\s*[-:.]\s*")
_BLANK: Final = re.compile(r"[\s,]*")

Path = str | PathLike[str]


class Entry(NamedTuple):
    """What stands in a file, and on which line; None where there is no file."""

    value: Any
    line: int | None


def read_goals(path: Path) -> list[Entry]:
    """The goals of a file, in the form of JSON objects.

    Raises:
        InputError: it can't be read, or a line is not of either form.
    """
    text = read_text(path)
    if _starts_json(text):
        return _json_items(text, path)
    found = []
    for number, line in enumerate(text.splitlines(), start=1):
        bare = _COMMENT.sub("", line).strip()
        if bare:
            found.append(Entry(_goal_line(bare, path, number), number))
    return found


def read_observed(path: Path) -> list[tuple[str, int | None]]:
    """The names of the actions of a file, each with its line.

    Raises:
        InputError: it can't be read, or a line is not one action.
    """
    text = read_text(path)
    if _starts_json(text):
        items = _json_items(text, path)
        for item in items:
            if not isinstance(item.value, str):
                raise InputError(f"expected the name of an action, got {item.value!r}", path, item.line)
        return [(canonical_name(item.value), item.line) for item in items]
    found: list[tuple[str, int | None]] = []
    for number, line in enumerate(text.splitlines(), start=1):
        bare = _EPOCH.sub("", _COMMENT.sub("", line).strip(), count=1)
        if bare.startswith("(") and bare.endswith(")"):
            bare = bare[1:-1].strip()
        if "(" in bare or ")" in bare:
            message = f"expected one action, as 'move commx room13 hall8', got '{bare}'"
            raise InputError(message, path, number)
        if bare:
            found.append((canonical_name(bare), number))
    return found


def _goal_line(bare: str, path: Path, number: int) -> dict[str, Any]:
    prior, colon, literals = bare.rpartition(":")
    facts = [text.strip() for text in literals.split(",")]
    if not all(facts):
        raise InputError(f"expected a goal as 'prior: fact, fact', got '{bare}'", path, number)
    return {"goal": facts, "prior": prior.strip() if colon else "1"}


def _starts_json(text: str) -> bool:
    """Whether the first thing in a file, comments apart, opens a list or an object."""
    return _uncommented(text).lstrip().startswith(("[", "{"))


def _uncommented(text: str) -> str:
    """A JSON text whose lines of comment are blank; lines keep their numbers."""
    return "\n".join("" if line.lstrip().startswith(("#", ";")) else line for line in text.splitlines())


def _json_items(text: str, path: Path) -> list[Entry]:
    """The items of a JSON list, each with the line on which it starts."""
    text = _uncommented(text)

    def refuse(constant: str) -> NoReturn:
        raise InputError(f"expected a finite number, got {constant}", path)

    decoder = json.JSONDecoder(parse_constant=refuse)
    try:
        items = decoder.decode(text)
    except json.JSONDecodeError as error:
        raise InputError(f"expected JSON: {error.msg} at column {error.colno}", path, error.lineno) from None
    except RecursionError:
        raise InputError("expected JSON: it is nested too deeply", path) from None
    if not isinstance(items, list):
        raise InputError("expected a JSON list", path)
    found, at = [], text.index("[") + 1
    for _ in items:
        at = _after_blank(text, at)
        value, end = decoder.raw_decode(text, at)
        found.append(Entry(value, text.count("\n", 0, at) + 1))
        at = end
    return found


def _after_blank(text: str, at: int) -> int:
    blank = _BLANK.match(text, at)
    return at if blank is None else blank.end()
