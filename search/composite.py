"""Composite planning where epochs don't count (Def. 1.1 with ``T = inf``), in the kernel.

The joint optimum does not depend on ``pi_H``: that is asked for afterwards, for the saving.
"""

from collections.abc import Iterator
from fractions import Fraction
from typing import TYPE_CHECKING, NamedTuple

from search.call.context import SearchContext
from search.packed.parallelise import schedule
from serendipity.model.answers.answer import Answer, Status, saved
from serendipity.model.errors import LIMITS, limit_reason
from serendipity.model.options import INFINITE
from serendipity.model.task.task import HumanPlan

if TYPE_CHECKING:  # loaded by the calls that it serves
    from search.classical.team import Sets, Team


def is_for_kernel(context: SearchContext) -> bool:
    """Whether a call is one that the kernel answers, where it can at all."""
    options = context.options
    endless = options.mode == "composite" and options.horizon == INFINITE
    return endless and options.max_cost is None and not context.task.robot_goal


def team_for(context: SearchContext, *, otherwise: bool = False) -> "Team | None":
    """The team's problem, where the kernel can answer the call; None where the general search has to.

    Args:
        context: of the call.
        otherwise: whether the general search would find it hard although goals are not shared.
    """
    if not is_for_kernel(context):
        return None
    return context.team if otherwise or context.distances_say_little else None


class Known(NamedTuple):
    """What another search leaves to go on with.

    Attributes:
        sets: sets of actions, one after another: the best plan that it has come by, if there is one.
        bound: key that no plan is below.
        expanded: nodes that it expanded.
        generated: successors that it looked at.
        is_old: it was about an earlier moment: what the human does alone is not known.
        is_best: no plan is better.
    """

    sets: "Sets | None"
    bound: int
    expanded: int = 0
    generated: int = 0
    is_old: bool = False
    is_best: bool = False


class CompositeCall:
    """One call without a horizon.

    Args:
        context: of the call.
        team: the team's problem.
        human_plan: ``pi_H`` as it is given, or None to predict it.
        known: what it goes on with.
    """

    def __init__(
        self, context: SearchContext, team: "Team", human_plan: HumanPlan | None, known: "Known | None" = None
    ) -> None:
        self._context = context
        self._team = team
        self._given = human_plan
        self._human_plan = human_plan
        self._alone: Fraction | None = None
        self._known = known or Known(None, 0)
        self._sets = self._known.sets
        self._bound = self._known.bound
        self._limit: str | None = None

    def answers(self) -> Iterator[Answer]:
        """Some plan first, then better ones, then what the best saves."""
        init, deadline = self._context.packed.init, self._context.deadline
        status: Status = "unknown" if self._sets is None else "feasible"
        try:
            if self._sets is not None:
                if self._known.is_old:
                    yield self._answer(status)
                else:
                    self._look_at_human()
            if not self._known.is_best:
                for sets in self._team.better_plans(init, deadline, self._raise):
                    if self._sets is None or self._rank(sets) < self._rank(self._sets):
                        status, self._sets = "feasible", sets
                        yield self._answer(status)
            status = "infeasible" if self._sets is None else "optimal"
            self._look_at_human()
        except LIMITS as limit:
            self._limit = limit_reason(limit)
        yield self._answer(status)

    def _raise(self, amount: int) -> None:
        self._bound = max(self._bound, self._context.amount_key(amount))

    def _rank(self, sets: "Sets") -> tuple[Fraction, int]:
        """What a plan costs the team, then how many actions it has."""
        chosen = [action for together in sets for action in together]
        return sum(map(self._context.team_cost, chosen), Fraction(0)), len(chosen)

    def _look_at_human(self) -> None:
        """``pi_H``, and what the human gains alone where it is given."""
        context = self._context
        optimal = context.canonical_plan()
        if optimal is not None:
            self._alone = context.task.cost_of(optimal.actions)
            if self._given is None:
                self._human_plan = optimal.actions

    def _answer(self, status: Status) -> Answer:
        keys, task = self._context.keys, self._context.task
        expanded, generated, _ = self._team.planner.counts()
        expanded, generated = expanded + self._known.expanded, generated + self._known.generated
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
        cost, _ = self._rank(self._sets)
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
