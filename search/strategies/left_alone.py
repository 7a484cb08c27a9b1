"""Doing nothing for the human, in a mode with windows."""

from dataclasses import dataclass
from fractions import Fraction

from search.call.context import SearchContext
from search.packed.cost_vector import INFINITE_KEY
from search.strategies.call import Call
from search.strategies.warm_start import WarmStart
from serendipity.model.task.task import HumanPlan


@dataclass(frozen=True, slots=True)
class LeftAlone:
    """What happens where nobody helps.

    Attributes:
        plan: ``pi_H``.
        horizon: ``T``.
        cost: what it costs the team, or None where robots can't reach their own goal meanwhile.
    """

    plan: HumanPlan
    horizon: int
    cost: Fraction | None


def left_alone(context: SearchContext, human_plan: HumanPlan | None) -> LeftAlone | None:
    """Doing nothing for the human; None where they have no plan alone.

    Args:
        context: of the call, in a mode with windows.
        human_plan: ``pi_H``, already replayed, or None to predict it.

    Raises:
        UsageError: the horizon is shorter than ``pi_H``, or one is missing.
        LimitReachedError: the deadline ran out.
    """
    optimal = context.canonical_plan() if human_plan is None else None
    plan = human_plan if optimal is None else optimal.actions
    if plan is None:
        return None
    call = Call(context, human_plan, WarmStart())
    call.follow(plan, optimal=human_plan is None)
    key = call.baseline.key
    return LeftAlone(plan, int(call.horizon), call.keys.cost(key) if key < INFINITE_KEY else None)
