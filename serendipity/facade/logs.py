"""Records of calls for the logger ``serendipity``: how each ended, and in how many seconds.

Nothing is recorded unless the program has loaded ``logging``, and nothing shown unless it has set that up.
"""

import sys
import time
from collections.abc import Callable
from functools import wraps
from typing import Any, ParamSpec, TypeVar

P = ParamSpec("P")
T = TypeVar("T")


def recorded(name: str, outcome: Callable[[Any], str]) -> Callable[[Callable[P, T]], Callable[P, T]]:
    """A decorator: each call is recorded as ``INFO``, with its outcome or its error.

    Args:
        name: of the call.
        outcome: in words, of what the call returns.
    """

    def around(function: Callable[P, T]) -> Callable[P, T]:
        @wraps(function)
        def told(*args: P.args, **more: P.kwargs) -> T:
            begun = time.perf_counter()
            try:
                found = function(*args, **more)
            except Exception as error:
                record("INFO", f"{name}: {type(error).__name__}", time.perf_counter() - begun)
                raise
            record("INFO", f"{name}: {outcome(found)}", time.perf_counter() - begun)
            return found

        return told

    return around


def record(level: str, words: str, seconds: float) -> None:
    """Record something that took some seconds."""
    if "logging" in sys.modules:  # it takes longer to load than many a plan to find
        import logging

        logging.getLogger("serendipity").log(getattr(logging, level), "%s in %.3f s", words, seconds)
