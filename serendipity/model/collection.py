"""Garbage collection, while much is made that stays."""

import gc
from collections.abc import Iterator
from contextlib import contextmanager


@contextmanager
def no_collection() -> Iterator[None]:
    """No garbage collection: for code that makes many objects and no cycles.

    The collector would look through all of them again and again, and find nothing; nor does
    it look at them once more at the end, where they join those that have been there for long.
    """
    enabled = gc.isenabled()
    gc.disable()
    try:
        yield
    finally:
        if enabled:
            if not gc.get_freeze_count():  # else it would thaw what the caller has frozen
                gc.freeze()
                gc.unfreeze()
            gc.enable()
