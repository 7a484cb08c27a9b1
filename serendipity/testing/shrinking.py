"""Greedy shrinking: leave out whatever the disagreement does not need."""

from collections.abc import Callable, Iterator
from dataclasses import replace
from fractions import Fraction

from serendipity.model import Condition, GroundAction, Task
from serendipity.testing.generator.calls import PlanCall
from serendipity.testing.generator.tasks import unambiguous


def shrink(call: PlanCall, disagrees: Callable[[PlanCall], bool], *, most: int = 2000) -> PlanCall:
    """The smallest call reached by leaving out one thing at a time while judges still differ.

    Args:
        call: a call on which ``disagrees`` is true.
        disagrees: whether the judges differ.
        most: calls that are tried at most.
    """
    tried = 0
    progress = True
    while progress and tried < most:
        progress = False
        for smaller in _smaller(call):
            tried += 1
            if tried > most:
                break
            if disagrees(smaller):
                call, progress = smaller, True
                break
    return call


def _smaller(call: PlanCall) -> Iterator[PlanCall]:
    for name in call.options:
        if name != "mode":
            yield replace(call, options={key: value for key, value in call.options.items() if key != name})
    if call.human_plan is not None:
        yield replace(call, human_plan=None)
    for task in filter(unambiguous, _smaller_tasks(call.task)):
        yield replace(call, task=task)


def _smaller_tasks(task: Task) -> Iterator[Task]:
    for i in range(len(task.actions)):
        yield replace(task, actions=task.actions[:i] + task.actions[i + 1 :])
    for f in sorted(task.init):
        yield replace(task, init=task.init - {f})
    for goal in _smaller_conditions(task.goal):
        yield replace(task, goal=goal)
    for goal in _smaller_conditions(task.robot_goal):
        yield replace(task, robot_goal=goal)
    for i, action in enumerate(task.actions):
        variants = len(task.named[action.name]) > 1  # whose effects are those of one PDDL action
        for name in ("pre", "neg") if variants else ("pre", "neg", "add", "delete"):
            facts = getattr(action, name)
            for f in facts:
                less = replace(action, **{name: tuple(g for g in facts if g != f)})  # type: ignore[arg-type]
                if any((less.pre, less.neg, less.add, less.delete)):  # else it would be a noop
                    yield _with_action(task, i, less)
    for i, action in enumerate(task.actions):
        if action.cost not in (0, 1):
            yield _with_action(task, i, replace(action, cost=Fraction(1)))
    yield from _without_idle_robots(task)


def _with_action(task: Task, i: int, action: GroundAction) -> Task:
    return replace(task, actions=(*task.actions[:i], action, *task.actions[i + 1 :]))


def _without_idle_robots(task: Task) -> Iterator[Task]:
    """The task without one of the robots that can do nothing; one robot there has to be."""
    busy = {agent for action in task.actions for agent in action.participants}
    for robot in task.robots:
        if robot not in busy and len(task.robots) > 1:
            agents = tuple(name for agent, name in enumerate(task.agents) if agent != robot)
            actions = tuple(
                replace(action, participants=tuple(who - (who > robot) for who in action.participants))
                for action in task.actions
            )
            yield replace(task, agents=agents, human=task.human - (task.human > robot), actions=actions)


def _smaller_conditions(condition: Condition) -> Iterator[Condition]:
    for f in condition.positive:
        yield Condition(tuple(g for g in condition.positive if g != f), condition.negative)
    for f in condition.negative:
        yield Condition(condition.positive, tuple(g for g in condition.negative if g != f))
