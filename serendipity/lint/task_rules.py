"""Findings about a grounded task: goals, and agents that have nothing to do with them."""

from collections.abc import Iterator, Sequence

from serendipity.lint.reach import Fact, missing, reachable, relevant
from serendipity.lint.report import Finding
from serendipity.model import Deadline, Task

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
