"""Findings about a grounded task: goals out of reach, and agents that have nothing to do with them."""

from collections import defaultdict
from collections.abc import Iterator, Sequence
from collections.abc import Set as AbstractSet

from serendipity.lint.report import Finding
from serendipity.model import Condition, Deadline, GroundAction, Task
from serendipity.model.task.script import moments

Fact = tuple[int, bool]
"""A fact, and whether it is true."""


def missing(goal: Condition, reached: AbstractSet[Fact]) -> tuple[Fact, ...]:
    """The literals of a goal that were not reached."""
    return tuple(literal for literal in _literals(goal) if literal not in reached)


def reachable(task: Task, actions: Sequence[GroundAction], deadline: Deadline) -> set[Fact]:
    """The literals that some of the actions make true beside the script, each by itself, and maybe more.

    Made true once, a literal stays so, beside its opposite; so what is not reached here can't
    be reached at all, and what is may still be out of reach.
    """
    reached = {(fact, fact in task.init) for fact in range(len(task.facts))}
    waiting: defaultdict[Fact, list[GroundAction]] = defaultdict(list)
    pending = list(moments(actions, task.script))
    while pending:
        deadline.tick()
        action = pending.pop()
        lacking = next((literal for literal in needs(action) if literal not in reached), None)
        if lacking is not None:
            waiting[lacking].append(action)
            continue
        for literal in _makes(action):
            if literal not in reached:
                reached.add(literal)
                pending += waiting.pop(literal, ())
    return reached


def relevant(task: Task, deadline: Deadline) -> list[bool]:
    """For each action whether it may contribute to a goal, the human's or the robots', or to bystanders."""
    makers: defaultdict[Fact, list[int]] = defaultdict(list)
    for i, action in enumerate(deadline.each(task.actions)):
        for literal in _makes(action):
            makers[literal].append(i)
    found = [False] * len(task.actions)
    pending = [*_literals(task.goal), *_literals(task.robot_goal)]
    pending += [literal for deed in task.script.deeds for one in deed.variants for literal in needs(one)]
    seen = set(pending)
    while pending:
        for i in deadline.each(makers.pop(pending.pop(), ())):
            if not found[i]:
                found[i] = True
                new = [literal for literal in needs(task.actions[i]) if literal not in seen]
                seen.update(new)
                pending += new
    return found


def _literals(goal: Condition) -> Iterator[Fact]:
    yield from ((fact, True) for fact in goal.positive)
    yield from ((fact, False) for fact in goal.negative)


def needs(action: GroundAction) -> Iterator[Fact]:
    """The literals that an action asks for, at any time of it."""
    for moment in action.moments:
        yield from _literals(moment.precondition)


def _makes(action: GroundAction) -> Iterator[Fact]:
    for moment in action.moments:
        yield from ((fact, True) for fact in moment.add)
        yield from ((fact, False) for fact in moment.delete)


_LISTED = 3


def task_findings(task: Task, deadline: Deadline) -> Iterator[Finding]:
    """All findings for which no file is needed."""
    for text in task.warnings:
        yield Finding("warning", "reading", text)
    yield from _goals(task, deadline)
    yield from _agents(task, deadline)


def _goals(task: Task, deadline: Deadline) -> Iterator[Finding]:
    human = task.agents[task.human]
    if not task.goal:
        yield Finding("warning", "goal-missing", f"{human} has no goal, so there is nothing to help with")
    elif task.goal.holds(task.init):
        yield Finding("warning", "goal-holds", f"{human}'s goal holds from the beginning")
    together = reachable(task, task.actions, deadline)
    for whose, goal in ((f"{human}'s goal", task.goal), ("the robots' goal", task.robot_goal)):
        never = missing(goal, together)
        if never:
            text = f"{whose} can't be reached by all agents together: {_listed(task, never)}"
            yield Finding("error", "goal-unreachable", text)
    if missing(task.goal, together):
        return
    own = [task.actions[i] for i in task.human_actions]
    alone = missing(task.goal, reachable(task, own, deadline))
    if alone:
        text = f"{human} can't reach the goal alone: {_listed(task, alone)}; there is no plan to preserve"
        yield Finding("warning", "goal-needs-help", text)


def _agents(task: Task, deadline: Deadline) -> Iterator[Finding]:
    matters = relevant(task, deadline)
    for agent, name in enumerate(task.agents):
        if agent in task.script.people:
            continue
        own = [i for i, action in enumerate(deadline.each(task.actions)) if agent in action.participants]
        if not own:
            yield Finding("warning", "agent-idle", f"{name} can do nothing")
        elif agent != task.human and (task.goal or task.robot_goal) and not any(matters[i] for i in own):
            yield Finding("warning", "agent-irrelevant", f"nothing that {name} can do matters for a goal")


def _listed(task: Task, literals: Sequence[Fact]) -> str:
    names = [task.facts[fact] if true else f"not {task.facts[fact]}" for fact, true in literals]
    return listed(names)


def listed(names: Sequence[str]) -> str:
    """Some names, and how many more there are."""
    more = f" and {len(names) - _LISTED} more" if len(names) > _LISTED else ""
    return ", ".join(names[:_LISTED]) + more
