"""Answers where it is known only up to a choice what the human will do (semantics 8 and 11).

Epoch 1 is the first epoch of the human's plans, and observations are actions of those plans:
their current plan for a goal is the canonical optimal plan from ``I`` that embeds them.
"""

from collections.abc import Iterator, Sequence
from dataclasses import replace
from fractions import Fraction
from itertools import count, islice
from typing import Final, NamedTuple

from search import PreparedTask, canonical_human_plan, first_answer, optimal_human_plans
from search.modes.goals import Explainer
from search.modes.scenarios import Candidate
from serendipity.facade import ties
from serendipity.facade.call import Request
from serendipity.facade.in_time import ScenariosInTime, answers_in_time
from serendipity.facade.results import named_plan
from serendipity.facade.rules import over_scenarios
from serendipity.model import Condition, Deadline, HumanPlan, Options, Task, UsageError
from serendipity.model.answers.answer import Answer, ServedGoal
from serendipity.model.answers.recognition import Recognition
from serendipity.model.errors import LIMITS, LimitReachedError, limit_reason
from serendipity.model.numbers import Number
from serendipity.model.task.gate import needs_time
from serendipity.model.task.plans import TimedPlan
from serendipity.recognition.in_time import explained_in_time
from serendipity.recognition.library import LibraryGiven, LibraryPlan, plan_library
from serendipity.recognition.recognise import (
    CandidateGoal,
    GoalsGiven,
    Noise,
    ObservedGiven,
    candidate_goals,
    noise_from,
    observed_actions,
    posterior,
    refuse_noise,
    strictness,
)

_SOON: Final = 0.5
"""The share of the time for some plan to each goal, which the optimal ones don't need."""

_FIXED: Final[dict[str, object]] = {"human_model": "omniscient", "max_cost": None}
"""Options that have one value only where there are several scenarios."""


class Unsure(NamedTuple):
    """What is known of a human whose plan is not; equal for equal questions.

    Attributes:
        plans: that they may follow; None: of goals all that lead there.
        goals: that they may have; None: the task's.
        observed: names of the actions that they have done.
        beta: how strictly they minimise cost.
        noise: of what was observed.
    """

    plans: tuple[LibraryPlan, ...] | None = None
    goals: tuple[CandidateGoal, ...] | None = None
    observed: tuple[str, ...] = ()
    beta: float = 1.0
    noise: Noise | None = None


def read_unsure(
    task: Task,
    *,
    goals: GoalsGiven | None = None,
    observed: ObservedGiven = (),
    beta: Number = 1,
    plans: LibraryGiven | None = None,
    noise: Noise | str | None = None,
) -> Unsure:
    """What a caller says of such a human; see :func:`serendipity.plan`.

    Raises:
        InputError: a file or an entry of it is wrong.
        UsageError: ``beta`` or ``noise`` is.
    """
    if plans is not None:
        return Unsure(plan_library(task, plans))
    if goals is None:
        return Unsure()
    names = observed_actions(task, observed)
    return Unsure(None, candidate_goals(task, goals), names, strictness(beta), noise_from(noise))


_Said = tuple[Request, Answer]
"""An answer, and the call that it is to."""


def answers(call: Request, unsure: Unsure) -> Iterator[_Said]:
    """Answers to the call that is left once the scenarios are known.

    With several of them that is a policy; with one, section 3 for that one.  Goals of posterior 0, or that
    the human can't reach alone, are not considered.  Where nothing was observed, idle robots come first,
    beside some plan to each goal, and last where there is no time for more; else that is ``unknown``.

    Raises:
        UsageError: an option that has no meaning here; more optimal plans than ``max_ties``.
    """
    _require_answerable(call, unsure)
    recognition, first, in_time = None, None, ScenariosInTime(call)
    try:
        if not unsure.observed and (first := _beside_some_plans(call, unsure.goals or ())) is not None:
            yield first
        if unsure.plans is not None:
            considered = [Candidate(one.goal, one.plan, one.probability, one.name) for one in unsure.plans]
        elif unsure.goals is None:
            considered = _shared(call, in_time, [Candidate(call.task.goal, (), Fraction(1))])
        else:
            considered, recognition = _by_goals(call, in_time, unsure, unsure.goals)
    except LIMITS as limit:
        if first is None:
            yield call, Answer("unknown", reason=limit_reason(limit), expanded=None, generated=None)
        return
    if not considered:
        nothing = Answer("infeasible", reason="no-human-plan", expanded=None, generated=None, goals=())
        yield call, nothing._replace(recognition=recognition)
    elif len(considered) == 1:
        only = considered[0]
        about = _about(call, only, recognition)
        for answer in _answers(about):
            yield about, _certain(only, recognition, _unsaid(call.task, only, recognition), answer)
    else:
        _refuse(call.task, call.options)
        known = first is not None
        try:
            for answer in _expected(considered, recognition, call, in_time):
                known = True
                yield call, answer
        except LIMITS as limit:
            if not known:
                yield call, Answer("unknown", reason=limit_reason(limit), expanded=None, generated=None)


def _require_answerable(call: Request, unsure: Unsure) -> None:
    """Raise UsageError where an option has no meaning beside goals, or what was observed."""
    if unsure.goals is not None and len(unsure.goals) > 1:
        _refuse(call.task, call.options)
    if unsure.observed and call.task.needs_time:
        refuse_noise(unsure.noise)
    if unsure.observed and call.options.ties == "watched":
        raise UsageError("ties: 'watched' goes without observed: each goal's plans are all its optimal ones")


def _beside_some_plans(call: Request, candidates: Sequence[CandidateGoal]) -> _Said | None:
    """Idle robots beside a plan to each goal that is found soon, as if such plans were given.

    None where they are no answer, and where time does not do.
    """
    options = call.options
    plain = options.ties == "fixed" and all(getattr(options, name) == of for name, of in _FIXED.items())
    if not plain or call.task.robot_goal or needs_time(call.task, options=options):
        return None
    known, late = [], call.deadline.part(_SOON)
    try:
        if len(candidates) == 1:
            packed = [call.prepared.with_goal(candidates[0].goal)]
        else:  # together: each takes time that grows with the files
            wanted = [(one.goal, Condition()) for one in candidates]
            packed = call.prepared.with_goals(wanted, frozenset(), late)
        for number, (one, prepared) in enumerate(zip(candidates, packed, strict=True)):
            part = late.part(1 / (len(candidates) - number))
            asked = prepared, call.options, part
            if one.prior and (idle := _beside_some_plan(*asked, alone=len(packed) == 1)) is not None:
                known.append((Candidate(one.goal, idle.human_plan or (), one.prior, one.name), idle))
    except LIMITS:
        return None
    total = sum(one.weight for one, _ in known)
    found = [replace(one, weight=one.weight / total) for one, _ in known]
    if not found:
        return None
    if len(found) > 1:
        return call, next(_expected(found, None, call, ScenariosInTime(call)))
    own = _unsaid(call.task, found[0], None)
    return _about(call, found[0], None), _certain(found[0], None, own, known[0][1])


def _beside_some_plan(
    prepared: PreparedTask, options: Options, deadline: Deadline, *, alone: bool
) -> Answer | None:
    """Idle robots beside a plan to the goal; None where there is none that fits.

    None, too, where it is the only goal, and its optimal plan is found as soon: so is the answer to it.

    Raises:
        LimitReachedError: a limit came first.
    """
    known = first_answer(prepared, options, deadline)
    plan = known.plan
    if plan is None and not alone:
        plan = canonical_human_plan(prepared, deadline, options)
    if plan is None:
        return None
    if (found := known.beside(plan)) is None:
        raise LimitReachedError("time-limit")
    return found


def _answers(call: Request) -> Iterator[Answer]:
    """Answers beside one plan of the human's, with time or without."""
    if needs_time(call.task, options=call.options, plan=call.given):
        return answers_in_time(call, ties.answers)
    return ties.answers(call)


def _by_goals(
    call: Request, in_time: ScenariosInTime, unsure: Unsure, candidates: Sequence[CandidateGoal]
) -> tuple[list[Candidate], Recognition | None]:
    """A scenario for each goal that is possible, or for each optimal plan to it, and the posterior.

    Raises:
        UsageError: as :func:`answers`.
        LimitReachedError: a limit came first.
    """
    recognition, plans = _recognised(call, candidates, unsure.observed, unsure.beta, unsure.noise)
    considered = _considered(candidates, recognition, plans)
    shared = _shared(call, in_time, considered) if call.options.ties == "watched" else considered
    return shared, recognition


def _shared(call: Request, in_time: ScenariosInTime, considered: Sequence[Candidate]) -> list[Candidate]:
    """A scenario for each optimal plan to a goal, which share its probability.

    Raises:
        UsageError: there are more than ``max_ties``.
        LimitReachedError: a limit came first.
    """
    found, taken = [], {one.name for one in considered}
    for one in considered:
        plans = _optimal_plans(call, in_time, one.goal)
        numbered = (f"{one.name or 'plan'} {number}" for number in count(1))
        names = [one.name] if len(plans) == 1 else (name for name in numbered if name not in taken)
        for plan, name in zip(plans, names, strict=False):
            found.append(replace(one, plan=plan, weight=one.weight / len(plans), name=name))
    return found


def _optimal_plans(call: Request, in_time: ScenariosInTime, goal: Condition) -> list[HumanPlan]:
    """The human's optimal plans to a goal.

    Raises:
        LimitReachedError: a limit came first.
        UsageError: there are more than ``max_ties``.
    """
    if call.task.needs_time:
        most = call.options.max_ties
        found = list(islice(in_time.optimal(goal), most + 1))
        ties.require_few(len(found), call.options)
        return found
    graph = optimal_human_plans(call.prepared.with_goal(goal), call.deadline)
    if graph is None:
        return []
    ties.require_few(graph.count(), call.options)
    return list(graph.plans())


def _recognised(
    call: Request,
    candidates: Sequence[CandidateGoal],
    observed: tuple[str, ...],
    beta: float,
    noise: Noise | None,
) -> tuple[Recognition, Sequence[HumanPlan | None]]:
    """The posterior, and for each goal the plan of the human's that is considered.

    Raises:
        LimitReachedError: the deadline ran out.
    """
    task, deadline = call.task, call.deadline
    conditions = [candidate.goal for candidate in candidates]
    if task.needs_time:
        found = explained_in_time(task, conditions, observed, call.options, deadline)
        recognition = posterior(task, candidates, observed, found, beta)
        if not recognition.explained:
            found = explained_in_time(task, conditions, (), call.options, deadline)
        return recognition, [one.plan for one in found]
    explainer = Explainer(call.prepared, conditions)
    found = explainer.explain(observed, deadline)
    read = explainer.readings(observed, noise.prices(beta), deadline) if noise else None
    recognition = posterior(task, candidates, observed, found, beta, noise, read)
    if not recognition.explained:  # the human's plans, as if nothing had been observed
        found, read = explainer.explain((), deadline), None
    return recognition, [None if one is None else one.plan for one in read or found]


def _considered(
    candidates: Sequence[CandidateGoal], recognition: Recognition, plans: Sequence[HumanPlan | None]
) -> list[Candidate]:
    """A scenario for each goal that is possible and that the human can reach alone."""
    possible = [
        (candidate, known, plan)
        for candidate, known, plan in zip(candidates, recognition.goals, plans, strict=True)
        if plan is not None and known.weight > 0
    ]
    total = sum(known.weight for _, known, _ in possible)
    return [Candidate(goal.goal, plan, known.weight / total, goal.name) for goal, known, plan in possible]


def _refuse(task: Task, options: Options) -> None:
    if options.ties not in ("fixed", "watched"):
        raise UsageError("ties: with several goals or plans expected 'fixed' or 'watched'")
    for name, value in _FIXED.items():
        if getattr(options, name) != value:
            raise UsageError(f"{name}: with several goals or plans only {value!r} is possible")
    if task.robot_goal:
        raise UsageError("robots that have goals of their own can be asked about one goal and plan only")


def _about(call: Request, candidate: Candidate, recognition: Recognition | None) -> Request:
    """The call of section 3 for one scenario, with the plan that explains the observations, or is given."""
    prepared = call.prepared.with_goal(candidate.goal)
    if recognition is not None and not (recognition.observed and recognition.explained):
        fixed = call.options.but(ties="fixed") if call.options.ties == "watched" else call.options
        return call._replace(prepared=prepared, options=fixed)
    task = prepared.task
    given = task.plan_from_names(named_plan(task, candidate.plan))
    return call._replace(prepared=prepared, given=given, options=call.options.but(ties="fixed"))


def _certain(
    candidate: Candidate, recognition: Recognition | None, goal: tuple[str, ...] | None, answer: Answer
) -> Answer:
    """The answer to the one scenario that is left; ``goal``: its literals, where nothing else has them."""
    if recognition is None and goal is None:
        return answer
    plan = answer.human_plan
    served = ServedGoal(candidate.name, Fraction(1), plan, answer.steps, answer.window, answer.cost, goal)
    return answer._replace(recognition=recognition, goals=(served,))


def _expected(
    considered: Sequence[Candidate],
    recognition: Recognition | None,
    call: Request,
    in_time: ScenariosInTime,
) -> Iterator[Answer]:
    """Several scenarios are left."""
    own = [_unsaid(call.task, candidate, recognition) for candidate in considered]
    waits = any(isinstance(one.plan, TimedPlan) for one in considered)
    timed = waits or needs_time(call.task, options=call.options)
    for answer in in_time.answers(considered) if timed else over_scenarios(call, considered):
        served = zip(answer.goals or (), own, strict=True)
        goals = tuple(replace(one, goal=goal) for one, goal in served)
        yield answer._replace(recognition=recognition, goals=goals)


def _unsaid(task: Task, candidate: Candidate, recognition: Recognition | None) -> tuple[str, ...] | None:
    """The literals of a scenario's goal, where neither the task nor a recognition says them."""
    is_said = recognition is not None or candidate.goal == task.goal
    return None if is_said else candidate.goal.literals(task.facts)
