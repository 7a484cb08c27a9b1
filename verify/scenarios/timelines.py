"""Each scenario's timeline against the rules of section 3.1, and all of them together (semantics 11)."""

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from itertools import combinations
from typing import Final

from serendipity.model import Condition, Deadline, PlanStep, Result, Task
from serendipity.model.answers.result_parts import GoalAnswer
from verify.base.individual import IndividualOptimum
from verify.base.optimal_plans import OptimalPlans
from verify.rules.case import Case
from verify.rules.registry import RULES
from verify.scenarios.reading import weight

Figures = tuple[Fraction, Fraction]
"""Objective and cost."""

_BY_CLAIM: Final = {
    "replay": (
        "human-plan",
        "epoch-range",
        "unknown-action",
        "wrong-agents",
        "precondition",
        "agent-busy-twice",
        "conflict",
        "human-goal",
    ),
    "cost": ("step-cost", "cost"),
    "window": (
        "window-range",
        "window-length",
        "joint-in-prefix",
        "prefix",
        "robot-in-suffix",
        "suffix-replan",
        "suffix-subplan",
        "preserved-state",
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

    def theirs(self, last: int) -> dict[int, tuple[str, ...]]:
        """What robots do by themselves up to an epoch, by epoch."""
        done: dict[int, list[str]] = {}
        for epoch, i in self.case.steps():
            if epoch <= last and not self.case.his(i):
                done.setdefault(epoch, []).append(self.case.name(i))
        return {epoch: tuple(sorted(names)) for epoch, names in done.items()}

    def seen(self) -> dict[int, tuple[str, tuple[int, ...]]]:
        """What robots see of the human, by epoch; where they wait there is none."""
        actions = self.task.actions
        return {t: (actions[i].name, actions[i].participants) for t, i in self.case.human_does().items()}


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
    """Where the suffix is replanned it is the canonical plan from the state that the window leaves."""
    for line in lines:
        case, window = line.case, line.case.result.window
        if window is None or case.result.options.suffix != "replan":
            continue
        if case.result.options.preservation != "kernel":
            continue
        plans = OptimalPlans(case.task, case.alone).plans(case.replay.state_after(window.end - 1))
        expected = [case.name(i) for i in next(plans, ())]
        done = [case.name(i) for epoch, i in sorted(case.human_does().items()) if epoch >= window.end]
        if done != expected:
            return f"scenario '{line.name}': from epoch {window.end} the human does not do the canonical plan"
    return None


def together_fault(result: Result, lines: Sequence[Timeline]) -> str | None:
    """Robots act by what they have seen, and no plan that is left alone is broken (semantics 11)."""
    horizon = int(result.horizon or 0)
    common = horizon
    for one, other in combinations(lines, 2):
        last = horizon if result.options.policy == "fixed" else _alike_until(one, other, horizon)
        common = min(common, last)
        mine, yours = one.theirs(last), other.theirs(last)
        epoch = next((t for t in range(1, last + 1) if mine.get(t) != yours.get(t)), None)
        if epoch is not None:
            names = f"'{one.name}' and '{other.name}'"
            return f"epoch {epoch}: robots do not do the same in {names}, which are not told apart"
    return _first_part_fault(result, lines[0], common) or next(_deviations(lines), None)


def _alike_until(one: Timeline, other: Timeline, horizon: int) -> int:
    """The last epoch in which two scenarios are not told apart: the human does something different in it."""
    mine, yours = one.seen(), other.seen()
    return next((t for t in range(1, horizon) if mine.get(t) != yours.get(t)), horizon)


def _first_part_fault(result: Result, line: Timeline, last: int) -> str | None:
    """The plan of the whole is what robots do by themselves until they see a difference."""
    for step in result.plan or ():
        if result.human in step.agents:
            return f"epoch {step.epoch}: '{step.action}': the plan is what robots do without the human"
    common = [s for s in line.case.result.plan or () if s.epoch <= last and result.human not in s.agents]
    if sorted(map(_as_key, common)) != sorted(map(_as_key, result.plan or ())):
        return f"the plan is not what robots do by themselves up to epoch {last}, seeing no difference"
    return None


def _as_key(step: PlanStep) -> tuple[int, str, tuple[str, ...], float]:
    return step.epoch, step.action, tuple(sorted(step.agents)), step.cost


def _deviations(lines: Sequence[Timeline]) -> Iterator[str]:
    """Where a plan is said to be left alone, the human executes it."""
    for line in lines:
        case = line.case
        if case.result.window is None and case.human_does() != dict(enumerate(case.pi_h, start=1)):
            yield f"scenario '{line.name}': the plan is left alone, but the human does something else"


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


def answered(result: Result, lines: Sequence[Timeline], floors: Sequence[Figures] = ()) -> Figures:
    """Objective and cost of the answer; a plan that is left alone counts as one epoch of window."""
    window = result.options.window_weight
    each = [(line.case.cost + window * line.epochs, line.case.cost) for line in lines]
    return measured(result.options.risk, lines, each, floors)


def figures_fault(result: Result, lines: Sequence[Timeline]) -> str | None:
    """Whether a figure is wrong; those of regret need an optimiser, but for what follows from the others."""
    if not result.opportunity and (result.plan or any(line.case.result.window for line in lines)):
        return "no opportunity, but robots act"
    expected = _saving(result) if result.options.risk == "regret" else figures(result, lines)
    return differing(result, expected) or _shares_fault(result, lines)


def figures(
    result: Result, lines: Sequence[Timeline], floors: Sequence[Figures] = ()
) -> Mapping[str, Fraction]:
    """The figures of an answer by its risk (semantics 11)."""
    window = result.options.window_weight
    objective, cost = answered(result, lines, floors)
    left = [(line.alone + window, line.alone) for line in lines]
    alone = measured(result.options.risk, lines, left, floors)[1]
    return {
        "cost": cost,
        "human_cost": alone,
        "objective": objective if result.opportunity else cost,
        "saving": alone - cost if result.opportunity else Fraction(0),
    }


def differing(result: Result, expected: Mapping[str, Fraction], *, at_most: bool = False) -> str | None:
    """The first figure that is not as expected; ``at_most``: not even less than it is said to be."""
    kind = {"mean": "expected", "worst": "greatest"}.get(result.options.risk, "greatest regret's")
    for name, value in expected.items():
        said = getattr(result, name)
        more = at_most and name != "saving" and said is not None and said >= value
        if said is None or not (more or close(said, value)):
            return f"the {kind} {name} is {float(value):.12g}, the answer says {said}"
    return None


def _saving(result: Result) -> Mapping[str, Fraction]:
    known = result.human_cost is not None and result.cost is not None and result.opportunity
    return {"saving": Fraction(result.human_cost or 0) - Fraction(result.cost or 0) if known else Fraction(0)}


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
