"""Planning where the human's goal is not known: answers of ``plan(goals=..., observed=...)`` (semantics 8).

Epoch 1 is the first epoch of the human's plans, and observations are actions of those plans:
their current plan for a goal is the canonical optimal plan from ``I`` that embeds them.
"""

from collections.abc import Callable, Sequence
from dataclasses import replace
from fractions import Fraction
from typing import Any, Final

from search import PreparedTask
from search.goals import Candidate, Expected, ServedGoal, explanations, solve_expected
from serendipity.model import Options, PlanStep, Result, Step, Task, UsageError
from serendipity.model.deadline import Deadline
from serendipity.model.errors import LIMITS, limit_reason
from serendipity.model.numbers import Number
from serendipity.model.task import HumanPlan
from serendipity.recognition.candidates import (
    CandidateGoal,
    GoalsGiven,
    ObservedGiven,
    candidate_goals,
    observed_actions,
)
from serendipity.recognition.recognise import posterior, strictness
from serendipity.recognition.recognition import Recognition

Solve = Callable[[PreparedTask, tuple[str, ...] | None], Result]
"""Section 3 for a task, and ``pi_H`` or None to predict it."""

_FIXED: Final[dict[str, object]] = {"ties": "fixed", "human_model": "omniscient", "max_cost": None}
"""Options that have one value only where there are several goals."""


def plan_for_goals(
    prepared: PreparedTask,
    goals: GoalsGiven,
    observed: ObservedGiven,
    beta: Number,
    options: Options,
    solve: Solve,
    deadline: Deadline,
) -> Result:
    """The robots' plan of least expected cost over the posterior; with one goal, section 3.

    ``cost``, ``human_cost``, ``saving`` and ``objective`` are expectations, ``plan`` is what
    robots do by themselves whatever the goal is, and ``statistics["goals"]`` says for each
    goal what happens then.  Goals of posterior 0, or that the human can't reach alone, are not
    considered.  Without the time for the posterior the answer is ``unknown``, and has none of that.

    Raises:
        InputError: a file or an entry of it is wrong.
        UsageError: an option that has no meaning here.
    """
    task = prepared.task
    if options.mode != "serendipity":
        raise UsageError(f"goals: are for mode 'serendipity' only, not for '{options.mode}'")
    candidates = candidate_goals(task, goals)
    names = observed_actions(task, observed)
    if len(candidates) > 1:
        _refuse(task, options)
    try:
        recognition, plans = _recognised(task, candidates, names, strictness(beta), deadline)
    except LIMITS as limit:
        return Result(
            options.mode,
            "unknown",
            task.agents[task.human],
            options,
            reason=limit_reason(limit),
            statistics={"elapsed_seconds": deadline.elapsed()},
        )
    considered = [i for i, known in enumerate(recognition.goals) if plans[i] is not None and known.weight > 0]
    if not considered:
        result = Result("serendipity", "infeasible", recognition.human, options, reason="no-human-plan")
        return _with(result, recognition, deadline, [])
    if len(considered) == 1:
        return _certain(prepared, candidates, considered[0], plans, recognition, solve)
    total = sum(recognition.goals[i].weight for i in considered)
    asked = []
    for i in considered:
        plan = plans[i]
        assert plan is not None, "only goals with a plan are considered"
        asked.append(Candidate(candidates[i].goal, plan, recognition.goals[i].weight / total))
    if options.horizon is not None and int(options.horizon) < max(len(c.plan) for c in asked):
        longest = max(len(c.plan) for c in asked)
        raise UsageError(
            f"horizon: expected at least {longest}, as long as the longest plan, got {options.horizon}"
        )
    answer = solve_expected(prepared, options, asked, deadline)
    entries = [
        _entry(task, options, recognition.goals[i].name, candidate, served)
        for i, candidate, served in zip(considered, asked, answer.served, strict=True)
    ]
    return _with(_result(task, options, answer, asked), recognition, deadline, entries)


def _recognised(
    task: Task,
    candidates: Sequence[CandidateGoal],
    observed: tuple[str, ...],
    beta: float,
    deadline: Deadline,
) -> tuple[Recognition, list[HumanPlan | None]]:
    """The posterior, and for each goal the plan of the human's that is considered.

    Raises:
        LimitReachedError: the deadline ran out.
    """
    conditions = [candidate.goal for candidate in candidates]
    found = explanations(task, conditions, observed, deadline)
    recognition = posterior(task, candidates, observed, found, beta)
    if not recognition.explained:  # the human's plans, as if nothing had been observed
        found = explanations(task, conditions, (), deadline)
    return recognition, [explanation.plan for explanation in found]


def _refuse(task: Task, options: Options) -> None:
    for name, value in _FIXED.items():
        if getattr(options, name) != value:
            raise UsageError(f"{name}: with several goals only {value!r} is possible")
    if task.robot_goal:
        raise UsageError("goals: robots that have goals of their own can be asked about one goal only")


def _certain(
    prepared: PreparedTask,
    candidates: tuple[CandidateGoal, ...],
    index: int,
    plans: list[HumanPlan | None],
    recognition: Recognition,
    solve: Solve,
) -> Result:
    """One goal is left: section 3, with the plan that explains the observations."""
    task, goal = prepared.task, prepared.with_goal(candidates[index].goal)
    plan = plans[index]
    names = None
    if recognition.observed and recognition.explained and plan is not None:
        names = tuple(task.actions[i].name for i in plan)
    result = solve(goal, names)
    entry = {
        "name": recognition.goals[index].name,
        "probability": 1.0,
        "human_plan": None if result.human_plan is None else list(result.human_plan),
        "cost": result.cost,
        "window": result.to_dict()["window"],
        "plan": result.to_dict()["plan"],
    }
    return _with(result, recognition, None, [entry])


def _with(
    result: Result, recognition: Recognition, deadline: Deadline | None, entries: list[dict[str, Any]]
) -> Result:
    statistics = {**result.statistics, "recognition": recognition.to_dict(), "goals": entries}
    if deadline is not None:
        statistics["elapsed_seconds"] = deadline.elapsed()
    return replace(result, statistics=statistics)


def _result(task: Task, options: Options, answer: Expected, asked: list[Candidate]) -> Result:
    shares: dict[str, Fraction] = {agent: Fraction(0) for agent in task.agents}
    for candidate, served in zip(asked, answer.served, strict=True):
        for step in served.steps:
            action = task.actions[step.action]
            each = candidate.weight * task.team_cost(action, options.discount) / len(action.participants)
            for agent in action.participants:
                shares[task.agents[agent]] += each
    return Result(
        mode=options.mode,
        status=answer.status,
        human=task.agents[task.human],
        options=options,
        human_cost=float(answer.baseline),
        opportunity=answer.opportunity,
        cost=float(answer.cost),
        saving=float(answer.baseline - answer.cost) if answer.opportunity else 0.0,
        objective=float(answer.objective),
        lower_bound=float(answer.lower_bound),
        horizon=answer.horizon,
        saving_alone=float(answer.saving_alone),
        plan=tuple(_step(task, options, step) for step in answer.robots),
        agent_costs={agent: float(cost) for agent, cost in shares.items()},
        statistics={"expanded": answer.expanded, "generated": answer.generated},
    )


def _entry(
    task: Task, options: Options, name: str, candidate: Candidate, served: ServedGoal
) -> dict[str, Any]:
    """What happens if one goal is the human's, as plain values."""
    window = served.window
    return {
        "name": name,
        "probability": float(candidate.weight),
        "human_plan": [task.actions[i].name for i in candidate.plan],
        "cost": float(served.cost),
        "window": None if window is None else {"start": window.start, "end": window.end},
        "plan": [_step(task, options, step).to_dict() for step in served.steps],
    }


def _step(task: Task, options: Options, step: Step) -> PlanStep:
    action = task.actions[step.action]
    agents = tuple(task.agents[i] for i in action.participants)
    return PlanStep(step.epoch, agents, action.name, float(task.team_cost(action, options.discount)))
