"""The claims of an answer over scenarios, as far as rules make them (semantics 8, 11)."""

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import replace
from fractions import Fraction
from itertools import count, islice
from time import perf_counter
from typing import NamedTuple

from serendipity.model import Claim, Condition, Deadline, HumanPlan, PlanError, Result, Task
from serendipity.model.answers.certificate import ClaimVerdict
from serendipity.model.answers.fields import MalformedError
from serendipity.model.answers.result_parts import GoalAnswer
from serendipity.model.task.gate import is_bound
from serendipity.model.task.protected import interfering_plainly
from verify.base import wording
from verify.base.beside_script import alone_of
from verify.base.obligations import BY_RULES, needed
from verify.base.undecided import UNDECIDED, UndecidedError, why
from verify.rules.case import CheckedResult
from verify.rules.header import mode_and_human, reason, status_and_fields
from verify.rules.layers import Layers
from verify.rules.leftovers import left
from verify.rules.nobody_pays import LastStateRule, RulesOfHelp, last_state
from verify.rules.replay import replay_human
from verify.scenarios.beliefs import considered_plans, faults
from verify.scenarios.reading import condition, listed, recognised
from verify.scenarios.timelines import (
    Aimed,
    ScenarioTimeline,
    bound_fault,
    close,
    figures_fault,
    lasting_fault,
    rule_fault,
    suffix_fault,
    timelines,
    together_fault,
)


class NamedScenario(NamedTuple):
    """What an answer has to consider; the plan by names."""

    name: str
    goal: Condition
    plan: tuple[str, ...]
    probability: Fraction


def claims_over_scenarios(
    task: Task,
    result: Result,
    original: Task,
    deadline: Deadline,
    certain: Callable[[Task, Result], Iterable[Claim]],
    proved: Callable[[Sequence[ScenarioTimeline]], Iterable[Claim]] | None = None,
) -> tuple[Claim, ...]:
    """The claims of an answer over scenarios; where one scenario is left it is an answer of section 3.

    Args:
        result: the answer, perhaps of another form than such answers have.
        original: the task as it was given, where this one is in single epochs.
        deadline: what is not examined by then stays undecided.
        certain: makes the claims of an answer of section 3.
        proved: makes those that rules can't make of an answer that breaks none; None: nobody does.
    """
    started, aimed = perf_counter(), list[Aimed]()
    try:
        served = listed(result)
        chosen, origin, fault = _expected(task, result, original, served, deadline)
        fault = fault or _selection_fault(task, result, chosen, served)
        if fault is None and not chosen:
            fault = _nothing_fault(task, result)
        if fault is None and len(chosen) == 1:
            fault = _entry_fault(result, served[0])
        if fault is None and len(chosen) > 1:
            pairs = list(zip(chosen, served, strict=True))
            aimed, fault = _bound(task, result, original, pairs, deadline)
    except (MalformedError, PlanError) as error:
        fault = str(error)
    except UNDECIDED as error:
        return tuple(Claim(name, "undecided", why(error)) for name in needed(result))
    if fault is not None:
        return (Claim("replay", "refuted", fault, seconds=perf_counter() - started),)
    if not chosen:
        return (Claim("infeasible", "proved", wording.NO_GOAL_ALONE),)
    if len(chosen) == 1:
        ties = "fixed" if result.options.ties == "watched" else result.options.ties
        known = replace(result, goals=None, recognition=None, options=result.options.but(ties=ties))
        return tuple(certain(task.with_goal(chosen[0].goal), known))
    if any(one.original for one in aimed):
        result = replace(result, options=interfering_plainly(result.options))
    lines = timelines(aimed, result, served, deadline)
    claims = tuple(_claims_by_rules(result, lines, origin))
    return *claims, *_beyond_rules(result, lines, claims, proved)


def _bound(
    task: Task,
    result: Result,
    original: Task,
    pairs: Sequence[tuple[NamedScenario, GoalAnswer]],
    deadline: Deadline,
) -> tuple[list[Aimed], str | None]:
    """Each scenario's task, its goals, what has to be kept or paid for, and what breaks a rule of help.

    As with one scenario they are those without the rules where the answer does not say that they bind.
    """
    tasks = {one.goal: task.with_goal(one.goal, Condition()) for one, _ in pairs}
    plain = [Aimed(tasks[one.goal]) for one, _ in pairs]
    options = result.options
    if not is_bound(original, options):
        return plain, None
    rules, plans, paid = list[LastStateRule](), list[HumanPlan](), list[Fraction]()
    for one, entry in pairs:
        own, told = tasks[one.goal], replace(result, plan=entry.plan)
        asked = RulesOfHelp(own, options, original, deadline)
        plans.append(replay_human(own, one.plan, deadline))
        rules.append(asked.of(plans[-1], int(result.horizon or 0)))
        fault = asked.fault(told, rules[-1], plans[-1])
        if fault is not None:
            return plain, f"scenario '{one.name}': {fault}"
        leaves = left(rules[-1].prices, last_state(own, told)) if rules[-1].prices else {}
        paid.append(sum(leaves.values(), Fraction(0)))
    if not result.statistics.get("rule_binds") and not any(paid):
        return plain, None
    most = max((rule.most for rule in rules if rule.most is not None), default=None)
    known: dict[object, Layers] = {}
    found = []
    for (one, _), plan, rule, price in zip(pairs, plans, rules, paid, strict=True):
        alike = (one.goal, plan) if options.noticed else None
        if alike not in known:
            known[alike] = Layers(tasks[one.goal], options, plan, most, original, deadline)
        layers = known[alike]
        goal = layers.goal(layers.task.goal if alike else one.goal, rule.most)
        found.append(Aimed(layers.task.with_goal(goal, rule.facts), layers.original, rule.prices, price))
    return found, None


def _beyond_rules(
    result: Result,
    lines: Sequence[ScenarioTimeline],
    claims: Sequence[Claim],
    proved: Callable[[Sequence[ScenarioTimeline]], Iterable[Claim]] | None,
) -> Iterable[Claim]:
    refuted = {claim.claim for claim in claims if claim.verdict == "refuted"}
    replay, wanted = claims[0], beyond_rules(result)
    if refuted or proved is None:
        out = wording.ANSWER_BREAKS_RULE if refuted else wording.NEEDS_OPTIMISER
        return [Claim(name, "not_in_scope", out) for name in wanted if name not in refuted]
    if replay.verdict == "undecided":
        return [Claim(name, "undecided", wording.same_as(replay)) for name in wanted]
    return proved(lines)


def _claims_by_rules(result: Result, lines: Sequence[ScenarioTimeline], origin: str) -> Iterator[Claim]:
    """What rules say of an answer over several scenarios: of its bound only if that is not consistent."""
    replay: Claim | None = None
    rules: dict[str, Callable[[], str | None]] = {
        "replay": lambda: (
            rule_fault("replay", lines) or lasting_fault(lines) or together_fault(result, lines)
        ),
        "cost": lambda: rule_fault("cost", lines) or figures_fault(result, lines),
        "window": lambda: rule_fault("window", lines) or suffix_fault(lines),
        "lower_bound": lambda: bound_fault(result, lines),
    }
    for name, fault in rules.items():
        if replay is not None and replay.verdict == "refuted" and name in ("cost", "window"):
            claim = Claim(name, "not_in_scope", wording.NO_REPLAYS)
        elif replay is not None and replay.verdict == "undecided":
            claim = Claim(name, "undecided", wording.same_as(replay))
        else:
            claim = _by_rule(name, fault, origin)
        replay = replay or claim
        if (name, claim.verdict) != ("lower_bound", "proved"):
            yield claim


def beyond_rules(result: Result) -> list[str]:
    """The claims that a proof needs and that rules can't make."""
    return [name for name in needed(result) if name not in BY_RULES]


def _by_rule(name: str, fault: Callable[[], str | None], origin: str) -> Claim:
    started = perf_counter()
    try:
        found = fault()
    except UNDECIDED as error:
        return Claim(name, "undecided", why(error), seconds=perf_counter() - started)
    verdict: ClaimVerdict = "proved" if found is None else "refuted"
    words = found or wording.FOLLOWED_BY_ALL[name].format(origin)
    return Claim(name, verdict, words, seconds=perf_counter() - started)


def _expected(
    task: Task, result: Result, original: Task, served: Sequence[GoalAnswer], deadline: Deadline
) -> tuple[list[NamedScenario], str, str | None]:
    """The scenarios to consider, where they come from, and what is wrong with that."""
    known, watched = recognised(result), result.options.ties == "watched"
    if known is None and not watched:
        if not served and result.status == "infeasible":
            raise UndecidedError(wording.NO_GOALS_TOLD)
        return _given(task, served)
    fault = None if known is None else next(faults(task, known, result.options, original, deadline), None)
    if fault is not None:
        return [], "", fault
    seen = known.observed if known is not None and known.explained else ()
    goals, read = [("", task.goal, 1.0)], dict[str, tuple[str, ...]]()
    if known is not None:
        goals = [(one.name, condition(task, one.goal), one.posterior) for one in known.goals if one.posterior]
        read = {one.name: one.plan or () for one in known.goals} if known.noise and known.explained else {}
    found, most = list[NamedScenario](), result.options.max_ties if watched else 1
    taken = {name for name, *_ in goals}
    for name, goal, share in goals:
        all_plans = considered_plans(task, goal, seen, result.options, deadline)
        plans = [("", read[name])] if name in read else list(islice(all_plans, most + watched))
        if len(plans) > most:
            fault = f"max_ties: the human has more than {most} optimal plans"
        numbered = (f"{name or 'plan'} {number}" for number in count(1))
        names = [name] if len(plans) == 1 else (own for own in numbered if own not in taken)
        for own, (_, plan) in zip(names, plans, strict=False):
            found.append(NamedScenario(own, goal, plan, Fraction(share) / len(plans)))
    total = sum((scenario.probability for scenario in found), Fraction(0))
    shares = [scenario._replace(probability=scenario.probability / total) for scenario in found]
    return shares, wording.ALL_OPTIMAL if known is None else wording.POSTERIOR, fault


def _given(task: Task, served: Sequence[GoalAnswer]) -> tuple[list[NamedScenario], str, str | None]:
    """Plans that were given with their probabilities: of these nothing is known but what the answer says."""
    found = []
    for entry in served:
        if entry.human_plan is None or entry.probability <= 0:
            return [], "", f"scenario '{entry.name}': expected a plan and a probability above 0"
        goal = task.goal if entry.goal is None else condition(task, entry.goal)
        found.append(NamedScenario(entry.name, goal, entry.human_plan, Fraction(entry.probability)))
    whole = close(1.0, sum((scenario.probability for scenario in found), Fraction(0)))
    return found, wording.GIVEN_PLANS, None if whole else "the probabilities do not add up to 1"


def _selection_fault(
    task: Task, result: Result, chosen: Sequence[NamedScenario], served: Sequence[GoalAnswer]
) -> str | None:
    """Whether the scenarios are those to consider, with their plans and probabilities."""
    names = [scenario.name for scenario in chosen]
    if names != [entry.name for entry in served]:
        return f"the scenarios to consider are {', '.join(names) or 'none'}"
    if len(set(names)) < len(names):
        return "two scenarios have one name"
    if not chosen:
        rightly = result.status == "infeasible" and result.plan is None
        return None if rightly else "no goal can be reached alone"
    for scenario, entry in zip(chosen, served, strict=True):
        if not close(entry.probability, scenario.probability):
            return f"scenario '{entry.name}': the probability is {float(scenario.probability):.12g}"
        if entry.goal is not None and condition(task, entry.goal) != scenario.goal:
            return f"scenario '{entry.name}': its goal is another one"
        if len(chosen) > 1 and entry.human_plan != scenario.plan:
            return f"scenario '{entry.name}': human_plan is not the optimal plan that is considered"
    if len(chosen) > 1:
        return _header_fault(task, result, chosen)
    seen = result.recognition is not None and result.recognition.observed and result.recognition.explained
    if (seen or result.options.ties == "watched") and result.human_plan != chosen[0].plan:
        return f"scenario '{served[0].name}': pi_H is not the optimal plan that is considered"
    return None


def _header_fault(task: Task, result: Result, chosen: Sequence[NamedScenario]) -> str | None:
    options = result.options
    if (result.mode, options.mode) != ("serendipity", "serendipity"):
        return "scenarios are for mode serendipity"
    known = options.ties in ("fixed", "watched") and options.human_model == "omniscient"
    if not known or options.max_cost is not None or options.head_start or task.robot_goal:
        return "other ties, human models, max_cost, head_start and robots' goals are for a single scenario"
    if options.waiting_cost:
        return "waiting_cost: waiting is free in all scenarios"
    if result.status not in ("optimal", "feasible") or result.plan is None:
        return "leaving the human alone is always an answer"
    longest = max(len(scenario.plan) for scenario in chosen)
    expected = longest if options.horizon is None else options.horizon
    if result.horizon != expected or longest > int(expected):
        return f"the horizon is {expected}, at least {longest}; the answer says {result.horizon}"
    if result.reason is not None:
        return f"status {result.status} with a reason"
    if result.window is not None or result.human_plan is not None or result.realised:
        return "windows, plans and verdicts belong to single scenarios"
    return None


def _nothing_fault(task: Task, result: Result) -> str | None:
    """Whether an answer that says that there is no plan says more than that."""
    own = (result.human_plan, result.human_cost, result.lower_bound, result.horizon)
    if own != (None, None, None, None):
        return "infeasible, with a plan, a cost, a bound or a horizon"
    case = CheckedResult(task, result, alone_of(task))
    found = mode_and_human(case) or status_and_fields(case) or reason(case)
    return None if found is None else found.message


def _entry_fault(result: Result, entry: GoalAnswer) -> str | None:
    """Whether the entry of the one scenario that is left is another answer."""
    same = (entry.human_plan, entry.cost, entry.window, entry.plan)
    answer = (result.human_plan, result.cost, result.window, result.plan)
    return None if same == answer else f"scenario '{entry.name}': the entry is not the answer"
