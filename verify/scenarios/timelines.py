"""Each scenario's timeline against the rules of section 3.1, and all of them together (semantics 11)."""

import math
from collections.abc import Container, Mapping, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from itertools import combinations
from types import MappingProxyType
from typing import Final, NamedTuple

from serendipity.model import Deadline, Result, Task
from serendipity.model.answers.result_parts import GoalAnswer
from serendipity.model.numbers import as_written, figure
from verify.base.beside_script import alone_of
from verify.base.due import waited
from verify.base.execution import grouped, unchosen
from verify.base.optimal_plans import OptimalPlans
from verify.rules.bound import bound_and_objective, bound_and_status
from verify.rules.case import CheckedResult
from verify.rules.leftovers import Prices
from verify.rules.registry import RULES
from verify.rules.report import Violation
from verify.scenarios.reading import weight
from verify.scenarios.suffixes import suffix_of

Figures = tuple[Fraction, Fraction]
"""Objective and cost."""

_OF_EACH: Final = (
    *("human-plan", "epoch-range", "unknown-action", "wrong-agents"),
    *("precondition", "agent-busy-twice", "conflict", "at-rest", "human-goal", "robots-goal"),
    *("step-cost", "cost", "window-range", "window-length", "joint-in-prefix", "prefix"),
    *("robot-in-suffix", "suffix-replan", "suffix-subplan", "preserved-state"),
)
"""Rules of section 3.1 that every timeline has to keep; figures of a whole answer are not its own."""


@dataclass(frozen=True, slots=True)
class ScenarioTimeline:
    """One scenario: its probability, and its own task and answer under examination.

    Attributes:
        original: by action of that task the one of the task that scenarios share; empty: the same.
        prices: of what is left changed.
        paid: for what is.
    """

    name: str
    weight: Fraction
    case: CheckedResult
    original: Sequence[int]
    prices: Prices
    paid: Fraction

    @property
    def task(self) -> Task:
        """The task with this scenario's goal."""
        return self.case.task

    @property
    def epochs(self) -> int:
        """Epochs of window that count: a plan that is left alone counts as one."""
        window = self.case.result.window
        return 1 if window is None else len(window)


class Aimed(NamedTuple):
    """A scenario's task, with what the human wants and what robots have to keep."""

    task: Task
    original: Sequence[int] = ()
    prices: Prices = MappingProxyType({})
    paid: Fraction = Fraction(0)


def timelines(
    aimed: Sequence[Aimed], result: Result, served: Sequence[GoalAnswer], deadline: Deadline
) -> list[ScenarioTimeline]:
    """The timelines of an answer, by what it says of each of them, with weights that add up to 1."""
    weights = [weight(entry.probability) for entry in served]
    total = sum(weights, Fraction(0))
    alone = {id(one.task): alone_of(one.task, deadline, result.options) for one in aimed}
    found = []
    for one, entry, share in zip(aimed, served, weights, strict=True):
        cost = None if entry.cost is None else figure(as_written(entry.cost) - one.paid)
        answer = replace(
            result,
            status="feasible",
            human_plan=entry.human_plan,
            window=entry.window,
            plan=entry.plan,
            cost=cost,
            objective=cost,
            ties=None,
            malformed={},
        )
        case = CheckedResult(one.task, answer, alone[id(one.task)])
        found.append(ScenarioTimeline(entry.name, share / total, case, *one[1:]))
    return found


def rule_fault(claim: str, lines: Sequence[ScenarioTimeline]) -> str | None:
    """The first rule that a timeline breaks, among those of one claim."""
    for line in lines:
        for rule in RULES:
            if rule.claim == claim and rule.name in _OF_EACH:
                found = rule.check(line.case)
                if found is not None:
                    broken = Violation(rule.name, claim, rule.section, *found)
                    return f"scenario '{line.name}': {broken}"
    return None


def lasting_fault(lines: Sequence[ScenarioTimeline]) -> str | None:
    """What each plan reaches lasts until ``T`` where robots are idle (semantics 10)."""
    for line in lines:
        task, plan, last = line.task, line.case.pi_h, int(line.case.result.horizon or 0)
        state = waited(task, task.init, last, strict=line.case.result.options.strict, plan=plan)
        if state is None or not task.goal.holds(state):
            return f"scenario '{line.name}': the plan does not last until T = {last}"
    return None


def suffix_fault(lines: Sequence[ScenarioTimeline]) -> str | None:
    """The suffix is the canonical one from the state that the window leaves."""
    for line in lines:
        case, window = line.case, line.case.result.window
        if window is None:
            continue
        plans = OptimalPlans(case.task, case.alone)
        suffix, _ = suffix_of(case.task, case.result.options, case.pi_h, plans)
        state, left = case.replay.state_after(window.end - 1), int(case.result.horizon or 0) + 1 - window.end
        rest = suffix(state, window.start, left)
        expected = {t: case.name(i) for t, i in enumerate(rest or (), window.end) if i not in case.waiting}
        done = {t: case.name(i) for t, i in case.human_does().items() if t >= window.end}
        if rest is None or done != expected:
            return f"scenario '{line.name}': from epoch {window.end} the human does not do the canonical plan"
    return None


def together_fault(result: Result, lines: Sequence[ScenarioTimeline]) -> str | None:
    """Robots act by what they have seen, and no plan that is left alone is broken (semantics 11)."""
    common = horizon = int(result.horizon or 0)
    watching = result.options.policy == "watching"
    goes_on = {lines[0].task.actions[i].name for i in unchosen(lines[0].task)}
    seen = [_begun(line.case.result, goes_on, by_human=True) for line in lines]
    own = [_begun(line.case.result, goes_on, by_human=False) for line in lines]
    for i, k in combinations(range(len(lines)), 2):
        differ = (t for t in range(1, horizon) if watching and seen[i].get(t) != seen[k].get(t))
        last = next(differ, horizon)
        epoch = next((t for t in range(1, last + 1) if own[i].get(t) != own[k].get(t)), None)
        if epoch is not None:
            names = f"'{lines[i].name}' and '{lines[k].name}'"
            return f"epoch {epoch}: robots do not do the same in {names}, which are not told apart"
        common = min(common, last)
    if _begun(result, goes_on, by_human=True):
        return "the plan is what robots do without the human"
    if _begun(result, goes_on, by_human=False) != {t: steps for t, steps in own[0].items() if t <= common}:
        return f"the plan is not what robots do by themselves up to epoch {common}, seeing no difference"
    for line in lines:
        case = line.case
        planned = {t: i for t, i in enumerate(case.pi_h, start=1) if i not in case.waiting}
        if case.result.window is None and case.human_does() != planned:
            return f"scenario '{line.name}': the plan is left alone, but the human does something else"
    return None


def _begun(
    result: Result, goes_on: Container[str], *, by_human: bool
) -> dict[int, list[tuple[str, list[str], float]]]:
    """What the human begins, which robots see, or what robots begin by themselves, by epoch."""
    chosen = (step for step in result.plan or () if step.action not in goes_on)
    steps = (step for step in chosen if (result.human in step.agents) is by_human)
    begun = grouped((step.epoch, (step.action, sorted(step.agents), step.cost)) for step in steps)
    return {epoch: sorted(steps) for epoch, steps in begun.items()}


# -- figures


def measured(
    risk: str, lines: Sequence[ScenarioTimeline], each: Sequence[Figures], floors: Sequence[Figures]
) -> Figures:
    """Objective and cost over scenarios of which each comes to so much.

    Args:
        risk: the mean, the greatest, or the greatest excess over the floors.
        floors: the least for each by itself; only regret asks for them.
    """
    if risk == "regret":
        return max((a - c, b - d) for (a, b), (c, d) in zip(each, floors, strict=True))
    if risk == "worst":
        return max(each)
    return mean(lines, [objective for objective, _ in each]), mean(lines, [cost for _, cost in each])


def answered(
    result: Result, lines: Sequence[ScenarioTimeline], floors: Sequence[Figures] = (), *, alone: bool = False
) -> Figures:
    """Objective and cost of the answer, or of leaving the human alone, which counts as one epoch."""
    window, each = result.options.window_weight, []
    for line in lines:
        cost, epochs = line.case.cost + line.paid, line.epochs
        if alone:
            cost, epochs = line.case.human_cost or Fraction(0), 1
        each.append((cost + window * epochs, cost))
    return measured(result.options.risk, lines, each, floors)


def figures_fault(result: Result, lines: Sequence[ScenarioTimeline]) -> str | None:
    """Whether a figure is wrong; those of regret need an optimiser, but for what follows from the others."""
    acting = any(not line.case.own(i) for line in lines for _, i in line.case.steps())
    if not result.opportunity and (acting or any(line.case.result.window for line in lines)):
        return "no opportunity, but robots act"
    if result.options.risk != "regret":
        fault = differing(result, figures(result, lines))
    else:
        saved = Fraction(result.human_cost or 0) - Fraction(result.cost or 0)
        fault = differing(result, {"saving": saved if result.opportunity else Fraction(0)})
    return fault or _shares_fault(result, lines)


def figures(
    result: Result, lines: Sequence[ScenarioTimeline], floors: Sequence[Figures] = ()
) -> dict[str, Fraction]:
    """The figures of an answer by its risk (semantics 11)."""
    objective, cost = answered(result, lines, floors)
    alone = answered(result, lines, floors, alone=True)[1]
    if not result.opportunity:
        return {"cost": cost, "human_cost": alone, "objective": cost, "saving": Fraction(0)}
    return {"cost": cost, "human_cost": alone, "objective": objective, "saving": alone - cost}


def differing(result: Result, expected: Mapping[str, Fraction], *, at_most: bool = False) -> str | None:
    """The first figure that is not as expected; ``at_most``: not even less than it is said to be.

    What is saved is the difference of two such figures then, as a rule has it.
    """
    kind = {"mean": "expected", "worst": "greatest"}.get(result.options.risk, "greatest regret's")
    for name, value in expected.items():
        said = getattr(result, name)
        more = at_most and said is not None and (name == "saving" or said >= value)
        if said is None or not (more or close(said, value)):
            return f"the {kind} {name} is {float(value):.12g}, the answer says {said}"
    return None


def _shares_fault(result: Result, lines: Sequence[ScenarioTimeline]) -> str | None:
    """What each agent pays is a mean, whatever the risk."""
    if result.agent_costs.keys() != set(lines[0].task.agents):
        return "agent_costs: expected one figure for each agent"
    paid = [line.case.shares for line in lines]
    for agent, said in result.agent_costs.items():
        share = mean(lines, [by_agent[agent] for by_agent in paid])
        if not close(said, share):
            return f"agent_costs of {agent} is {float(share):.12g}, the answer says {said:.12g}"
    return None


def bound_fault(result: Result, lines: Sequence[ScenarioTimeline]) -> str | None:
    """An optimum's bound is its objective, and no bound exceeds one."""
    whole = replace(lines[0].case, result=result)
    found = bound_and_status(whole) or bound_and_objective(whole)
    return None if found is None else found.message


def close(said: float, value: Fraction) -> bool:
    """Whether a float stands for a value that was summed from rounded probabilities."""
    return math.isclose(said, value, rel_tol=1e-14, abs_tol=1e-14)


def mean(lines: Sequence[ScenarioTimeline], values: Sequence[Fraction]) -> Fraction:
    """The expectation of a figure over the scenarios."""
    return sum((line.weight * value for line, value in zip(lines, values, strict=True)), Fraction(0))
