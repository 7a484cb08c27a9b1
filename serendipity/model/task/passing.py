"""A task as it stands an epoch later: a task of its own, that is asked about like any other.

What is left of the script counts from there, and what has begun is part of it: whoever is at something goes
on with what is left of it, and nobody chooses anything about that, or pays for it again.
"""

from collections.abc import Iterable
from dataclasses import replace
from fractions import Fraction

from serendipity.model.task.actions import GroundAction
from serendipity.model.task.course import PlayedPlan
from serendipity.model.task.script import Deed, Timeline
from serendipity.model.task.task import Task


def epoch_later(task: Task, begun: Iterable[GroundAction], *, strict: bool = False) -> Task:
    """The task after an epoch.

    Args:
        task: the task.
        begun: what began in it, apart from the script.
        strict: whether interference is strict.

    Raises:
        BrokenPlanError: something can't begin, go on or end, or two actions are in each other's way.
    """
    course = PlayedPlan(task.facts, task.init, task.script, strict=strict)
    course.begin(begun)
    moved, script = task.at(course.state), task.script
    left = Timeline(
        tuple(replace(one, epoch=one.epoch - 1) for one in script.facts if one.epoch > 1),
        (
            *(replace(deed, epoch=deed.epoch - 1) for deed in script.deeds if deed.epoch > 1),
            *(Deed(1, doer(task, action), (_rest(action, epochs),)) for action, epochs in course.going),
        ),
        script.people,
    )
    return replace(moved, script=left, known_variables=moved.variables)


def at_work(task: Task) -> frozenset[int]:
    """Ids of those who can begin nothing in the epoch that is to come: they are at something, or will be."""
    deeds = task.script.begun(1)
    return frozenset(agent for deed in deeds for agent in deed.variants[0].participants)


def doer(task: Task, action: GroundAction) -> int:
    """Of those who take part in an action the human, if they do, else the first."""
    return task.human if task.human in action.participants else action.participants[0]


def _rest(action: GroundAction, epochs: int) -> GroundAction:
    """What is left of an action that takes some more epochs."""
    timing = action.timing
    assert timing is not None, "it takes several epochs"
    asked = [timing.over_all] if epochs > 1 else [timing.over_all, timing.at_end]
    return replace(
        action,
        pre=tuple(sorted({fact for one in asked for fact in one.positive})),
        neg=tuple(sorted({fact for one in asked for fact in one.negative})),
        cost=Fraction(0),
        timing=replace(timing, duration=epochs, start_add=(), start_delete=()) if epochs > 1 else None,
    )
