"""Each scenario's timeline against the rules of section 3.1, and all of them together (semantics 11)."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from itertools import combinations
from typing import Final

from serendipity.model import Condition, Deadline, Result, Task
from serendipity.model.answers.result_parts import GoalAnswer
from verify.base.individual import IndividualOptimum
from verify.base.optimal_plans import OptimalPlans
from verify.rules.case import Case
from verify.rules.registry import RULES
from verify.scenarios.reading import weight
from verify.scenarios.suffixes import planned, suffix_of

Figures = tuple[Fraction, Fraction]
"""Objective and cost."""

_BY_CLAIM: Final = {
    "replay": (
        *("human-plan", "epoch-range", "unknown-action", "wrong-agents"),
        *("precondition", "agent-busy-twice", "conflict", "human-goal"),
    ),
    "cost": ("step-cost", "cost"),
    "window": (
        *("window-range", "window-length", "joint-in-prefix", "prefix"),
        *("robot-in-suffix", "suffix-replan", "suffix-subplan", "preserved-state"),
    ),
}
"""Rules of section 3.1 that every timeline has to keep; figures of a whole answer are not its own."""


@dataclass(frozen=True, slots=True)
class Timeline:
    """One scenario: its probability, and its own task and answer under examination."""

    name: str
    weight: Fraction
    case: Case

    @property
    def task(self) -> Task:
        """The task with this scenario's goal."""
        return self.case.task

    @property
    def alone(self) -> Fraction:
        """What the human's plan costs them."""
        assert self.case.human_cost is not None, "a rule"
        return self.case.human_cost

    @property
    def epochs(self) -> int:
        """Epochs of window that count: a plan that is left alone counts as one."""
        window = self.case.result.window
        return 1 if window is None else len(window)


def timelines(
    task: Task, result: Result, goals: Sequence[Condition], served: Sequence[GoalAnswer], deadline: Deadline
) -> list[Timeline]:
    """The timelines of an answer, with weights that add up to 1.

    Args:
        task: the task.
        result: the answer over scenarios.
        goals: what the human wants in each of them.
        served: what the answer says of each of them, in the same order.
        deadline: polled.
    """
    weights = [weight(entry.probability) for entry in served]
    total = sum(weights, Fraction(0))
    tasks = {goal: task.with_goal(goal, Condition()) for goal in goals}
    alone = {goal: IndividualOptimum(own, deadline) for goal, own in tasks.items()}
    found = []
    for goal, entry, share in zip(goals, served, weights, strict=True):
        answer = replace(
            result,
            status="feasible",
            human_plan=entry.human_plan,
            window=entry.window,
            plan=entry.plan,
            cost=entry.cost,
            objective=entry.cost,
            ties=None,
            malformed={},
        )
        found.append(Timeline(entry.name, share / total, Case(tasks[goal], answer, alone[goal])))
    return found


def rule_fault(claim: str, lines: Sequence[Timeline]) -> str | None:
    """The first rule that a timeline breaks, among those of one claim."""
    for line in lines:
        for rule in RULES:
            if rule.name in _BY_CLAIM[claim] and not (line.case.result.window is None and claim == "window"):
                found = rule.check(line.case)
                if found is not None:
                    place = "" if found.epoch is None else f"epoch {found.epoch}: "
                    what = "" if found.action is None else f"'{found.action}': "
                    broken = f"{rule.name} (semantics {rule.section})"
                    return f"scenario '{line.name}': {broken}: {place}{what}{found.message}"
    return None


def suffix_fault(lines: Sequence[Timeline]) -> str | None:
    """The suffix is the canonical one from the state that the window leaves."""
    for line in lines:
        case, window = line.case, line.case.result.window
        if window is None:
            continue
        plans = OptimalPlans(case.task, case.alone)
        suffix = suffix_of(case.task, case.result.options, case.pi_h, plans)
        state, left = case.replay.state_after(window.end - 1), int(case.result.horizon or 0) + 1 - window.end
        done = [case.name(i) for epoch, i in sorted(case.human_does().items()) if epoch >= window.end]
        if done != planned(case.task, suffix, state, window.start, left):
            return f"scenario '{line.name}': from epoch {window.end} the human does not do the canonical plan"
    return None


def together_fault(result: Result, lines: Sequence[Timeline]) -> str | None:
    """Robots act by what they have seen, and no plan that is left alone is broken (semantics 11)."""
    common = horizon = int(result.horizon or 0)
    watching = result.options.policy == "watching"
    seen = [_done(line.case.result, by_human=True) for line in lines]
    own = [_done(line.case.result, by_human=False) for line in lines]
    for i, k in combinations(range(len(lines)), 2):
        differ = (t for t in range(1, horizon) if watching and seen[i].get(t) != seen[k].get(t))
        last = next(differ, horizon)
        epoch = next((t for t in range(1, last + 1) if own[i].get(t) != own[k].get(t)), None)
        if epoch is not None:
            names = f"'{lines[i].name}' and '{lines[k].name}'"
            return f"epoch {epoch}: robots do not do the same in {names}, which are not told apart"
        common = min(common, last)
    if _done(result, by_human=True):
        return "the plan is what robots do without the human"
    if _done(result, by_human=False) != {t: steps for t, steps in own[0].items() if t <= common}:
        return f"the plan is not what robots do by themselves up to epoch {common}, seeing no difference"
    for line in lines:
        case = line.case
        if case.result.window is None and case.human_does() != dict(enumerate(case.pi_h, start=1)):
            return f"scenario '{line.name}': the plan is left alone, but the human does something else"
    return None


def _done(result: Result, *, by_human: bool) -> dict[int, list[tuple[str, list[str], float]]]:
    """What the human takes part in, which robots see, or what robots do by themselves, by epoch."""
    done: dict[int, list[tuple[str, list[str], float]]] = {}
    for step in result.plan or ():
        if (result.human in step.agents) is by_human:
            done.setdefault(step.epoch, []).append((step.action, sorted(step.agents), step.cost))
    return {epoch: sorted(steps) for epoch, steps in done.items()}


# -- figures


def measured(
    risk: str, lines: Sequence[Timeline], each: Sequence[Figures], floors: Sequence[Figures]
) -> Figures:
    """Objective and cost over scenarios of which each comes to so much.

    Args:
        risk: the mean, the greatest, or the greatest excess over the floors.
        lines: the scenarios.
        each: objective and cost of each.
        floors: the least for each by itself; only regret asks for them.
    """
    if risk == "regret":
        return max((a - c, b - d) for (a, b), (c, d) in zip(each, floors, strict=True))
    if risk == "worst":
        return max(each)
    return mean(lines, [objective for objective, _ in each]), mean(lines, [cost for _, cost in each])


def answered(
    result: Result, lines: Sequence[Timeline], floors: Sequence[Figures] = (), *, alone: bool = False
) -> Figures:
    """Objective and cost of the answer, or of leaving the human alone, which counts as one epoch."""
    window, each = result.options.window_weight, []
    for line in lines:
        cost, epochs = (line.alone, 1) if alone else (line.case.cost, line.epochs)
        each.append((cost + window * epochs, cost))
    return measured(result.options.risk, lines, each, floors)


def figures_fault(result: Result, lines: Sequence[Timeline]) -> str | None:
    """Whether a figure is wrong; those of regret need an optimiser, but for what follows from the others."""
    answers = [line.case.result for line in lines]
    acting = any(step.agents != (result.human,) for answer in answers for step in answer.plan or ())
    if not result.opportunity and (acting or any(answer.window for answer in answers)):
        return "no opportunity, but robots act"
    if result.options.risk != "regret":
        fault = differing(result, figures(result, lines))
    else:
        saved = Fraction(result.human_cost or 0) - Fraction(result.cost or 0)
        fault = differing(result, {"saving": saved if result.opportunity else Fraction(0)})
    return fault or _shares_fault(result, lines)


def figures(result: Result, lines: Sequence[Timeline], floors: Sequence[Figures] = ()) -> dict[str, Fraction]:
    """The figures of an answer by its risk (semantics 11)."""
    objective, cost = answered(result, lines, floors)
    alone = answered(result, lines, floors, alone=True)[1]
    if not result.opportunity:
        return {"cost": cost, "human_cost": alone, "objective": cost, "saving": Fraction(0)}
    return {"cost": cost, "human_cost": alone, "objective": objective, "saving": alone - cost}


def differing(result: Result, expected: Mapping[str, Fraction], *, at_most: bool = False) -> str | None:
    """The first figure that is not as expected; ``at_most``: not even less than it is said to be."""
    kind = {"mean": "expected", "worst": "greatest"}.get(result.options.risk, "greatest regret's")
    for name, value in expected.items():
        said = getattr(result, name)
        more = at_most and name != "saving" and said is not None and said >= value
        if said is None or not (more or close(said, value)):
            return f"the {kind} {name} is {float(value):.12g}, the answer says {said}"
    return None


def _shares_fault(result: Result, lines: Sequence[Timeline]) -> str | None:
    """What each agent pays is a mean, whatever the risk."""
    if result.agent_costs.keys() != set(lines[0].task.agents):
        return "agent_costs: expected one figure for each agent"
    paid = [line.case.shares for line in lines]
    for agent, said in result.agent_costs.items():
        share = mean(lines, [by_agent[agent] for by_agent in paid])
        if not close(said, share):
            return f"agent_costs of {agent} is {float(share):.12g}, the answer says {said:.12g}"
    return None


def bound_fault(result: Result) -> str | None:
    """An optimum's bound is its objective, and no bound exceeds one."""
    bound, objective = result.lower_bound, result.objective
    if bound is None or objective is None:
        return "an answer has an objective and a lower bound"
    if result.status == "optimal" and bound != objective:
        return f"optimal, but lower_bound is {bound} and the objective {objective}"
    return f"lower_bound {bound:.12g} exceeds the objective {objective:.12g}" if bound > objective else None


def close(said: float, value: Fraction) -> bool:
    """Whether a float stands for a value that was summed from rounded probabilities."""
    return math.isclose(said, value, rel_tol=1e-14, abs_tol=1e-14)


def mean(lines: Sequence[Timeline], values: Sequence[Fraction]) -> Fraction:
    """The expectation of a figure over the scenarios."""
    return sum((line.weight * value for line, value in zip(lines, values, strict=True)), Fraction(0))
