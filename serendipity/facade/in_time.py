"""Calls about tasks in which actions take time, or the human waits: asked and answered in single epochs."""

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import replace
from fractions import Fraction
from functools import cached_property
from itertools import islice
from typing import Final

from search import PreparedTask, canonical_human_plan, optimal_plans_in_time
from search.modes.scenarios import Candidate
from serendipity.facade import ties
from serendipity.facade.call import Request, Solver
from serendipity.facade.rules import over_scenarios
from serendipity.model.answers.answer import Answer, ServedGoal
from serendipity.model.errors import LIMITS, UsageError, limit_reason
from serendipity.model.numbers import total
from serendipity.model.task.actions import Condition
from serendipity.model.task.horizon import common_horizon, horizon_of, require_few_epochs
from serendipity.model.task.plans import Step, TimedPlan
from serendipity.model.task.plans_in_time import outlasts
from serendipity.model.task.task import HumanPlan, Task
from serendipity.model.task.unit_steps import UnitSteps, unit_steps
from serendipity.model.task.whole_actions import whole_actions

_PLAIN: Final[dict[str, object]] = {
    "head_start": 0,
    "waiting_cost": 0,
    "suffix": "replan",
    "preservation": "kernel",
}
"""Options that have one value only, in time, where there are several scenarios."""


def answers_in_time(call: Request, solver: Solver) -> Iterator[Answer]:
    """Answers to such a call.

    Args:
        call: the call.
        solver: the one of its mode.

    Raises:
        PlanError: the human's plan can't be executed after the head start, or misses the goal.
        UsageError: the call asks for something that is not answered for such tasks.
    """
    _require_known(call)
    require_few_epochs(call.task)
    whole = whole_actions(call.task) if _is_alone(call) else None
    if whole is not None:
        yield from _alone(call, solver, whole)
        return
    try:
        units = unit_steps(call.task, call.deadline, call.options.waiting_cost)
        inner = in_units(call, units)
        plans = [] if call.given is not None else _tied(call, units)
    except LIMITS as limit:
        yield Answer("unknown", reason=limit_reason(limit))
        return
    if not inner.predicts and (call.options.windowed or call.options.mode in ("individual", "serendipity")):
        yield Answer("infeasible", reason="no-human-plan")
        return
    epochs = call.options.head_start if call.options.mode == "individual" else 0
    horizon = call.options.horizon
    answers = solver(inner) if not plans else iter((ties.beside_each(inner, plans, call.options.ties),))
    for number, answer in enumerate(answers):
        told = _told(units, _later(units, answer, epochs))
        if not number and told.human_plan is not None and horizon is not None:
            horizon_of(call.task, call.options, told.human_plan)  # which says whether what it reaches lasts
        yield told


class ScenariosInTime:
    """The scenarios of a call: found, and answered, in single epochs.

    Raises:
        LimitReachedError: the deadline came.
        UsageError: the task has too many epochs.
    """

    def __init__(self, call: Request) -> None:
        self._call = call

    @cached_property
    def _units(self) -> UnitSteps:
        require_few_epochs(self._call.task)
        return unit_steps(self._call.task, self._call.deadline)

    def optimal(self, goal: Condition) -> Iterator[HumanPlan]:
        """Their optimal plans to a goal that differ in names."""
        aimed = PreparedTask(self._units.task.with_goal(self._units.goal(goal)))
        found = optimal_plans_in_time(aimed, self._call.deadline, self._call.options)
        return map(self._units.begun, found)

    def answers(self, candidates: Sequence[Candidate]) -> Iterator[Answer]:
        """Answers over scenarios (semantics 11).

        Raises:
            LimitReachedError: the deadline came.
            UsageError: the call asks for something that is not answered in time, or a plan does not last.
        """
        task, options = self._call.task, self._call.options
        for name, value in _PLAIN.items():
            if getattr(options, name) != value:
                raise UsageError(f"{name}: in time, with several goals or plans, only {value!s} is possible")
        units = self._units
        inner = [replace(one, goal=units.goal(one.goal), plan=units.plan(one.plan)) for one in candidates]
        horizon = common_horizon(options, [one.plan for one in inner])
        for one in candidates:
            aimed = task.with_goal(one.goal)
            if broken := outlasts(aimed, one.plan, horizon, strict=options.strict):
                raise UsageError(f"plan '{one.name}' does not last until epoch {horizon}: {broken}")
        asked = self._call._replace(prepared=PreparedTask(units.task), original=task)
        for answer in over_scenarios(asked, inner):
            goals = tuple(_served(units, one, options.discount) for one in answer.goals or ())
            yield _told(units, answer)._replace(goals=goals)


def _served(units: UnitSteps, one: ServedGoal, discount: Fraction) -> ServedGoal:
    """What happens in a scenario, with the actions of the task itself, and the price of what it leaves."""
    plan, steps = one.human_plan, units.steps(one.steps or ())
    cost = _paid(units.original, steps, discount)
    if one.cost is not None:
        cost += one.cost - _paid(units.task, one.steps or (), discount)
    return replace(one, human_plan=None if plan is None else units.begun(plan), steps=steps, cost=cost)


def _paid(task: Task, steps: Iterable[Step], discount: Fraction) -> Fraction:
    """What the team pays for what is done."""
    return total(task.team_cost(task.actions[step.action], discount) for step in steps)


def _is_alone(call: Request) -> bool:
    """Whether it is asked what the human does, with nobody beside them and waiting free."""
    return call.options.mode == "individual" and call.given is None and not call.options.waiting_cost


def _alone(call: Request, solver: Solver, whole: Task) -> Iterator[Answer]:
    """Answers about the human alone, by a task in which each action is one step."""
    task, epochs = call.task, call.options.head_start
    options = call.options.but(head_start=0, horizon=None)
    for answer in solver(call._replace(prepared=PreparedTask(whole), options=options)):
        plan = answer.human_plan
        if plan is None:
            yield answer
            continue
        starts = [start + epochs for start in task.starts_of(plan)]
        if epochs:
            plan = TimedPlan(plan, starts, task.epochs_of(plan) + epochs)
        steps = None if answer.steps is None else tuple(map(Step, starts, plan))
        horizon = horizon_of(task, call.options, plan)
        yield answer._replace(human_plan=plan, steps=steps, horizon=horizon, realised={})


def in_units(call: Request, units: UnitSteps) -> Request:
    """The call in single epochs; where it does not predict the human, they have no plan alone.

    Args:
        call: the call.
        units: its task in single epochs.

    Raises:
        LimitReachedError: the deadline came.
        PlanError: the human's plan can't be executed after the head start, or misses the goal.
    """
    prepared, epochs = PreparedTask(units.task), call.options.head_start
    given = None if call.given is None else units.plan(call.given, epochs)
    asleep = 0 if call.options.human_model == "omniscient" else epochs
    options = call.options.but(head_start=asleep, ties="fixed")
    if given is not None:  # it may come too late, or be in a bystander's way
        call.task.replay_alone(units.begun(given), strict=options.strict)
    inner = call._replace(prepared=prepared, given=given, options=options, question=None, original=call.task)
    if not epochs:
        return inner
    state = units.waited(epochs, strict=options.strict)
    if state is None:
        return inner._replace(predicts=False)
    later = PreparedTask(units.task.at(state))
    if options.mode == "individual":
        return inner._replace(prepared=later, given=None if given is None else given[epochs:])
    found = canonical_human_plan(later, call.deadline, options)
    best = None if found is None else units.after_waiting(found, epochs)
    plan = best if given is None else given
    if plan is None:
        return inner._replace(predicts=False)
    return inner._replace(given=plan, optimum=None if best is None else units.task.cost_of(best))


def _tied(call: Request, units: UnitSteps) -> list[HumanPlan]:
    """The human's optimal plans in single epochs, where the answer is one over all of them.

    Raises:
        LimitReachedError: the deadline came.
        UsageError: there are more than ``max_ties``.
    """
    options, epochs = call.options, call.options.head_start
    if options.ties == "fixed" or options.mode not in ("serendipity", "communication"):
        return []
    state = units.waited(epochs, strict=options.strict)
    if state is None:
        return []
    later = PreparedTask(units.task.at(state))
    found = optimal_plans_in_time(later, call.deadline, options)
    plans = [units.after_waiting(plan, epochs) for plan in islice(found, options.max_ties + 1)]
    if len(plans) > options.max_ties:
        raise UsageError(f"max_ties: the human has more than {options.max_ties} optimal plans")
    return plans


def _require_known(call: Request) -> None:
    """Check that a call asks for nothing that is not answered in time."""
    options = call.options
    if options.mode == "assistance":
        raise UsageError("mode: 'assistance' takes turns, which have no length: not where actions take time")
    if call.visible is not None:
        raise UsageError("visible: is not known where actions take time")


def _later(units: UnitSteps, answer: Answer, epochs: int) -> Answer:
    """What is done alone after some epochs of waiting, with these."""
    plan, steps, horizon = answer.human_plan, answer.steps, answer.horizon
    if epochs and steps is not None and answer.cost is not None:
        waited = units.price_before(tuple(step.action for step in steps), epochs)
        answer = answer._replace(
            cost=answer.cost + waited,
            objective=(answer.objective or Fraction(0)) + waited,
            lower_bound=(answer.lower_bound or Fraction(0)) + waited,
        )
        if plan is not None and answer.baseline is not None:  # another plan, where it is given
            baseline = answer.baseline + units.price_before(plan, epochs)
            gain = None if answer.saving_alone is None else baseline - (answer.cost or Fraction(0))
            answer = answer._replace(baseline=baseline, saving_alone=gain)
    return answer._replace(
        human_plan=None if plan is None else units.after_waiting(plan, epochs),
        steps=None if steps is None else tuple(Step(step.epoch + epochs, step.action) for step in steps),
        horizon=horizon + epochs if isinstance(horizon, int) else horizon,
    )


def _told(units: UnitSteps, answer: Answer) -> Answer:
    """An answer with the actions of the task itself, each in the epoch in which it begins."""
    return answer._replace(
        human_plan=None if answer.human_plan is None else units.begun(answer.human_plan),
        steps=None if answer.steps is None else units.steps(answer.steps),
        ties=None if answer.ties is None else tuple(_told(units, one) for one in answer.ties),
        realised={},
    )
