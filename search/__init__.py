"""Best-first search over interruption windows, with the human's replanning simulated.

Knows the model (``serendipity.model``) and nothing of ``verify``.  Every call takes a
:class:`PreparedTask`, which its caller makes, holds and moves.
"""

from search.human.plan_graph import PlanGraph
from search.prepared_task import PreparedTask, prepare
from search.strategies.first_answer import FirstAnswer, first_answer, optimal_human_plans
from search.strategies.portfolio import solve
from search.tie_bound import least_over_ties
from search.warm_start import WarmStart

__all__ = [
    "FirstAnswer",
    "PlanGraph",
    "PreparedTask",
    "WarmStart",
    "first_answer",
    "least_over_ties",
    "optimal_human_plans",
    "prepare",
    "solve",
]
