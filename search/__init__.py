"""Best-first search over interruption windows, with the human's replanning simulated.

Knows the model (``serendipity.model``) and nothing of ``verify``.  Every call takes a
:class:`PreparedTask`, which its caller makes, holds and moves.
"""

from importlib import import_module
from typing import Final

from search.call.prepared_task import PreparedTask, prepare
from search.human.plan_graph import PlanGraph
from search.modes.tie_bound import least_over_ties
from search.strategies.first_answer import (
    FirstAnswer,
    canonical_human_plan,
    first_answer,
    optimal_human_plans,
    optimal_plans_in_time,
)
from search.strategies.portfolio import solve
from search.strategies.warm_start import WarmStart

__all__ = [
    "FirstAnswer",
    "PlanGraph",
    "PreparedTask",
    "WarmStart",
    "canonical_human_plan",
    "first_answer",
    "least_over_ties",
    "optimal_human_plans",
    "optimal_plans_in_time",
    "preload",
    "prepare",
    "solve",
]

_LATER: Final = (
    "search.short_windows.independent.short_windows",
    "search.short_windows.joint.all_together",
    "search.classical.canonical",
    "search.classical.team",
    "search.kernel.signatures",
    "search.human.whole_actions",
)


def preload() -> None:
    """Load what calls load where they turn out to be long, before a clock starts: arrays, and the kernel."""
    for name in _LATER:
        import_module(name)
