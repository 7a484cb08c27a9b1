"""A solver in a process of its own, which ends when the deadline does."""

import subprocess
from collections.abc import Sequence
from typing import IO, Any, Final

from serendipity.model import Deadline

_LOOK: Final = 0.02
"""Seconds between two looks at the deadline."""

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
    try:
        while True:
            try:
                return process.wait(_LOOK)
            except subprocess.TimeoutExpired:
                deadline.check_child(process.pid)
    finally:
        if process.poll() is None:
            process.kill()
            process.wait()
