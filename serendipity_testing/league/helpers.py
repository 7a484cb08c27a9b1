"""Helpers by name: those that are shipped, functions, programs, addresses, learners."""

from collections.abc import Callable
from math import inf
from typing import Final
from urllib.parse import urlsplit

from serendipity.model import UsageError
from serendipity.model.options import limit_of
from serendipity_testing.judges.named import function_named
from serendipity_testing.league import baselines
from serendipity_testing.league.channels import Endpoint, Process, Timely
from serendipity_testing.league.protocol import Ask, AskedRobots, Helper

SHIPPED: Final = ("idle", "random", "greedy", "ours:0.01", "ours:0.1", "ours:1", "ours-fixed", "ours-policy")
"""Those that play where none is named."""

_KINDS: Final = "command:LINE, http://..., python:MODULE:FUNCTION, pettingzoo:MODULE:FUNCTION"


def helper_named(text: str) -> Helper:
    """A helper by its name, or a UsageError."""
    kind, _, rest = text.partition(":")
    simple: dict[str, Ask] = {
        "idle": baselines.idle,
        "random": baselines.random,
        "greedy": baselines.Greedy(),
    }
    if text in simple:
        return Helper(text, lambda case, _: AskedRobots(case, simple[text]))
    if text in ("ours-fixed", "ours-policy"):
        return Helper(text, baselines.Planned("fixed" if text == "ours-fixed" else "watching").robots)
    if kind == "ours":
        seconds = limit_of("helper ours", rest, "seconds") if rest else None
        if seconds == inf:
            raise UsageError("helper ours: expected seconds, got inf")
        return Helper(text, lambda case, _: baselines.ours(case), seconds=seconds, plans=True)
    if kind == "command" and rest:
        process = Process(rest)
        return by_function(process, text, process.close)
    if kind in ("http", "https") and _has_host(text):
        return by_function(Endpoint(text), text)
    if kind == "python" and rest:
        return by_function(function_named(rest, "helper"), text)
    if kind == "pettingzoo" and rest:
        from serendipity_testing.league.environment import Learner

        learner = Learner(function_named(rest, "helper"))
        return Helper(text, learner.robots, learner.close)
    raise UsageError(f"helper: expected {', '.join(SHIPPED)}, {_KINDS}, got '{text:.50}'")


def _has_host(address: str) -> bool:
    try:
        return bool(urlsplit(address).hostname)
    except ValueError:
        return False


def by_function(ask: Ask, name: str = "", end: Callable[[], None] = lambda: None) -> Helper:
    """A function of an observation as a helper, asked in a thread of its own.

    Args:
        name: by default the function's own.
        end: called when nobody asks any more.
    """
    timely = Timely(ask, end)
    called = name or getattr(ask, "__name__", type(ask).__name__)
    return Helper(called, lambda case, setup: AskedRobots(case, timely, setup), timely.close)
