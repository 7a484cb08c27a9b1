"""Files to units: reading text, and putting file names into errors."""

from collections.abc import Iterator
from contextlib import contextmanager
from os import PathLike
from pathlib import Path

from serendipity.model import InputError
from serendipity.pddl.lifted import Unit
from serendipity.pddl.resolve import read_domain, read_problem


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
    if "\0" in text:
        raise InputError("the file is binary, expected PDDL text", path, text.count("\n", 0, text.index("\0")) + 1)
    return text


@contextmanager
def _errors_in(path: str | PathLike[str]) -> Iterator[None]:
    try:
        yield
    except InputError as error:
        if error.file is not None:
            raise
        raise InputError(error.message, path, error.line) from None
