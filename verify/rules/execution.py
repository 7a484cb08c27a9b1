"""Rules on the execution of a plan (semantics 1, 2)."""

from collections.abc import Callable

from verify.rules.case import Case, RuleFault

Rule = Callable[[Case], RuleFault | None]


def faultless(rule: str) -> Rule:
    """The rule that the replay met no fault of a kind."""

    def check(case: Case) -> RuleFault | None:
        fault = case.replay.fault
        if fault is None or fault.rule != rule:
            return None
        return RuleFault(fault.message, fault.epoch, fault.action)

    check.__doc__ = f"No step of the plan breaks '{rule}'."
    return check


def epoch_range(case: Case) -> RuleFault | None:
    """Epochs run from 1 to ``T``."""
    for step in case.result.plan or ():
        if step.epoch < 1 or (case.epochs is not None and step.epoch > case.epochs):
            return RuleFault(f"epochs run from 1 to {case.result.horizon}", step.epoch, step.action)
    return None


def at_rest(case: Case) -> RuleFault | None:
    """In the last state nobody is at anything, but for bystanders (semantics 10.1)."""
    if case.result.plan is None:
        return None
    for fact, variants in case.task.due_for.items():
        for ids in variants if fact in case.replay.last else ():
            if ids[0] not in case.task.of_bystanders:
                words = f"it does not end by T = {case.result.horizon}"
                return RuleFault(words, max(case.replay.sets, default=None), case.name(ids[0]))
    return None


def human_goal(case: Case) -> RuleFault | None:
    """``G_H`` holds in the last state."""
    if case.result.plan is None or case.task.goal.holds(case.replay.last):
        return None
    return RuleFault(f"the human's goal does not hold at the end: {_unmet(case, robots=False)}")


def robots_goal(case: Case) -> RuleFault | None:
    """``G_R`` holds in the last state; since robots then rest, they are done before ``xi2``."""
    if case.result.plan is None or not case.robots_goal or case.task.robot_goal.holds(case.replay.last):
        return None
    return RuleFault(f"the robots' goal does not hold at the end: {_unmet(case, robots=True)}")


def individual(case: Case) -> RuleFault | None:
    """In mode ``individual`` nobody but the human acts."""
    if case.result.mode == "individual":
        for epoch, i in case.steps():
            if not case.own(i):
                return RuleFault("not an action of the human alone", epoch, case.name(i))
    return None


def _unmet(case: Case, *, robots: bool) -> str:
    goal = case.task.robot_goal if robots else case.task.goal
    state = case.replay.last
    facts = case.task.facts
    unmet = [facts[f] for f in goal.positive if f not in state]
    unmet += [f"not {facts[f]}" for f in goal.negative if f in state]
    return ", ".join(unmet)
