"""Best-first search over interruption windows, with the human's replanning simulated.

Knows the model (``serendipity.model``) and nothing of ``verify``.  Every call takes a
:class:`PreparedTask`, which its caller makes, holds and moves.
"""

from search.human.plan_graph import PlanGraph
from search.planner import solve
from search.prediction import AtHand, at_hand, optimal_human_plans
from search.call.prepared_task import PreparedTask, prepare
from search.modes.tie_bound import least_over_ties
from search.strategies.warm_start import WarmStart

__all__ = [
    "AtHand",
    "PlanGraph",
    "PreparedTask",
    "WarmStart",
    "at_hand",
    "least_over_ties",
    "optimal_human_plans",
    "prepare",
    "solve",
]
