"""Each goal's timeline against the rules of section 3.1, and all of them together (semantics 8)."""

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from typing import Final

from serendipity.model import Condition, Deadline, PlanStep, Result, Task
from serendipity.model.answers.result_parts import GoalAnswer
from verify.base.individual import IndividualOptimum
from verify.goals.reading import weight
from verify.rules.case import Case
from verify.rules.registry import RULES

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
class GoalTimeline:
    """One considered goal: its probability, and its own task and answer under examination."""

    name: str
    weight: Fraction
    case: Case

    @property
    def task(self) -> Task:
        """The task with this goal."""
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
) -> list[GoalTimeline]:
    """The timelines of an answer, with weights that add up to 1.

    Args:
        task: the task.
        result: the answer for several goals.
        goals: the goals themselves.
        served: what the answer says of each of them, in the same order.
        deadline: polled.
    """
    weights = [weight(entry.probability) for entry in served]
    total = sum(weights, Fraction(0))
    found = []
    for goal, entry, share in zip(goals, served, weights, strict=True):
        own = task.with_goal(goal, Condition())
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
        found.append(
            GoalTimeline(entry.name, share / total, Case(own, answer, IndividualOptimum(own, deadline)))
        )
    return found


def rule_fault(claim: str, lines: Sequence[GoalTimeline]) -> str | None:
    """The first rule that a timeline breaks, among those of one claim."""
    for line in lines:
        for rule in RULES:
            if rule.name in _BY_CLAIM[claim] and not (line.case.result.window is None and claim == "window"):
                found = rule.check(line.case)
                if found is not None:
                    place = "" if found.epoch is None else f"epoch {found.epoch}: "
                    what = "" if found.action is None else f"'{found.action}': "
                    broken = f"{rule.name} (semantics {rule.section})"
                    return f"goal '{line.name}': {broken}: {place}{what}{found.message}"
    return None


def together_fault(result: Result, lines: Sequence[GoalTimeline]) -> str | None:
    """Robots do the same whatever the goal is, and no considered plan is broken (semantics 8)."""
    human = result.human
    for step in result.plan or ():
        if human in step.agents:
            return f"epoch {step.epoch}: '{step.action}': the plan is what robots do without the human"
    for line in lines:
        theirs = [step for step in line.case.result.plan or () if human not in step.agents]
        if sorted(map(_as_key, theirs)) != sorted(map(_as_key, result.plan or ())):
            return f"goal '{line.name}': robots do something else than in the plan for all goals"
    return next(_deviations(lines), None)


def _as_key(step: PlanStep) -> tuple[int, str, tuple[str, ...], float]:
    return step.epoch, step.action, tuple(sorted(step.agents)), step.cost


def _deviations(lines: Sequence[GoalTimeline]) -> Iterator[str]:
    """Where a plan is said to be left alone, the human executes it."""
    for line in lines:
        case = line.case
        if case.result.window is None and case.human_does() != dict(enumerate(case.pi_h, start=1)):
            yield f"goal '{line.name}': the plan is left alone, but the human does something else"


def figures_fault(result: Result, lines: Sequence[GoalTimeline]) -> str | None:
    """Expectations are sums over the goals; without an opportunity robots idle (semantics 8)."""
    cost = mean(lines, [line.case.cost for line in lines])
    alone = mean(lines, [line.alone for line in lines])
    epochs = mean(lines, [Fraction(line.epochs) for line in lines])
    objective = cost + result.options.window_weight * epochs if result.opportunity else cost
    expected = {
        "cost": cost,
        "human_cost": alone,
        "objective": objective,
        "saving": alone - cost if result.opportunity else Fraction(0),
    }
    for name, value in expected.items():
        said = getattr(result, name)
        if said is None or not close(said, value):
            return f"the expected {name} is {float(value):.12g}, the answer says {said}"
    if not result.opportunity and (result.plan or any(line.case.result.window for line in lines)):
        return "no opportunity, but robots act"
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


def mean(lines: Sequence[GoalTimeline], values: Sequence[Fraction]) -> Fraction:
    """The expectation of a figure over the goals."""
    return sum((line.weight * value for line, value in zip(lines, values, strict=True)), Fraction(0))
