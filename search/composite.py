"""Composite planning where epochs don't count (Def. 1.1 with ``T = inf``), in the kernel.

The joint optimum does not depend on ``pi_H``: that is asked for afterwards, for the saving.
"""

from collections.abc import Iterator
from fractions import Fraction
from typing import TYPE_CHECKING

from search.context import SearchContext
from search.packed.parallelise import schedule
from serendipity.model.answers.answer import Answer, saved
from serendipity.model.errors import LIMITS, limit_reason
from serendipity.model.options import INFINITE
from serendipity.model.task.task import HumanPlan

if TYPE_CHECKING:  # loaded by the calls that it serves
    from search.classical.team import Team


def team_for(context: SearchContext, *, alone: bool = True) -> "Team | None":
    """The team's problem, where the kernel can answer the call; None where the general search has to.

    Args:
        context: of the call.
        alone: whether the human may have a plan without others.
    """
    options, task = context.options, context.task
    endless = options.horizon == INFINITE
    if options.mode != "composite" or not endless or options.max_cost is not None or task.robot_goal:
        return None
    return context.team if context.distances_say_little or not alone else None


class CompositeCall:
    """One call without a horizon.

    Args:
        context: of the call.
        team: the team's problem.
        human_plan: ``pi_H`` as it is given, or None to predict it.
    """

    def __init__(self, context: SearchContext, team: "Team", human_plan: HumanPlan | None) -> None:
        self._context = context
        self._team = team
        self._given = human_plan
        self._human_plan = human_plan
        self._alone: Fraction | None = None
        self._sets: list[tuple[int, ...]] | None = None
        self._bound = 0
        self._limit: str | None = None

    def answers(self) -> Iterator[Answer]:
        """Some plan first, then better ones, then what the best saves."""
        init, deadline = self._context.packed.init, self._context.deadline
        status = "unknown"
        try:
            for sets in self._team.better_plans(init, deadline, self._raise):
                status, self._sets = "feasible", sets
                yield self._answer(status)
            status = "infeasible" if self._sets is None else "optimal"
            self._look_at_human()
        except LIMITS as limit:
            self._limit = limit_reason(limit)
        yield self._answer(status)

    def _raise(self, amount: int) -> None:
        self._bound = max(self._bound, self._context.amount_key(amount))

    def _look_at_human(self) -> None:
        """``pi_H``, and what the human gains alone where it is given."""
        context = self._context
        optimal = context.canonical_plan()
        if optimal is not None:
            self._alone = context.task.cost_of(optimal.actions)
            if self._given is None:
                self._human_plan = optimal.actions

    def _answer(self, status: str) -> Answer:
        context, keys, task = self._context, self._context.keys, self._context.task
        expanded, generated, _ = self._team.planner.counts()
        if self._sets is None:
            return Answer(
                status,
                human_plan=self._human_plan,
                horizon=INFINITE,
                reason="no-plan" if status == "infeasible" else self._limit,
                expanded=expanded,
                generated=generated,
            )
        steps = schedule(task, self._sets)
        cost = sum((context.team_cost(i) for chosen in self._sets for i in chosen), Fraction(0))
        baseline = None if self._human_plan is None else task.cost_of(self._human_plan)
        helps = self._alone is not None and cost < self._alone
        bound = min(keys.objective(self._bound), cost) if status == "feasible" else cost
        if self._given is not None and self._alone is None:
            status = "feasible"  # whether it is an opportunity is not known
        assert status != "optimal" or self._alone is None or cost <= self._alone, "robots need not act"
        return Answer(
            status,
            human_plan=self._human_plan,
            horizon=INFINITE,
            steps=steps,
            cost=cost,
            objective=cost,
            lower_bound=bound,
            baseline=baseline,
            saving=saved(baseline, cost, opportunity=helps),
            saving_alone=None if baseline is None or self._alone is None else baseline - self._alone,
            opportunity=helps,
            expanded=expanded,
            generated=generated,
        )
