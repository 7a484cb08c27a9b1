"""A solver in a process of its own, which ends when the deadline does."""

import subprocess
from collections.abc import Sequence
from typing import IO, Any, Final

from serendipity.model import Deadline
from serendipity.model.resources.child import ended

_READING: Final = 0.03
"""Share of the time left that is kept for reading a solution back."""


def seconds_for(deadline: Deadline) -> float | None:
    """The time limit to give a solver now, or None: it keeps it roughly."""
    left = deadline.left()
    return None if left is None else left * (1 - _READING)


def run(
    command: Sequence[str],
    deadline: Deadline,
    *,
    stdin: IO[Any] | int = subprocess.DEVNULL,
    stdout: IO[Any] | int = subprocess.DEVNULL,
) -> int:
    """Run a command and return its exit status.

    Args:
        deadline: the process's memory counts, too.

    Raises:
        LimitReachedError: the deadline came first; the process has been killed.
    """
    process = subprocess.Popen(command, stdin=stdin, stdout=stdout, stderr=subprocess.DEVNULL)
    return ended(process, deadline)
