"""The errors a caller can meet.  Each message is one line that says what to do."""

from typing import Final


class SerendipityError(Exception):
    """Base of every error of the project; its text is one actionable line."""


class UsageError(SerendipityError):
    """An option or argument is wrong, or two of them contradict each other.

    Remedy: correct the option that the message names.
    """


class DisagreementError(SerendipityError):
    """Two methods have proved different answers to one call, so a proof is wrong.

    Remedy: report it, with the task and the options that the message names.
    """


class LimitReachedError(SerendipityError):
    """The limit on time or memory came, or the caller cancelled, before there was an answer.

    Code that has an incumbent catches it and answers with that.

    Remedy: raise the limit.

    Args:
        reason: ``time-limit``, ``memory-limit`` or ``cancelled``, as in ``Result.reason``.
        doing: what was going on, for people: ``reading the task``.
    """

    def __init__(self, reason: str, doing: str | None = None) -> None:
        self.reason = reason
        self.doing = doing
        what = limit_words(reason)
        super().__init__(what if doing is None else f"{what}, {doing}")


LIMITS: Final = (LimitReachedError, MemoryError)
"""The exceptions to catch where an incumbent can be answered; :func:`limit_reason` says which it was."""


_WORDS: Final = {"time-limit": "the time limit came first", "memory-limit": "memory is used up"}


def limit_words(reason: str) -> str:
    """A limit's reason for people."""
    return _WORDS.get(reason, reason)


def limit_reason(error: LimitReachedError | MemoryError) -> str:
    """``Result.reason`` of an answer that a limit kept from being found."""
    return error.reason if isinstance(error, LimitReachedError) else "memory-limit"


_UNEXPECTED: Final = "unexpected "
REPORT: Final = "a fault of Serendipity; please report it, with the command, its files and what -vv adds"


def told(error: Exception) -> str:
    """An error in a line; one that nobody has foreseen is said to be so."""
    if isinstance(error, SerendipityError):
        return str(error)
    return " ".join(f"{_UNEXPECTED}{type(error).__name__}: {error}".split())


def is_unexpected(line: str | None) -> bool:
    """Whether :func:`told` has told an error that is a fault of the program."""
    return line is not None and line.startswith(_UNEXPECTED)


class InputError(SerendipityError):
    """A file can't be read or does not mean what it should.

    Remedy: mend the named file at the named line.

    Args:
        message: what was found and what was expected.
        file: the file, or None where the input has none.
        line: line number from 1, or None where no single line is at fault.
    """

    def __init__(self, message: str, file: object = None, line: int | None = None) -> None:
        self.message = message
        self.file = None if file is None else str(file)
        self.line = line
        place = "" if self.file is None else self.file
        if line is not None:
            place = f"{place}:{line}" if place else f"line {line}"
        super().__init__(f"{place}: {message}" if place else message)


class PlanError(InputError):
    """A given human plan is not applicable, misses the goal or is not theirs alone.

    Remedy: correct the action that the message names (docs/semantics.md section 1).

    Args:
        message: what was found and what was expected.
        file: the file, or None where the input has none.
        line: line number from 1, or None where no single line is at fault.
        step: the step of the plan that is at fault, from 1, or None.
    """

    def __init__(
        self, message: str, file: object = None, line: int | None = None, *, step: int | None = None
    ) -> None:
        super().__init__(message, file, line)
        self.step = step
