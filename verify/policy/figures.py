"""Whether the figures around a policy follow from it, and its bounds are written down (semantics 7)."""

from collections.abc import Iterator
from fractions import Fraction
from typing import Final

from serendipity.model import PlanError, Result, Task
from serendipity.model.answers.answer import PolicyBounds
from serendipity.model.answers.fields import MalformedError
from serendipity.model.numbers import agrees
from verify.policy.board import Board, Costs
from verify.rules.replay import replay_human

Fault = tuple[str, str]
"""The claim that is refuted, and why."""

_OF_ANSWERS: Final = ("human_plan", "human_cost", "saving", "saving_alone", "cost", "objective", "plan")
"""Fields that only an answer with a policy has, beside the policy."""


def stated_bounds(result: Result) -> PolicyBounds:
    """Both sides of the value, as the answer has them, or raise a MalformedError."""
    if result.bounds is None:
        missing = "statistics.bounds: expected an object with 'lower' and 'upper'"
        raise MalformedError(result.malformed.get("bounds", missing))
    return result.bounds


def least_sum(bounds: PolicyBounds) -> Fraction:
    """What both costs add up to at least, the human's being compared first."""
    tied = bounds.upper is not None and bounds.lower[0] == bounds.upper[0]
    return sum(bounds.lower, Fraction(0)) if tied else bounds.lower[0]


def header_faults(result: Result) -> Iterator[Fault]:
    """What does not belong to an answer of mode ``assistance``, or is missing, by its status."""
    if result.mode != result.options.mode:
        yield "replay", f"the mode is {result.mode}, but {result.options.mode} in the options"
    try:
        bounds = stated_bounds(result)
    except MalformedError as error:
        yield "replay", str(error)
        return
    if result.window is not None or result.horizon is not None or result.realised:
        yield "replay", "a window, a horizon or verdicts on humans, which this mode does not have"
    if result.status in ("optimal", "feasible"):
        if result.policy is None:
            yield "replay", f"status {result.status} without a policy"
        if result.reason is not None:
            yield "replay", f"status {result.status} with a reason"
        return
    if bounds.upper is not None:
        yield "replay", f"status {result.status}, but statistics.bounds.upper is there"
    there = next((name for name in (*_OF_ANSWERS, "policy") if getattr(result, name) is not None), None)
    if there is not None or result.agent_costs or result.opportunity:
        yield "replay", f"status {result.status} with {there or 'an answer'}"
    if result.status == "infeasible" and (result.reason, result.lower_bound) != ("no-plan", None):
        yield "replay", "infeasible: expected the reason 'no-plan', and no lower bound"


def answered(result: Result, value: Costs) -> Costs:
    """What the figures have to be: a policy's value, or no less where the human's optimum was unknown.

    A limit may come before that is worked out.  Doing nothing is worth no more than any plan of theirs then.
    """
    upper = stated_bounds(result).upper
    if not may_be_less(result) or upper is None or upper[1] != value[1]:
        return value
    return max(upper, value)


def may_be_less(result: Result) -> bool:
    """Whether an answer does nothing, and was given before the human's optimum was known."""
    idle = result.policy is not None and not result.policy.decisions
    return idle and result.status == "feasible" and result.human_plan is None and result.plan is None


def figure_faults(task: Task, board: Board, result: Result, value: Costs) -> Iterator[Fault]:
    """Whether every figure is what the policy's value and the human's own plan make it."""
    names = [task.agents[task.human], task.agents[task.robots[0]]]
    if list(result.agent_costs) != names or not all(map(agrees, result.agent_costs.values(), value)):
        words = ", ".join(f"{name} {float(cost):g}" for name, cost in zip(names, value, strict=True))
        yield "cost", f"agent_costs: expected {words}"
    total = sum(value, Fraction(0))
    for name in ("cost", "objective"):
        if not agrees(getattr(result, name), total):
            yield "cost", f"{name}: expected {float(total):g}, got {getattr(result, name)}"
    yield from _own_faults(task, board, result, value)
    yield from _bound_faults(result, value)


def _own_faults(task: Task, board: Board, result: Result, value: Costs) -> Iterator[Fault]:
    """``pi_H``, its cost, and what the human saves."""
    alone = board.alone(board.start)
    if result.human_plan is None:
        if alone is not None and result.status == "optimal":
            yield "replay", "no pi_H is reported, but the human has a plan alone"
        own = (result.human_cost, result.saving, result.saving_alone)
        if own != (None, None, None) or result.opportunity:
            yield "cost", "a saving, or the cost of a plan, but no pi_H"
        return
    try:
        cost = task.cost_of(replay_human(task, result.human_plan, board.deadline))
    except PlanError as error:
        yield "replay", f"pi_H: {error.message}"
        return
    if cost != alone:
        yield "replay", f"pi_H costs {float(cost):g}, which is not the human's least cost alone"
    saving = cost - value[0]
    expected = (cost, saving, Fraction(0))
    said = (result.human_cost, result.saving, result.saving_alone)
    if not all(map(agrees, said, expected)) or result.opportunity != (saving > 0):
        figures = "human_cost {:g}, saving {:g}, saving_alone {:g}".format(*map(float, expected))
        words = f"{figures}, opportunity {saving > 0}"
        yield "cost", f"expected {words.lower()}"


def _bound_faults(result: Result, value: Costs) -> Iterator[Fault]:
    bounds = stated_bounds(result)
    if bounds.upper != value:
        yield "cost", "statistics.bounds.upper is not the policy's value"
    if bounds.lower > value or (result.status == "optimal" and bounds.lower != value):
        yield "lower_bound", f"statistics.bounds.lower does not fit status {result.status}"
    if not agrees(result.lower_bound, least_sum(bounds)):
        yield "lower_bound", f"lower_bound: expected {float(least_sum(bounds)):g}, got {result.lower_bound}"
