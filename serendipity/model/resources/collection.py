"""Garbage collection, while much is made that stays."""

import gc
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Final

_MANY: Final = 20_000
"""Objects that the collector looks through in about a millisecond."""

_IMMORTAL: Final = 2_000
"""More objects than CPython 3.12 freezes by itself: every collection there sets immortal ones apart."""


@contextmanager
def no_collection() -> Iterator[None]:
    """No garbage collection: for code that makes many objects and no cycles.

    The collector would look through all of them again and again, and find nothing; nor does
    it look at them once more at the end: if they are many, they join those that have been there for long.
    If they are not, they are looked at here, and nothing else is: it may be time to look at everything that
    was ever made, which takes longer than a short deadline, and somebody waits for an answer.
    """
    enabled = gc.isenabled()
    gc.disable()
    try:
        yield
    finally:
        if enabled:
            # Not where a caller has frozen something, which would thaw.
            young = gc.get_count()[0]
            if young > _MANY and gc.get_freeze_count() <= _IMMORTAL:
                gc.freeze()
                gc.unfreeze()
            elif young > gc.get_threshold()[0]:
                gc.collect(1)
            gc.enable()
