"""The facade over the search: options in, results out, incumbents on the way."""

import threading
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, fields, replace
from fractions import Fraction
from functools import partial
from typing import TYPE_CHECKING, Any, Final

from search import Outcome, PreparedTask, least_over_ties, optimal_human_plans, solve
from search.simulation import solve_for_human
from serendipity.facade.gap import Gap, news
from serendipity.facade.prepared import HELD
from serendipity.facade.simulation import realised
from serendipity.facade.ties import Answered, combined, until_settled
from serendipity.model.actions import GroundAction
from serendipity.model.collection import no_collection
from serendipity.model.deadline import Deadline
from serendipity.model.errors import LIMITS, UsageError, limit_reason
from serendipity.model.limits import limits_from
from serendipity.model.numbers import Number
from serendipity.model.options import Options
from serendipity.model.plans import Step
from serendipity.model.result import PlanStep, Result
from serendipity.model.task import HumanPlan, Task
from serendipity.model.visibility import Visible

if TYPE_CHECKING:
    from serendipity.recognition import GoalsGiven, ObservedGiven

_ANSWER_SHARE: Final = 0.05
"""What of the time limit is kept for the end: dropping what the search has made takes time, too."""

_VERDICT_SHARE: Final = 0.02
"""What the verdict on humans who replan may add to the time limit: a share of it."""

Given = Callable[[], HumanPlan] | None
"""What the human is going to do, replayed when it is asked for; None to predict it."""


def plan(
    task: Task,
    *,
    human_plan: Iterable[str] | None = None,
    visible: Visible | None = None,
    cancelled: threading.Event | None = None,
    deadline: Deadline | None = None,
    goals: "GoalsGiven | None" = None,
    observed: "ObservedGiven" = (),
    beta: Number = 1,
    **options: Any,
) -> Result:
    """The best plan in which robots help the human, with a proof that none is better.

    Args:
        task: the task.
        human_plan: names of the actions that the human is going to do; None predicts
            an optimal plan of theirs (semantics 1).
        visible: ``visible(agent, fact, state)`` says, by ids of the task, what a human of
            ``human_model="local"`` sees; None for what is where they are.
        cancelled: set from another thread, it ends the call like a time limit.
        deadline: one that other work shares, such as loading the task; it holds beside
            ``time_limit`` and ``memory_limit``, which are of this call alone.
        goals: goals that the human may have, instead of the task's, as :func:`recognise` takes
            them: the least expected cost over their posterior is wanted (semantics 8).
        observed: what they have done from the initial state on, for the posterior.
        beta: of the posterior.
        **options: fields of :class:`serendipity.model.Options`, ``mode="serendipity"``,
            ``discount=0.6``, ``time_limit=0.1`` (seconds) and so on.

    Raises:
        UsageError: an option is unknown or has no legal value.
        PlanError: ``human_plan`` can't be executed, or misses the goal.
        InputError: ``goals`` or ``observed`` are wrong; it says where.
    """
    return planned(
        HELD.of(task),
        _given(task, human_plan),
        visible=visible,
        cancelled=cancelled,
        deadline=deadline,
        goals=goals,
        observed=observed,
        beta=beta,
        **options,
    )


def planned(
    prepared: PreparedTask,
    given: Given,
    *,
    visible: Visible | None = None,
    cancelled: threading.Event | None = None,
    deadline: Deadline | None = None,
    goals: "GoalsGiven | None" = None,
    observed: "ObservedGiven" = (),
    beta: Number = 1,
    **options: Any,
) -> Result:
    """:func:`plan` for those who hold a prepared task."""
    if goals is not None:
        if given is not None:
            raise UsageError("human_plan: with goals, the human's plans are predicted; give observed instead")
        # Loaded only here, before time counts: calls with a known goal do not need it.
        from serendipity.facade.unknown_goals import plan_for_goals

        chosen = options_from(options)
        limits = limits_from(chosen.time_limit, chosen.memory_limit, deadline, cancelled)

        def known(about: PreparedTask, names: tuple[str, ...] | None) -> Result:
            return planned(about, _given(about.task, names), visible=visible, deadline=limits, **options)

        with no_collection():
            early = limits.sooner(_ANSWER_SHARE)
            return plan_for_goals(prepared, goals, observed, beta, chosen, known, early)
    with no_collection():  # beside a large task a collection takes longer than a short deadline
        *_, last = _answers(prepared, given, visible, options, cancelled, deadline)
        return last()


def plan_anytime(
    task: Task,
    *,
    human_plan: Iterable[str] | None = None,
    visible: Visible | None = None,
    cancelled: threading.Event | None = None,
    deadline: Deadline | None = None,
    **options: Any,
) -> Iterator[Result]:
    """Answers with falling objective and rising lower bound; the last is what :func:`plan` returns.

    Args and errors are those of :func:`plan`.
    """
    given = _given(task, human_plan)
    yield from planned_anytime(
        HELD.of(task), given, visible=visible, cancelled=cancelled, deadline=deadline, **options
    )


def planned_anytime(
    prepared: PreparedTask,
    given: Given,
    *,
    visible: Visible | None = None,
    cancelled: threading.Event | None = None,
    deadline: Deadline | None = None,
    **options: Any,
) -> Iterator[Result]:
    """:func:`plan_anytime` for those who hold a prepared task."""
    answers = _answers(prepared, given, visible, options, cancelled, deadline)
    while True:
        with no_collection():  # only while it plans: what the caller does with an answer is the caller's
            answer = next(answers, None)
            result = None if answer is None else answer()
        if result is None:
            return
        yield result


def _given(task: Task, names: Iterable[str] | None) -> Given:
    return None if names is None else partial(task.plan_from_names, names)


@dataclass(frozen=True, slots=True)
class _Call:
    """What one call asks for."""

    prepared: PreparedTask
    options: Options
    deadline: Deadline
    visible: Visible | None
    limits: Deadline
    """The deadline with the time that is kept for the end."""

    @property
    def task(self) -> Task:
        """The task."""
        return self.prepared.task

    def outcomes(self, human_plan: HumanPlan | None) -> Iterator[Outcome]:
        if self.options.human_model == "omniscient":
            return solve(self.prepared, self.options, human_plan=human_plan, deadline=self.deadline)
        return solve_for_human(
            self.prepared, self.options, human_plan=human_plan, visible=self.visible, deadline=self.deadline
        )

    def last(self, human_plan: HumanPlan | None) -> Answered:
        gap = Gap(self.deadline)
        for outcome in news(self.outcomes(human_plan)):
            gap.record(outcome)
        outcome = replace(outcome, human_plan=human_plan)  # also where there was no time to find that out
        return Answered(outcome, _to_result(self, outcome, gap.known()))


def _answers(
    prepared: PreparedTask,
    given: Given,
    visible: Visible | None,
    options: dict[str, Any],
    cancelled: threading.Event | None,
    outer: Deadline | None,
) -> Iterator[Callable[[], Result]]:
    """Answers that are put into words only if somebody asks for them."""
    chosen = options_from(options)
    if chosen.mode == "assistance":
        # Loaded only here, before time counts: the other modes do not need it.
        from serendipity.facade.assistance import assistance_answers, load_arrays

        if chosen.time_limit is not None:
            load_arrays()
    if visible is not None and chosen.human_model != "local":
        raise UsageError(f"visible: is for human_model 'local' only, not for '{chosen.human_model}'")
    limits = limits_from(chosen.time_limit, chosen.memory_limit, outer, cancelled)
    deadline = limits.sooner(_ANSWER_SHARE)
    human_plan = None if given is None else given()
    if chosen.mode == "assistance":
        if human_plan is not None:
            raise UsageError("human_plan: in mode 'assistance' the human chooses anew in each round")
        yield from assistance_answers(prepared, chosen, deadline)
        return
    if human_plan is not None:
        chosen = chosen.but(ties="fixed")  # there is but one plan
    call = _Call(prepared, chosen, deadline, visible, limits)
    if chosen.ties != "fixed" and _depends_on_ties(chosen):
        yield partial(_over_ties, call)
        return
    gap = Gap(deadline)
    for outcome in news(call.outcomes(human_plan)):
        gap.record(outcome)
        yield partial(_to_result, call, outcome, gap.known())


def options_from(given: dict[str, Any]) -> Options:
    """Options from keyword arguments.

    Raises:
        UsageError: an option is unknown or has no legal value.
    """
    known = [field.name for field in fields(Options)]
    for name in given:
        if name not in known:
            raise UsageError(f"unknown option '{name}': expected one of {', '.join(known)}")
    return Options(**given)


def _depends_on_ties(options: Options) -> bool:
    return options.mode in ("serendipity", "communication")


def _over_ties(call: _Call) -> Result:
    """The task solved once for each optimal ``pi_H`` (semantics 1)."""
    options = call.options
    try:
        graph = optimal_human_plans(call.prepared, call.deadline)
    except LIMITS as limit:
        return _to_result(call, Outcome("unknown", reason=limit_reason(limit)))
    if graph is None:
        return call.last(None).result
    count = graph.count()
    if count > options.max_ties:
        raise UsageError(
            f"max_ties: the human has {count} optimal plans, more than {options.max_ties}; "
            "raise max_ties, or use ties 'fixed'"
        )
    answers = list(
        until_settled(
            map(call.last, graph.plans()),
            options.ties,
            bounded=not call.task.robot_goal,
            least=lambda: least_over_ties(call.prepared, options, graph, call.deadline),
        )
    )
    result = combined(
        answers,
        options.ties,
        bounded=not call.task.robot_goal,
        everyone=len(answers) == count,
        limit=call.deadline.reached(),
    )
    measured = {"elapsed_seconds": call.deadline.elapsed(), "optimal_plans": count}
    return replace(result, statistics={**result.statistics, **measured})


def _to_result(call: _Call, outcome: Outcome, gap: Sequence[dict[str, float | None]] = ()) -> Result:
    """An outcome of the search in the form that callers see, with the gap over time."""
    task, options = call.task, call.options
    prices = _Prices(task, options.discount)
    steps = None if outcome.steps is None else _steps(task, prices, outcome.steps)
    human_plan = outcome.human_plan
    return Result(
        mode=options.mode,
        status=outcome.status,
        human=task.agents[task.human],
        options=options,
        human_plan=None if human_plan is None else tuple(task.actions[i].name for i in human_plan),
        human_cost=None if human_plan is None else float(task.cost_of(human_plan)),
        opportunity=outcome.opportunity,
        cost=_float(outcome.cost),
        saving=_float(outcome.saving),
        objective=_float(outcome.objective),
        lower_bound=_float(outcome.lower_bound),
        horizon=outcome.horizon,
        window=outcome.window,
        reason=outcome.reason,
        saving_alone=None if steps is None else _float(outcome.saving_alone),
        plan=steps,
        agent_costs={} if outcome.steps is None else _agent_costs(task, prices, outcome.steps),
        realised=_realised(call, outcome),
        statistics={
            "elapsed_seconds": call.deadline.elapsed(),
            "expanded": outcome.expanded,
            "generated": outcome.generated,
            "gap": list(gap),
        },
    )


def _realised(call: _Call, outcome: Outcome) -> dict[str, bool]:
    """The verdicts of semantics 6; none without a plan.

    They may go a little beyond the time limit, so that an answer at the limit has them too.
    """
    if outcome.steps is None or outcome.cost is None:
        return {}
    return realised(
        call.prepared,
        call.options,
        outcome.human_plan or (),
        outcome.steps,
        cost=outcome.cost,
        horizon=outcome.horizon,
        visible=call.visible,
        deadline=call.limits.sooner(-_VERDICT_SHARE),
    )


def _float(value: Fraction | None) -> float | None:
    return None if value is None else float(value)


class _Prices:
    """What actions cost the team: a few different prices for many steps, and rationals are slow."""

    def __init__(self, task: Task, discount: Fraction) -> None:
        self._task = task
        self._discount = discount
        self._known: dict[tuple[int, bool], Fraction] = {}

    def of(self, action: GroundAction) -> Fraction:
        """The undiscounted cost with the human, the discounted one else (semantics 1)."""
        kind = id(action.cost), self._task.human in action.participants
        price = self._known.get(kind)
        if price is None:
            price = self._known[kind] = self._task.team_cost(action, self._discount)
        return price


def _steps(task: Task, prices: _Prices, steps: tuple[Step, ...]) -> tuple[PlanStep, ...]:
    actions = [(step.epoch, task.actions[step.action]) for step in steps]
    return tuple(
        PlanStep(
            epoch, tuple(task.agents[i] for i in action.participants), action.name, float(prices.of(action))
        )
        for epoch, action in actions
    )


def _agent_costs(task: Task, prices: _Prices, steps: tuple[Step, ...]) -> dict[str, float]:
    """What each agent contributes; a joint action's cost is shared equally."""
    costs = {agent: Fraction(0) for agent in task.agents}
    alike: dict[tuple[tuple[int, ...], int], list[GroundAction]] = {}
    for step in steps:
        action = task.actions[step.action]
        alike.setdefault((action.participants, id(action.cost)), []).append(action)
    for (participants, _), actions in alike.items():
        share = prices.of(actions[0]) * len(actions) / len(participants)
        for agent in participants:
            costs[task.agents[agent]] += share
    return {agent: float(cost) for agent, cost in costs.items()}
