"""A process of ours that ends when a deadline does.

Search and verifier share this: it says nothing of what a process works out.
"""

import subprocess
from collections.abc import Callable
from typing import Any, Final

from serendipity.model.resources.deadline import Deadline

_LOOK: Final = 0.02
"""Seconds between two looks at the deadline."""


def ended(
    process: "subprocess.Popen[Any]", deadline: Deadline, on_look: Callable[[], None] = lambda: None
) -> int:
    """Wait for a process; its exit status.

    Args:
        deadline: the process's memory counts, too.
        on_look: called at each look at the deadline.

    Raises:
        LimitReachedError: the deadline came first; the process has been killed.
    """
    try:
        while True:
            try:
                return process.wait(_LOOK)
            except subprocess.TimeoutExpired:
                deadline.check_child(process.pid)
                on_look()
    finally:
        if process.poll() is None:
            process.kill()
            process.wait()
