"""Reading the files that a command line names: one clear line for what is wrong with them."""

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Annotated, Any

import serendipity
from serendipity.cli.choices import option
from serendipity.model import Deadline, InputError, Result, Task

Strict = Annotated[
    bool, option("--strict", "Exit with 1 where the result breaks a rule; else that is a warning.")
]


def read_text(path: Path) -> str:
    """The text of a file, with or without a byte order mark; its lines may end as on any system."""
    try:
        return path.read_text(encoding="utf-8-sig")
    except UnicodeDecodeError:
        raise InputError("expected a text in UTF-8", path) from None
    except OSError as error:
        raise InputError(f"can't be read: {error.strerror}", path) from None


def read_json(path: Path) -> Any:
    """The value that a JSON file writes down (NaN and infinity are not JSON), or an InputError."""
    from serendipity.pddl.parsing.lists import json_value  # with json, which planning does without

    return json_value(read_text(path), path)


@contextmanager
def about(file: Path | None) -> Iterator[None]:
    """Have errors in what was read name the file that it was read from, where they name none."""
    try:
        yield
    except InputError as error:
        raise InputError(error.message, error.file or file) from None


def broken_rule(task: Task, result: Result, file: Path, deadline: Deadline | None = None) -> str | None:
    """What is wrong with a result that does not replay, as a warning; None where nothing is."""
    with about(file):
        wrong = serendipity.check(task, result, deadline=deadline).refuted
    return None if wrong is None else f"{file} does not hold: {wrong.claim}: {wrong.reason}"
