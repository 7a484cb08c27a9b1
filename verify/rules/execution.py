"""Rules on the execution of a plan (semantics 1, 2)."""

from collections.abc import Callable

from serendipity.model import Condition
from verify.rules.case import CheckedResult, RuleFault

Rule = Callable[[CheckedResult], RuleFault | None]


def faultless(rule: str) -> Rule:
    """The rule that the replay met no fault of a kind."""

    def check(case: CheckedResult) -> RuleFault | None:
        fault = case.replay.fault
        if fault is None or fault.rule != rule:
            return None
        return RuleFault(fault.message, fault.epoch, fault.action)

    check.__doc__ = f"No step of the plan breaks '{rule}'."
    return check


def epoch_range(case: CheckedResult) -> RuleFault | None:
    """Epochs run from 1 to ``T``."""
    for step in case.result.plan or ():
        if step.epoch < 1 or (case.epochs is not None and step.epoch > case.epochs):
            return RuleFault(f"epochs run from 1 to {case.result.horizon}", step.epoch, step.action)
    return None


def at_rest(case: CheckedResult) -> RuleFault | None:
    """In the last state nobody is at anything, but for bystanders (semantics 10.1)."""
    if case.result.plan is None:
        return None
    for fact, variants in case.task.due_for.items():
        for ids in variants if fact in case.replay.last else ():
            if ids[0] not in case.task.of_bystanders:
                words = f"it does not end by T = {case.result.horizon}"
                return RuleFault(words, max(case.replay.sets, default=None), case.name(ids[0]))
    return None


def human_goal(case: CheckedResult) -> RuleFault | None:
    """``G_H`` holds in the last state."""
    return _unmet(case, case.task.goal, "human's")


def robots_goal(case: CheckedResult) -> RuleFault | None:
    """``G_R`` holds in the last state; since robots then rest, they are done before ``xi2``."""
    return _unmet(case, case.task.robot_goal, "robots'") if case.robots_goal else None


def individual(case: CheckedResult) -> RuleFault | None:
    """In mode ``individual`` nobody but the human acts."""
    if case.result.mode != "individual":
        return None
    return case.first(case.steps(), lambda i: not case.own(i), "not an action of the human alone")


def _unmet(case: CheckedResult, goal: Condition, whose: str) -> RuleFault | None:
    if case.result.plan is None or goal.holds(case.replay.last):
        return None
    unmet, facts = goal.open(case.replay.last), case.task.facts
    literals = [*(facts[f] for f in unmet.positive), *(f"not {facts[f]}" for f in unmet.negative)]
    return RuleFault(f"the {whose} goal does not hold at the end: {', '.join(literals)}")
