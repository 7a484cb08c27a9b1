"""Files that list actions or JSON values, and the line on which each item stands.

Actions stand one on a line; ``;`` and ``#`` start a comment, round brackets and a leading epoch (``3:``,
``3 -``) may be there or not; or the file is a JSON list of action names.  Beside JSON, whole lines may be
comments.
"""

import json
import re
from typing import Any, Final, NamedTuple, NoReturn

from serendipity.model import InputError

_EPOCH: Final = re.compile(r"^-?\s*\d+\s*[-:.]\s*")
_COMMENT: Final = re.compile(r"[;#].*")
_BLANK: Final = re.compile(r"[\s,]*")


class FileItem(NamedTuple):
    """A value of a file, and its line; None where there is no file."""

    value: Any
    line: int | None


def actions_in(text: str, path: object, what: str = "") -> list[tuple[str, int]]:
    """The names of a file's actions, as they stand there, with their lines; errors begin with ``what``."""
    if not starts_json(text):
        lines = [(action_of(line, path, number, what), number) for number, line in lines_of(text)]
        return [(name, number) for name, number in lines if name]
    found = []
    for value, number in json_items(text, path, what):
        if not isinstance(value, str):
            raise InputError(f"{what}expected the name of an action, got {value!r:.50}", path, number)
        assert number is not None, "items of a file have lines"
        found.append((value, number))
    return found


def lines_of(text: str) -> list[tuple[int, str]]:
    """The lines of a file that say something, comments apart, with their numbers."""
    lines = enumerate(text.splitlines(), start=1)
    return [(number, bare) for number, line in lines if (bare := _COMMENT.sub("", line).strip())]


def starts_json(text: str) -> bool:
    """Whether the first thing in a file, comments apart, opens a list or an object."""
    return _uncommented(text).lstrip().startswith(("[", "{"))


def json_items(text: str, path: object, what: str = "") -> list[FileItem]:
    """The items of a JSON list, each with the line on which it starts."""
    text = _uncommented(text)
    items = json_value(text, path)
    if not isinstance(items, list):
        raise InputError(f"{what}expected a JSON list", path)
    decoder = json.JSONDecoder()
    found, at = [], text.index("[") + 1
    for _ in items:
        at = _after_blank(text, at)
        value, end = decoder.raw_decode(text, at)
        found.append(FileItem(value, text.count("\n", 0, at) + 1))
        at = end
    return found


def json_value(text: str, path: object) -> Any:
    """The value that a JSON text writes down; an InputError for what is none, NaN and infinity too."""

    def refuse(constant: str) -> NoReturn:
        raise InputError(f"expected a finite number, got {constant}", path)

    try:
        return json.loads(text, parse_constant=refuse)
    except json.JSONDecodeError as error:
        what = f"{error.msg} at column {error.colno}" if text.strip() else "the file is empty"
        raise InputError(f"expected JSON: {what}", path, error.lineno) from None
    except RecursionError:
        raise InputError("expected JSON: it is nested too deeply", path) from None
    except ValueError:  # Python converts so many digits only
        raise InputError("expected numbers of at most 4300 digits", path) from None


def action_of(line: str, path: object, number: int, what: str) -> str:
    """The action of a line without comment; empty where there is none."""
    bare = _EPOCH.sub("", line, count=1)
    if bare.startswith("(") and bare.endswith(")"):
        bare = bare[1:-1].strip()
    if "(" in bare or ")" in bare:
        message = f"{what}expected one action, as 'move commx room13 hall8', got '{bare}'"
        raise InputError(message, path, number)
    return bare


def _uncommented(text: str) -> str:
    """A JSON text whose lines of comment are blank; lines keep their numbers."""
    return "\n".join("" if line.lstrip().startswith(("#", ";")) else line for line in text.splitlines())


def _after_blank(text: str, at: int) -> int:
    blank = _BLANK.match(text, at)
    return at if blank is None else blank.end()
