"""``pi_H`` as it is predicted: the canonical optimal plan, or soon some plan where that takes too long."""

from collections.abc import Iterator
from fractions import Fraction
from typing import Final, NamedTuple

from search.context import SearchContext
from search.engine.paths import plan_steps
from search.human.individual_planner import FoundPlan
from search.human.plan_graph import PlanGraph
from search.prepared_task import PreparedTask
from serendipity.model.answers.answer import Answer
from serendipity.model.errors import LIMITS, LimitReachedError, limit_reason
from serendipity.model.options import INFINITE, Options
from serendipity.model.resources.deadline import Deadline
from serendipity.model.task.horizon import horizon_of
from serendipity.model.task.task import HumanPlan

_SHARE: Final = 0.4
"""What of the time that is left the optimal plan may take, where other plans are at hand."""


class Prediction(NamedTuple):
    """A plan of the human's.

    Attributes:
        actions: its actions.
        optimal: whether it is proved to cost least; unless a limit came it is the canonical one then.
    """

    actions: HumanPlan
    optimal: bool


def optimal_human_plans(prepared: PreparedTask, deadline: Deadline | None = None) -> PlanGraph | None:
    """All optimal plans of the human alone, or None where they have none.

    Raises:
        LimitReachedError: the deadline ran out.
    """
    return SearchContext(prepared, Options(), deadline or Deadline()).optimal_plans()


def canonical_human_plan(prepared: PreparedTask, deadline: Deadline) -> HumanPlan | None:
    """The canonical plan of the human alone (semantics 1), or None where they have none.

    Raises:
        LimitReachedError: the deadline ran out.
    """
    optimal = SearchContext(prepared, Options(), deadline).canonical_plan()
    return None if optimal is None else optimal.actions


def plan_at_hand(context: SearchContext, given: HumanPlan | None) -> HumanPlan | None:
    """Some plan of the human's where an optimal one may take long and is asked for; None elsewhere.

    Args:
        context: of the call.
        given: ``pi_H``, already replayed, or None to predict it.

    Raises:
        LimitReachedError: the deadline came before any plan.
    """
    if given is not None or not context.distances_say_little:
        return None
    return context.alone.first_plan(context.packed.init)


def answers_at_once(context: SearchContext, at_hand: HumanPlan | None) -> Iterator[Answer]:
    """Doing nothing beside a plan that is at hand, where nothing speaks against it; no bound is known yet.

    Args:
        context: of the call.
        at_hand: what :func:`plan_at_hand` found.
    """
    horizon = context.options.horizon
    if at_hand is None or context.task.robot_goal:
        return
    if horizon is None or horizon == INFINITE or len(at_hand) <= int(horizon):
        answer = _some(context, FoundPlan(at_hand, 0, 0), proved=False)
        horizon = horizon_of(context.task, context.options, at_hand)
        yield answer._replace(horizon=horizon, lower_bound=Fraction(0))


def expected_plan(
    context: SearchContext, given: HumanPlan | None, at_hand: HumanPlan | None
) -> Prediction | None:
    """``pi_H``: the given plan, else the canonical one, or another where the deadline is near; None if none.

    Args:
        context: of the call.
        given: ``pi_H``, already replayed, or None to predict it.
        at_hand: what :func:`plan_at_hand` found.

    Raises:
        LimitReachedError: the deadline came before any plan.
    """
    if given is not None:
        return Prediction(given, optimal=False)
    if at_hand is None:
        optimal = context.canonical_plan()
        return None if optimal is None else Prediction(optimal.actions, optimal=True)
    try:
        optimal = context.under(context.deadline.part(_SHARE)).canonical_plan()
    except LimitReachedError:
        context.deadline.check()
        best = _cheaper(context, at_hand).actions
        return Prediction(best, optimal=context.task.cost_of(best) <= _least(context))
    assert optimal is not None, "there is a plan"
    return Prediction(optimal.actions, optimal=True)


def individual_answers(context: SearchContext, human_plan: HumanPlan | None) -> Iterator[Answer]:
    """The human alone, whatever plan of theirs is given: some plan soon, and then an optimal one.

    Args:
        context: of the call.
        human_plan: ``pi_H``, already replayed, or None to predict it.
    """
    known: Answer | None = None
    try:
        first = plan_at_hand(context, human_plan) if human_plan is None else human_plan
        if first is not None:
            known = _some(context, FoundPlan(first, 0, 0), proved=False)
            yield known
        yield _optimal(context, human_plan)
    except LIMITS as limit:
        reason = limit_reason(limit)
        if known is None:
            yield Answer("unknown", reason=reason)
        else:
            plan = _cheaper(context, known.human_plan or (), given=human_plan is not None)
            yield _some(context, plan, proved=_least(context) >= context.task.cost_of(plan.actions))


def _cheaper(context: SearchContext, plan: HumanPlan, *, given: bool = False) -> FoundPlan:
    """The best plan that the human's searches came across, where one was interrupted; or else this one."""
    best = context.alone.best_plan(context.packed.init)
    if best is None:
        return FoundPlan(plan, 0, 0)
    cheaper = not given and context.task.cost_of(best.actions) < context.task.cost_of(plan)
    return best if cheaper else best._replace(actions=plan)


def _some(context: SearchContext, found: FoundPlan, *, proved: bool) -> Answer:
    plan = found.actions
    cost, bound = context.task.cost_of(plan), _least(context)
    return Answer(
        "optimal" if proved else "feasible",
        human_plan=plan,
        horizon=len(plan),
        steps=plan_steps(plan),
        cost=cost,
        objective=cost,
        lower_bound=min(bound, cost),
        baseline=cost,
        saving=Fraction(0),
        saving_alone=Fraction(0) if proved else None,
        expanded=found.expanded,
        generated=found.generated,
    )


def _least(context: SearchContext) -> Fraction:
    """No plan of the human's alone costs less."""
    return context.keys.objective(context.alone.least(context.packed.init))


def _optimal(context: SearchContext, human_plan: HumanPlan | None) -> Answer:
    optimal = context.canonical_plan()
    if optimal is None:
        return Answer("infeasible", reason="no-human-plan")
    best = optimal.actions
    plan = best if human_plan is None else human_plan
    cost, given = context.task.cost_of(best), context.task.cost_of(plan)
    answer = plan if cost == given else best
    return Answer(
        "optimal",
        human_plan=plan,
        horizon=max(len(plan), len(answer)),
        steps=plan_steps(answer),
        cost=cost,
        objective=cost,
        lower_bound=cost,
        baseline=given,
        saving=Fraction(0),
        saving_alone=given - cost,
        expanded=optimal.expanded,
        generated=optimal.generated,
    )
