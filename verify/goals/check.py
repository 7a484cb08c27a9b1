"""The claims of an answer for several goals, as far as rules make them (semantics 8)."""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from time import perf_counter

from serendipity.model import Claim, Deadline, Result, Task
from serendipity.model.answers.certificate import ClaimVerdict
from serendipity.model.answers.fields import MalformedError
from serendipity.model.answers.result_parts import GoalAnswer
from verify.base import wording
from verify.base.individual import IndividualOptimum
from verify.base.obligations import BY_RULES, needed
from verify.base.undecided import UNDECIDED, why
from verify.goals.beliefs import considered_plan, faults
from verify.goals.reading import Believed, Recognised, read
from verify.goals.timelines import (
    GoalTimeline,
    bound_fault,
    close,
    figures_fault,
    rule_fault,
    timelines,
    together_fault,
)
from verify.rules.case import Case
from verify.rules.header import mode_and_human, reason, status_and_fields


@dataclass(frozen=True, slots=True)
class Examined:
    """What an answer for goals that are not known comes to.

    Attributes:
        claims: what is decided already; nothing else is claimed then.
        single: where one goal is left, its task and its answer, which are of section 3.
        lines: where several are left, their timelines.
    """

    claims: tuple[Claim, ...] = ()
    single: tuple[Task, Result] | None = None
    lines: tuple[GoalTimeline, ...] = ()


def examine(task: Task, result: Result, deadline: Deadline) -> Examined:
    """Whether the goals considered and their plans are right, and what is left to examine then.

    Args:
        task: the task that was asked; its own goal plays no part.
        result: an answer for goals, perhaps of another form than they have.
        deadline: what is not examined by then stays undecided.
    """
    started = perf_counter()
    try:
        recognised, served = read(task, result)
        fault = next(faults(task, recognised, deadline), None)
        chosen = _considered(task, recognised, deadline) if fault is None else []
        if fault is None:
            fault = _selection_fault(task, result, recognised, chosen, served)
    except MalformedError as error:
        fault = str(error)
    except UNDECIDED as error:
        replay = Claim("replay", "undecided", why(error), seconds=perf_counter() - started)
        others = (name for name in needed(result) if name != "replay")
        return Examined((replay, *(Claim(name, "undecided", wording.same_as(replay)) for name in others)))
    if fault is not None:
        return Examined((Claim("replay", "refuted", fault, seconds=perf_counter() - started),))
    if not chosen:
        fault = _nothing_fault(task, result)
        if fault is not None:
            return Examined((Claim("replay", "refuted", fault),))
        return Examined((Claim("infeasible", "proved", wording.NO_GOAL_ALONE),))
    if len(chosen) == 1:
        return _certain(task, result, chosen[0], served[0])
    goals = [believed.goal for believed in chosen]
    return Examined(lines=tuple(timelines(task, result, goals, served, deadline)))


def claims_by_rules(result: Result, lines: Sequence[GoalTimeline]) -> tuple[Claim, ...]:
    """What rules say of an answer for several goals: of its bound only if that is not consistent."""
    claims: dict[str, Claim] = {}
    for name, fault in _rules(result, lines):
        replay = claims.get("replay")
        if replay is not None and replay.verdict == "refuted" and name in ("cost", "window"):
            claims[name] = Claim(name, "not_in_scope", wording.NO_REPLAYS)
        elif replay is not None and replay.verdict == "undecided":
            claims[name] = Claim(name, "undecided", wording.same_as(replay))
        else:
            claims[name] = _by_rule(name, fault)
    if claims["lower_bound"].verdict == "proved":
        del claims["lower_bound"]
    return tuple(claims.values())


def unexamined(result: Result, claims: Sequence[Claim], *, solving: bool = False) -> tuple[Claim, ...] | None:
    """The claims that no optimiser is asked about; None: they are to be proved.

    Args:
        result: the answer.
        claims: what rules say of it.
        solving: whether there is an optimiser.
    """
    wanted = beyond_rules(result)
    refuted = {claim.claim for claim in claims if claim.verdict == "refuted"}
    replay = next(claim for claim in claims if claim.claim == "replay")
    if refuted or not solving:
        out = wording.ANSWER_BREAKS_RULE if refuted else wording.NEEDS_OPTIMISER
        return tuple(Claim(name, "not_in_scope", out) for name in wanted if name not in refuted)
    if replay.verdict == "undecided":
        return tuple(Claim(name, "undecided", wording.same_as(replay)) for name in wanted)
    return None


def beyond_rules(result: Result) -> list[str]:
    """The claims that a proof needs and that rules can't make."""
    return [name for name in needed(result) if name not in BY_RULES]


def _rules(result: Result, lines: Sequence[GoalTimeline]) -> Iterator[tuple[str, Callable[[], str | None]]]:
    yield "replay", lambda: rule_fault("replay", lines) or together_fault(result, lines)
    yield "cost", lambda: rule_fault("cost", lines) or figures_fault(result, lines)
    yield "window", lambda: rule_fault("window", lines)
    yield "lower_bound", lambda: bound_fault(result)


def _by_rule(name: str, fault: Callable[[], str | None]) -> Claim:
    started = perf_counter()
    try:
        found = fault()
    except UNDECIDED as error:
        return Claim(name, "undecided", why(error), seconds=perf_counter() - started)
    verdict: ClaimVerdict = "proved" if found is None else "refuted"
    return Claim(name, verdict, found or wording.FOLLOWED_BY_ALL[name], seconds=perf_counter() - started)


def _considered(task: Task, recognised: Recognised, deadline: Deadline) -> list[Believed]:
    """The goals that are possible and that the human can reach, with the plans that are expected of them."""
    seen = recognised.observed if recognised.explained else ()
    planned = [
        replace(goal, plan=considered_plan(task, goal.goal, seen, deadline))
        for goal in recognised.goals
        if goal.posterior
    ]
    return [goal for goal in planned if goal.plan is not None]


def _selection_fault(
    task: Task,
    result: Result,
    recognised: Recognised,
    chosen: Sequence[Believed],
    served: Sequence[GoalAnswer],
) -> str | None:
    """Whether the goals considered, their plans and probabilities follow from the posterior."""
    if [entry.name for entry in served] != [goal.name for goal in chosen]:
        return f"the goals to consider are {', '.join(goal.name for goal in chosen) or 'none'}"
    if not chosen:
        return (
            None if result.status == "infeasible" and result.plan is None else "no goal can be reached alone"
        )
    total = sum(goal.posterior for goal in chosen)
    for goal, entry in zip(chosen, served, strict=True):
        if not close(entry.probability, Fraction(goal.posterior / total)):
            return f"goal '{goal.name}': the probability is {goal.posterior / total:.12g}"
        if len(chosen) > 1 and entry.human_plan != goal.plan:
            return f"goal '{goal.name}': human_plan is not the canonical plan that explains the observations"
    if len(chosen) > 1:
        return _header_fault(task, result, chosen)
    seen = recognised.observed and recognised.explained
    if seen and result.human_plan != chosen[0].plan:
        return f"goal '{chosen[0].name}': pi_H is not the canonical plan that explains the observations"
    return None


def _header_fault(task: Task, result: Result, chosen: Sequence[Believed]) -> str | None:
    options = result.options
    if (result.mode, options.mode) != ("serendipity", "serendipity"):
        return "goals that are not known are for mode serendipity"
    if (options.ties, options.human_model, options.max_cost) != (
        "fixed",
        "omniscient",
        None,
    ) or task.robot_goal:
        return "ties, human models, max_cost and robots' goals are for a single goal"
    if result.status not in ("optimal", "feasible") or result.plan is None:
        return "leaving the human alone is always an answer"
    longest = max(len(goal.plan or ()) for goal in chosen)
    expected = longest if options.horizon is None else options.horizon
    if result.horizon != expected or longest > int(expected):
        return f"the horizon is {expected}, at least {longest}; the answer says {result.horizon}"
    if result.reason is not None:
        return f"status {result.status} with a reason"
    if result.window is not None or result.human_plan is not None or result.realised:
        return "windows, plans and verdicts belong to single goals"
    return None


def _nothing_fault(task: Task, result: Result) -> str | None:
    """Whether an answer that says that there is no plan says more than that."""
    own = (result.human_plan, result.human_cost, result.lower_bound, result.horizon)
    if own != (None, None, None, None):
        return "infeasible, with a plan, a cost, a bound or a horizon"
    case = Case(task, result, IndividualOptimum(task))
    found = mode_and_human(case) or status_and_fields(case) or reason(case)
    return None if found is None else found.message


def _certain(task: Task, result: Result, goal: Believed, entry: GoalAnswer) -> Examined:
    """One goal is left: the answer is one of section 3."""
    same = (entry.human_plan, entry.cost, entry.window, entry.plan)
    if same != (result.human_plan, result.cost, result.window, result.plan):
        return Examined((Claim("replay", "refuted", f"goal '{goal.name}': the entry is not the answer"),))
    known = replace(result, goals=None, recognition=None)
    return Examined(single=(task.with_goal(goal.goal), known))
