"""The human alone, over sets of facts: their costs and plans from any state or belief."""

from collections.abc import Sequence
from fractions import Fraction

from serendipity.model import HumanPlan, Task
from verify.base.due import onward
from verify.base.execution import State
from verify.base.optimal_plans import OptimalPlans


class ReplanningPerson:
    """What the human would do and pay alone; kept between questions about one task.

    Every method but :meth:`cost_of` raises :class:`verify.base.undecided.TooManyStatesError` where
    their own problem is too large, and :class:`serendipity.model.LimitReachedError` at the deadline.
    """

    def __init__(self, task: Task, plans: OptimalPlans, *, strict: bool = False) -> None:
        self._task = task
        self._strict = strict
        self._plans = plans
        self.deadline = plans.deadline

    def cost(self, state: State) -> Fraction | None:
        """``h``: the human's optimal cost alone; None for infinity."""
        worth = self._plans.worth(state)
        return None if worth is None else worth[0]

    def plan(self, state: State) -> HumanPlan:
        """The canonical optimal plan from a state that has one."""
        return next(self._plans.plans(state))

    def cost_of(self, plan: Sequence[int], state: State) -> Fraction | None:
        """``c``: what a plan costs if it works from a state, robots idle; None for infinity."""
        total = Fraction(0)
        for i in plan:
            after = onward(self._task, state, (i,), strict=self._strict)
            if after is None:
                return None
            state = after
            total += self._task.actions[i].cost
        return total if self._task.goal.holds(state) else None
