"""What strategies stand on, and can do without: techniques of the kernel's A*, and bounds.

Answers stay what they are without any of them, but they take longer, and less is proved within a limit.
"""

from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager
from typing import Any, Final
from unittest.mock import patch

from search.bounds.achiever_costs import AchieverCosts
from search.bounds.first_interaction import FirstInteraction, no_team_bound
from search.bounds.prefix_bounds import FirstInteractionOnTheWay
from search.call.context import SearchContext
from search.classical.planner import ClassicalPlanner
from search.human.pattern_database import PatternDatabase
from search.kernel.library import library

KERNEL: Final = {
    "landmarks handed down": 1,
    "second LM-cut": 2,
    "third LM-cut": 4,
    "stubborn sets": 8,
    "lookahead": 16,
    "like fields": 32,
}
"""By name what the kernel's ``leave_out`` takes, see ``values.h``."""


def _nothing(*_: Any, **__: Any) -> int:
    return 0


def _no_team_bound(context: SearchContext, asked: Any = SearchContext.team_bound.func) -> Any:
    """The team's bound, which still tells by its presence that goals are shared."""
    return no_team_bound if asked(context) is no_team_bound else _nothing


BOUNDS: Final[dict[str, tuple[type, tuple[str, ...], Any]]] = {
    "private projection": (PatternDatabase, ("__call__",), _nothing),
    "achiever automata": (AchieverCosts, ("__call__",), _nothing),
    "first interaction": (FirstInteraction, ("__call__",), _nothing),
    "first interaction on the way": (FirstInteractionOnTheWay, ("opening_after", "later"), _nothing),
    "symbolic search": (ClassicalPlanner, ("_is_settled_symbolically",), _nothing),
    "LM-cut of the team": (SearchContext, ("team_bound",), property(_no_team_bound)),
}
"""By name the class that works a bound out, its methods, and what stands for them without it."""

NAMES: Final = (*KERNEL, *BOUNDS)


@contextmanager
def without(name: str) -> Iterator[None]:
    """Do without one of :data:`NAMES` meanwhile; without none where the name is none of them."""
    with ExitStack() as stack:
        if name in KERNEL:
            leave_out: Callable[[int], None] = library().leave_out  # type: ignore[union-attr]
            leave_out(KERNEL[name])
            stack.callback(leave_out, 0)
        elif name in BOUNDS:
            home, methods, instead = BOUNDS[name]
            for method in methods:
                stack.enter_context(patch.object(home, method, instead))
        yield
