"""Files to units: reading text, and putting file names into errors."""

from codecs import BOM_UTF16_BE, BOM_UTF16_LE
from collections.abc import Iterator
from contextlib import contextmanager
from io import TextIOWrapper
from os import PathLike
from pathlib import Path
from re import compile as regex
from typing import Final

from serendipity.model import InputError
from serendipity.pddl.parsing.lifted import Unit
from serendipity.pddl.parsing.resolve import read_domain, read_problem
from serendipity.pddl.work import Work

_CONTROL: Final = regex(r"[\x00-\x08\x0e-\x1f\x7f-\x9f\u202a-\u202e\u2066-\u2069\ufeff]")
"""Characters that are no text, and those that turn the direction in which others are shown."""

_CHUNK: Final = 2**16

_MANY: Final = 16
"""Chunks between two looks at how much memory there is."""

_BYTES_PER_CHARACTER: Final = 30
"""Bytes that are made of a character of a file before any action is grounded, measured."""


PathArgument = str | PathLike[str]


def read_unit(owner: str | None, domain: PathArgument, problem: PathArgument, work: Work) -> Unit:
    """Read and check a domain file and its problem file."""
    with _reading(domain, work):
        checked_domain = read_domain(read_text(domain, work), work)
    with _reading(problem, work):
        checked_problem = read_problem(read_text(problem, work), checked_domain, work)
    return Unit(owner, str(domain), str(problem), checked_domain, checked_problem)


def read_text(path: PathArgument, work: Work | None = None) -> str:
    """The text of a file; all its lines end as in Unix."""
    try:
        return _read(path, work or Work())
    except FileNotFoundError:
        raise InputError("there is no such file", path) from None
    except UnicodeDecodeError:
        raise InputError("the file is not text in UTF-8", path) from None
    except OSError as error:
        raise InputError(f"the file can't be read: {(error.strerror or str(error)).lower()}", path) from None
    except ValueError as error:
        raise InputError(f"not the name of a file: {error}", path) from None


def _read(path: PathArgument, work: Work) -> str:
    """The text of a file, as long as what is made of it fits into memory.

    It is UTF-8, or with a byte order mark UTF-16, as Windows' shells write it.
    """
    parts: list[str] = []
    with Path(path).open("rb") as file:
        marked = file.peek(2)[:2] in (BOM_UTF16_LE, BOM_UTF16_BE)
        text = TextIOWrapper(file, "utf-16" if marked else "utf-8-sig")
        while part := text.read(_CHUNK):
            control = _CONTROL.search(part)
            if control is not None:
                line = "".join((*parts, part[: control.start()])).count("\n") + 1
                raise InputError("the file is not text: it has control characters", path, line)
            parts.append(part)
            work.deadline.check()
            if not len(parts) % _MANY:
                work.require(len(parts) * _CHUNK * _BYTES_PER_CHARACTER, f"reading {path}")
    return "".join(parts)


@contextmanager
def _reading(path: PathArgument, work: Work) -> Iterator[None]:
    work.stage(f"reading {path}")
    try:
        yield
    except InputError as error:
        if error.file is not None:
            raise
        raise InputError(error.message, path, error.line) from None
    except RecursionError:
        raise InputError("brackets are nested too deeply", path) from None
