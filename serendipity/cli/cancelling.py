"""Ctrl-C as a wish to have the best answer so far, where the work can give one."""

import signal
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from types import FrameType

from serendipity.cli.entry import SIGNALS


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
