"""Findings about a script: what changes nothing, what nobody minds, and bystanders who can't go on."""

from collections.abc import Iterator

from serendipity.lint.report import Finding
from serendipity.lint.task_rules import Fact, listed, needs, reachable, relevant
from serendipity.model import Deadline, Task, TimedFact, Timeline
from serendipity.model.task.plans_in_time import broken_script
from serendipity.model.task.script import moments


def script_findings(task: Task, deadline: Deadline) -> Iterator[Finding]:
    """All findings about the script of a task."""
    idle = [*_idle(task, deadline)]
    if idle:
        yield Finding("warning", "script-changes-nothing", f"the script changes nothing: {_told(task, idle)}")
    asked = _asked_for(task, deadline)
    unread = [one for one in task.script.facts if one.fact not in asked and one not in idle]
    if unread:
        text = f"the script changes what nobody asks for: {_told(task, unread)}"
        yield Finding("note", "script-never-matters", text)
    reached = reachable(task, task.actions, deadline)
    never = {
        deed.name: None
        for deed in task.script.deeds
        if all(any(one not in reached for one in needs(action)) for action in deed.variants)
    }
    if never:
        yield Finding("error", "bystander-impossible", f"bystanders can never do this: {listed([*never])}")
        return
    broken = broken_script(task)
    if broken is not None:
        text = f"unless others see to it, bystanders can't do what their plans say: {broken}"
        yield Finding("warning", "bystander-needs-help", text)


def _idle(task: Task, deadline: Deadline) -> Iterator[TimedFact]:
    """The changes that find a fact as they leave it, whatever else happens."""
    actions = [*task.actions, *(action for deed in task.script.deeds for action in deed.variants)]
    made: set[Fact] = set()
    for action in deadline.each(moments(actions, Timeline())):
        made.update((fact, True) for fact in action.add)
        made.update((fact, False) for fact in action.delete)
    now: dict[int, bool] = {}
    for one in deadline.each(task.script.facts):
        if now.get(one.fact, one.fact in task.init) == one.true and (one.fact, not one.true) not in made:
            yield one
        now[one.fact] = one.true


def _asked_for(task: Task, deadline: Deadline) -> set[int]:
    """The facts that goals, bystanders, or actions that may contribute to these ask for."""
    matters = relevant(task, deadline)
    actions = [action for action, kept in zip(task.actions, matters, strict=True) if kept]
    actions += [action for deed in task.script.deeds for action in deed.variants]
    found = {fact for action in deadline.each(actions) for fact, _ in needs(action)}
    for goal in (task.goal, task.robot_goal):
        found.update((*goal.positive, *goal.negative))
    return found


def _told(task: Task, changes: list[TimedFact]) -> str:
    names = [f"epoch {one.epoch} {'' if one.true else 'not '}{task.facts[one.fact]}" for one in changes]
    return listed(names)
