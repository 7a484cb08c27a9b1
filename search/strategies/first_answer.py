"""Doing nothing beside a plan of the human alone: the first answer, and all that individual mode asks for."""

from collections.abc import Iterator
from contextlib import suppress
from fractions import Fraction
from typing import Final

from search.call.context import SearchContext
from search.call.prepared_task import PreparedTask
from search.engine.paths import plan_steps
from search.human.individual_planner import FoundPlan
from search.human.plan_graph import PlanGraph
from search.strategies.warm_start import WarmStart, warm_plan
from serendipity.model.answers.answer import Answer
from serendipity.model.errors import LIMITS
from serendipity.model.options import INFINITE, Options
from serendipity.model.resources.deadline import Deadline
from serendipity.model.task.horizon import horizon_of
from serendipity.model.task.script import UNDER_WAY
from serendipity.model.task.task import HumanPlan, Task
from serendipity.model.task.unit_steps import RESTING

_FIRST_BOUND: Final = 0.1
"""The share of the time that is left for what the team pays at least, beside a human who replans."""


def optimal_human_plans(prepared: PreparedTask, deadline: Deadline | None = None) -> PlanGraph | None:
    """All optimal plans of the human alone, or None where they have none."""
    context = SearchContext(prepared, Options(), deadline or Deadline())
    return context.alone.plans(context.packed.init)


def optimal_plans_in_time(
    prepared: PreparedTask, deadline: Deadline, options: Options
) -> Iterator[HumanPlan]:
    """The human's optimal plans, in single epochs, that differ in the names of what they begin."""
    context = SearchContext(prepared, options, deadline)
    graph, packed = context.alone.plans(context.packed.init), context.packed

    def name(action: int) -> str:
        return packed.task.actions[action].name if packed.counted(action) else ""

    return iter(()) if graph is None else graph.distinct(name)


def canonical_human_plan(prepared: PreparedTask, deadline: Deadline, options: Options) -> HumanPlan | None:
    """The canonical plan of the human alone (semantics 1), or None where they have none."""
    optimal = SearchContext(prepared, options, deadline).canonical_plan()
    return None if optimal is None else optimal.actions


class FirstAnswer:
    """Doing nothing beside some plan of the human's that is found soon, where an optimal one may take long.

    Args:
        given: ``pi_H``, already replayed, or None to predict it.

    Attributes:
        plan: some plan of theirs; None where an optimal one is found soon, or one is given.
        least: what no answer costs less than, as far as that was asked for.

    Raises:
        LimitReachedError: the deadline came before any plan.
    """

    def __init__(
        self, context: SearchContext, given: HumanPlan | None, warm: WarmStart | None = None
    ) -> None:
        self._context = context
        self._given = given
        self.plan: HumanPlan | None = None
        self.least = Fraction(0)
        warm = warm or WarmStart()
        if context.options.mode == "individual":
            known = warm_plan(context, warm)
            if known is not None and warm.is_best and context.task.cost_of(known) == warm.bound:
                context.alone.proved(context.packed.init, known)
            plans = [plan for plan in (known, given) if plan is not None]
            self.plan = min(plans, key=context.task.cost_of, default=None)
        elif given is None and context.distances_say_little:
            self.plan = warm_plan(context, warm)
        if self.plan is None and given is None and context.distances_say_little:
            self.plan = context.alone.first_plan(context.packed.init)

    def answers(self) -> Iterator[Answer]:
        """The answer, where nothing speaks against it; once more with a bound, if one is found soon."""
        answer = self.beside(self.plan)
        if answer is None:
            return
        yield answer
        self._bound()
        if self.least:
            yield answer._replace(lower_bound=self.least)

    def last(self, limit: str | None) -> Answer:
        """The answer so far, at a limit beside the best plan that was come across; ``unknown`` without one.

        Args:
            limit: the reason why it is the last one; None where others may follow.
        """
        answer = self.beside(self.plan if limit is None else self.best)
        return Answer("unknown", reason=limit) if answer is None else answer

    def alone(self, limit: str | None) -> Answer:
        """The answer of individual mode while no plan is known to be optimal; see :meth:`last`."""
        context, plan = self._context, self.plan
        if plan is None:
            return Answer("unknown", reason=limit)
        least = _least(context)
        found = FoundPlan(plan, 0, 0) if limit is None else _cheaper(context, plan)
        proved = limit is not None and least >= context.task.cost_of(found.actions)
        return plan_alone(context.task, found, least, given=self._given, proved=proved)

    @property
    def best(self) -> HumanPlan | None:
        """The best plan that was come across and fits; None without one."""
        plans = () if self.plan is None else (_cheaper(self._context, self.plan).actions, self.plan)
        return next((plan for plan in plans if _fits(self._context.options, plan)), None)

    def beside(self, plan: HumanPlan | None) -> Answer | None:
        """Doing nothing beside a plan, if any; None where robots have a goal or ``T`` is too short, too."""
        context = self._context
        if plan is None or context.task.robot_goal or not _fits(context.options, plan):
            return None
        horizon = horizon_of(context.task, context.options, plan)
        return plan_alone(context.task, FoundPlan(plan, 0, 0), self.least)._replace(horizon=horizon)

    def _bound(self) -> None:
        """What the team pays where epochs don't count, in tables that are free on return.

        Nothing may hold them in a circle: in a call nobody collects those.
        """
        call = self._context
        with suppress(*LIMITS):
            context = SearchContext(call.prepared, call.options, call.deadline.part(_FIRST_BOUND))
            if context.team is not None:
                amount = context.team.planner.bound(context.packed.init, context.deadline)
                self.least = max(self.least, context.keys.objective(context.weights.key_of(amount)))


def _fits(options: Options, plan: HumanPlan) -> bool:
    """Whether ``T`` is not too short for a plan."""
    horizon = options.horizon
    return horizon is None or horizon == INFINITE or len(plan) <= int(horizon)


def first_answer(prepared: PreparedTask, options: Options, deadline: Deadline) -> FirstAnswer:
    """The first answer where ``pi_H`` is to be predicted; :class:`LimitReachedError` where no plan came."""
    return FirstAnswer(SearchContext(prepared, options, deadline), None)


def _cheaper(context: SearchContext, plan: HumanPlan) -> FoundPlan:
    """The best plan that the human's searches came across, where one was interrupted; or else this one."""
    best = None
    with suppress(*LIMITS):  # the limit may have come before the human's searches were prepared
        best = context.alone.best_plan(context.packed.init)
    if best is None:
        return FoundPlan(plan, 0, 0)
    cheaper = context.task.cost_of(best.actions) < context.task.cost_of(plan)
    return best if cheaper else best._replace(actions=plan)


def _least(context: SearchContext) -> Fraction:
    """No plan of the human's alone costs less; 0 where not even a bound fits into memory."""
    try:
        return context.keys.objective(context.alone.least(context.packed.init))
    except LIMITS:
        return Fraction(0)


def plan_alone(
    task: Task, found: FoundPlan, least: Fraction, *, given: HumanPlan | None = None, proved: bool = False
) -> Answer:
    """A plan of the human's with every robot idle.

    Args:
        found: the plan, with what was searched for it.
        least: no answer costs less.
        given: ``pi_H``; None for the plan itself.
        proved: whether the plan is known to be optimal.
    """
    plan = found.actions
    human_plan = plan if given is None else given
    cost, baseline = task.cost_of(plan), task.cost_of(human_plan)
    return Answer(
        "optimal" if proved else "feasible",
        human_plan=human_plan,
        horizon=max(len(human_plan), len(plan)),
        steps=plan_steps(plan),
        cost=cost,
        objective=cost,
        lower_bound=min(least, cost),
        baseline=baseline,
        saving=Fraction(0),
        saving_alone=baseline - cost if proved else None,
        expanded=found.expanded,
        generated=found.generated,
    )


def optimal_plan_alone(task: Task, given: HumanPlan | None, optimal: FoundPlan | None) -> Answer:
    """The answer of individual mode: the human's canonical plan, or the given one where it costs no more.

    Args:
        given: ``pi_H``, where it is given.
        optimal: the human's canonical plan; None where they have none.
    """
    if optimal is None:
        return Answer("infeasible", reason="no-human-plan")
    cost = task.cost_of(optimal.actions)
    if given is not None and task.cost_of(given) == cost and not _only_rests(task, optimal.actions):
        optimal = optimal._replace(actions=given)
    return plan_alone(task, optimal, cost, given=given, proved=True)


def _only_rests(task: Task, plan: HumanPlan) -> bool:
    """Whether the human begins nothing where waiting costs: who begins something pays for a head start."""
    return bool(plan) and all(task.actions[i].name.startswith((RESTING, UNDER_WAY)) for i in plan)
