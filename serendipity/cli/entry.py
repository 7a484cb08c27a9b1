"""The process: what has to be settled before anything that takes long is loaded.

Signals and closed streams are looked after from the first moment on, so nothing is imported here
but what Python has loaded anyway, or nearly so.
"""

import gc
import os
import signal
import sys

from serendipity.cli.process.signals import SIGNALS

INTERRUPTED = 130
"""``ExitCode.INTERRUPTED``, which is not loaded yet."""

WRONG_INPUT = 2
"""``ExitCode.WRONG_INPUT``."""

_OBJECTS = 50_000
"""Objects that are made between two garbage collections: loading makes many, and hardly any garbage."""


def run() -> None:
    """The command ``serendipity``: run the command line of this process and exit."""
    _on_signals(_leave)
    _fill_closed_streams()
    gc.set_threshold(_OBJECTS)
    _refuse_strangers()
    from serendipity.cli.app import main
    from serendipity.cli.process.interrupts import interrupt

    _on_signals(interrupt)
    code = main()
    _on_signals(signal.SIG_DFL)  # all is said and done
    _end(code)


def _refuse_strangers() -> None:
    """End where others have put files among ours: what is imported below may be theirs."""
    from serendipity._siblings import require_siblings

    try:
        require_siblings("search", "verify")
    except ImportError as error:
        os.write(2, f"Error: {error}\n".encode(errors="backslashreplace"))
        os._exit(WRONG_INPUT)


def _fill_closed_streams() -> None:
    """Point descriptors that nobody opened to nowhere, or the next files opened would get their numbers."""
    for descriptor in range(3):
        try:
            os.fstat(descriptor)
        except OSError:
            os.open(os.devnull, os.O_RDWR)


def _on_signals(handler: "signal._HANDLER") -> None:
    for number in SIGNALS:
        if signal.getsignal(number) is not signal.SIG_IGN:  # as `nohup` and shells' background jobs ask for
            signal.signal(number, handler)


def _leave(_number: int, _frame: object) -> None:
    """Before the work has begun."""
    try:
        os.write(2, b"Interrupted.\n")
    finally:
        os._exit(INTERRUPTED)


def _end(code: int) -> None:
    """End the process with all that was written, and without giving memory back piece by piece.

    Beside a large task that would take seconds.  Commands have closed their files and ended
    their workers when they return.
    """
    for stream in (sys.stdout, sys.stderr):
        try:
            stream.flush()
        except (AttributeError, OSError, ValueError):  # none, closed, or nobody reads: it was told before
            continue
    os._exit(code)
