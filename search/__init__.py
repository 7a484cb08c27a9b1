"""Best-first search over interruption windows, with the human's replanning simulated.

Knows the model (``serendipity.model``) and nothing of ``verify``.
"""

from search.cache_transfer import at_state
from search.engine.outcome import Outcome
from search.human.individual_planner import PlanGraph
from search.planner import optimal_human_plan, optimal_human_plans, solve
from search.prepare import prepare
from search.tie_bound import least_over_ties

__all__ = [
    "Outcome",
    "PlanGraph",
    "at_state",
    "least_over_ties",
    "optimal_human_plan",
    "optimal_human_plans",
    "prepare",
    "solve",
]
