"""Ctrl-C and its like while commands work: an exception, or the wish for the best answer so far."""

import signal
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from types import FrameType
from typing import Final

from serendipity.cli.process.signals import SIGNALS

_MOMENT: Final = 0.05
"""Seconds until an interrupt that came at a bad time is tried again."""


def interrupt(number: int, frame: FrameType | None) -> None:
    """A signal handler: the command tidies up and ends.

    Not while a module is loaded: libraries take that for a module that is not there, and go on.
    """
    if _loading(frame):
        again = threading.Timer(_MOMENT, _send, (number,))
        again.daemon = True
        again.start()
        return
    raise KeyboardInterrupt


def _send(number: int) -> None:
    """Signal the main thread, which may be asleep."""
    main = threading.main_thread().ident
    if main is not None and hasattr(signal, "pthread_kill"):
        signal.pthread_kill(main, number)
    else:
        signal.raise_signal(number)


def _loading(frame: FrameType | None) -> bool:
    while frame is not None and "importlib._bootstrap" not in frame.f_code.co_filename:
        frame = frame.f_back
    return frame is not None


@contextmanager
def cancelling() -> Iterator[threading.Event]:
    """An event that the first signal to end sets; the next one interrupts as it does elsewhere."""
    cancelled = threading.Event()
    if threading.current_thread() is not threading.main_thread():  # which no signal reaches
        yield cancelled
        return
    former = {number: signal.getsignal(number) for number in SIGNALS}

    def restore() -> None:
        for number, handler in former.items():
            signal.signal(number, handler)

    def cancel(_number: int, _frame: FrameType | None) -> None:
        restore()
        cancelled.set()

    for number, handler in former.items():
        if callable(handler):  # neither ignored nor left to the system
            signal.signal(number, cancel)
    try:
        yield cancelled
    finally:
        restore()
