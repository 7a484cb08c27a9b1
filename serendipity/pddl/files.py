"""Files to units: reading text, and putting file names into errors."""

from collections.abc import Iterator
from contextlib import contextmanager
from os import PathLike
from pathlib import Path
from re import compile as regex
from typing import Final

from serendipity.model import InputError
from serendipity.pddl.lifted import Unit
from serendipity.pddl.resolve import read_domain, read_problem

_CONTROL: Final = regex(r"[\x00-\x08\x0e-\x1f\x7f]")


def read_unit(owner: str | None, domain: str | PathLike[str], problem: str | PathLike[str]) -> Unit:
    """Read and check a domain file and its problem file.

    Raises:
        InputError: with file, line and what was expected.
    """
    with _errors_in(domain):
        checked_domain = read_domain(read_text(domain))
    with _errors_in(problem):
        checked_problem = read_problem(read_text(problem), checked_domain)
    return Unit(owner, str(domain), str(problem), checked_domain, checked_problem)


def read_text(path: str | PathLike[str]) -> str:
    """The text of a file.

    Raises:
        InputError: it is missing, can't be read, or is not text.
    """
    try:
        text = Path(path).read_bytes().decode("utf-8-sig")
    except FileNotFoundError:
        raise InputError("there is no such file", path) from None
    except UnicodeDecodeError:
        raise InputError("the file is not text in UTF-8", path) from None
    except OSError as error:
        raise InputError(f"the file can't be read: {(error.strerror or str(error)).lower()}", path) from None
    except ValueError as error:
        raise InputError(f"not the name of a file: {error}", path) from None
    control = _CONTROL.search(text)
    if control is not None:
        line = text.count("\n", 0, control.start()) + 1
        raise InputError("the file is not text: it has control characters", path, line)
    return text


@contextmanager
def _errors_in(path: str | PathLike[str]) -> Iterator[None]:
    try:
        yield
    except InputError as error:
        if error.file is not None:
            raise
        raise InputError(error.message, path, error.line) from None
    except RecursionError:
        raise InputError("brackets are nested too deeply", path) from None
