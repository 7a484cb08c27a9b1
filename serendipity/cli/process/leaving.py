"""The end of the process: nothing is taken down that the system takes down at once."""

import os
import sys
from contextlib import suppress
from typing import NoReturn


def leave(code: int) -> NoReturn:
    """End the process with all that was written, and without giving memory back piece by piece.

    Beside a large task that would take seconds.  Commands have closed their files and ended
    their workers when they return.
    """
    for stream in (sys.stdout, sys.stderr):
        if stream is not None:
            with suppress(OSError, ValueError):  # closed, or nobody reads any more: it was told before
                stream.flush()
    os._exit(code)
