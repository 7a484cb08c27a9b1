"""Type checks of arguments of public calls: one sentence for a value of another type."""

from collections.abc import Callable, Iterable, Mapping
from os import PathLike, fsencode, fspath
from typing import Final, NamedTuple

from serendipity.model.answers.result import Result
from serendipity.model.errors import UsageError
from serendipity.model.options import Options
from serendipity.model.resources.deadline import Deadline
from serendipity.model.task.gate import refuse_time
from serendipity.model.task.task import Task


class Kind(NamedTuple):
    """A kind of arguments."""

    words: str
    fits: Callable[[object], bool]


def _is_path(value: object) -> bool:
    text = fspath(value) if isinstance(value, PathLike) else value
    try:
        return isinstance(text, str) and b"\0" not in fsencode(text)
    except UnicodeEncodeError:
        return False


def _is_pair(value: object) -> bool:
    return isinstance(value, tuple | list) and len(value) == 2 and all(map(_is_path, value))


def _is_whole(value: object) -> bool:
    return isinstance(value, int) and not isinstance(value, bool)


def _has_names(value: object) -> bool:
    return isinstance(value, Mapping) and all(isinstance(name, str) for name in value)


def _is_list(value: object) -> bool:
    return isinstance(value, Iterable) and not isinstance(value, str | bytes)


TASK_IN_TIME: Final = Kind("a Task, such as serendipity.load gives", lambda value: isinstance(value, Task))
TASK: Final = Kind("a Task, such as serendipity.load gives", lambda value: isinstance(value, Task))
RESULT: Final = Kind("a Result, such as serendipity.plan gives", lambda value: isinstance(value, Result))
RESULT_IN_TIME: Final = Kind(RESULT.words, RESULT.fits)
PATH: Final = Kind("a path", _is_path)
TEXT: Final = Kind("a text", lambda value: isinstance(value, str))
PAIR: Final = Kind("the paths of a domain and of a problem", _is_pair)
WHOLE: Final = Kind("a whole number", _is_whole)
FLAG: Final = Kind("true or false", lambda value: isinstance(value, bool))
FUNCTION: Final = Kind("a function", callable)
LIST: Final = Kind("a list", _is_list)
BY_NAME: Final = Kind("a mapping from names", _has_names)
DEADLINE: Final = Kind("a Deadline", lambda value: isinstance(value, Deadline))


def expect(kind: Kind, **given: object) -> None:
    """Return if arguments are of a kind.

    Raises:
        UsageError: naming the first that is not, what was expected and what was given; or a task needs time.
    """
    for name, value in given.items():
        if not kind.fits(value):
            raise UsageError(f"{name}: expected {kind.words}, got {shown(value)}")
        if kind is TASK and isinstance(value, Task):
            refuse_time(value)
        elif kind is RESULT and isinstance(value, Result) and isinstance(value.options, Options):
            refuse_time(options=value.options, plan=value.human_plan_times)


def expect_or_none(kind: Kind, **given: object) -> None:
    """The same for arguments that may be left out."""
    expect(kind, **{name: value for name, value in given.items() if value is not None})


def shown(value: object) -> str:
    """A value in one line, whatever it is: the beginning of what Python writes, or its type."""
    try:
        words = " ".join(repr(value).split())
    except Exception:
        words = f"a value of type {type(value).__name__}"
    return words[:50]
