"""A task as it stands an epoch later: a task of its own, that is asked about like any other.

What is left of the script counts from there, and what has begun is part of it: whoever is at something goes
on with what is left of it, and nobody chooses anything about that, or pays for it again.
"""

from collections.abc import Callable, Iterable, Mapping
from collections.abc import Set as AbstractSet
from dataclasses import replace
from fractions import Fraction
from itertools import chain
from typing import Any

from serendipity.model.task.actions import GroundAction
from serendipity.model.task.course import PlayedPlan, SupposedPlan
from serendipity.model.task.script import Deed, Timeline
from serendipity.model.task.task import Task


def epoch_later(task: Task, begun: Iterable[GroundAction], *, strict: bool = False) -> Task:
    """The task after an epoch.

    Args:
        begun: what began in it, apart from the script.

    Raises:
        BrokenPlanError: something can't begin, go on or end, or two actions are in each other's way.
    """
    return _passed(task, PlayedPlan(task.facts, task.init, task.script, strict=strict), begun)


def supposed_later(task: Task, begun: Iterable[GroundAction]) -> Task:
    """The same for a task as somebody believes it to stand, who may be wrong about what goes on."""
    return _passed(task, SupposedPlan(task.facts, task.init, task.script), begun)


def as_seen(believed: Task, now: Task, facts: Callable[[int], bool], agents: AbstractSet[int]) -> Task:
    """The task as somebody believes it to stand after a look (semantics 10.6).

    Args:
        believed: before it.
        now: as it truly stands.
        facts: whether they see a fact.
        agents: ids of those whom they see, and themselves.
    """
    known = now.script.people | agents
    work = [(deed, frozenset(deed.variants[0].participants)) for deed in now.script.begun(1)]
    shown = known.union(*(who for _, who in work if not who.isdisjoint(known)))
    others = believed.script.begun(1)
    kept = (deed for deed in others if shown.isdisjoint(deed.variants[0].participants))
    true = (deed for deed, who in work if not who.isdisjoint(shown))
    later = (deed for deed in now.script.deeds if deed.epoch > 1)
    state = believed.init ^ frozenset(fact for fact in believed.init ^ now.init if facts(fact))
    script = replace(now.script, deeds=(*later, *true, *kept))
    return replace(now.at(state), script=script, known_variables=now.variables)


def _passed(task: Task, course: PlayedPlan, begun: Iterable[GroundAction]) -> Task:
    course.begin(begun)
    going = (Deed(1, doer(task, action), (_rest(action, epochs),)) for action, epochs in course.going)
    moved = task.at(course.state)
    return replace(moved, script=_left(task.script, 1, going), known_variables=moved.variables)


def _left(script: Timeline, passed: int, going: Iterable[Deed] = ()) -> Timeline:
    """What is left of a script after some epochs, and what has begun in them."""
    facts = tuple(replace(one, epoch=one.epoch - passed) for one in script.facts if one.epoch > passed)
    deeds = (replace(deed, epoch=deed.epoch - passed) for deed in script.deeds if deed.epoch > passed)
    return Timeline(facts, (*deeds, *going), script.people)


def going_on(begun: Task, passed: int, now: Task) -> list[dict[str, Any]]:
    """What goes on in a task as it stands some epochs later, as plain values for :func:`taken_up`."""
    known = {(deed.agent, deed.variants) for deed in _left(begun.script, passed).begun(1)}
    rests = [deed.variants[0] for deed in now.script.begun(1) if (deed.agent, deed.variants) not in known]
    return [
        {
            "action": rest.name,
            "agents": [begun.agents[i] for i in rest.participants],
            "variant": [_rest(one, rest.duration) for one in _alike(begun, rest)].index(rest),
            "epochs": rest.duration,
        }
        for rest in rests
    ]


def taken_up(begun: Task, passed: int, going: Iterable[Mapping[str, Any]]) -> Task:
    """A task some epochs later, still in its first state: what is left of its script, and what goes on.

    Raises:
        IndexError, KeyError, TypeError, ValueError: that is not what :func:`going_on` has told of it.
    """
    deeds = list[Deed]()
    for one in going:
        agents = tuple(sorted(begun.agents.index(name) for name in one["agents"]))
        like = GroundAction(one["action"], agents, (), (), (), ())
        alike, variant, epochs = _alike(begun, like), one["variant"], one["epochs"]
        whole = all(isinstance(number, int) for number in (variant, epochs))
        if not whole or variant not in range(len(alike)) or epochs not in range(1, alike[variant].duration):
            raise ValueError("there is nothing of the kind to go on with")
        deeds.append(Deed(1, doer(begun, alike[variant]), (_rest(alike[variant], epochs),)))
    return replace(begun, script=_left(begun.script, passed, deeds), known_variables=begun.variables)


def _alike(task: Task, action: GroundAction) -> list[GroundAction]:
    """The actions of several epochs of which one of that name may be what is left."""
    every = chain(task.actions, *(deed.variants for deed in task.script.deeds))
    found = (one for one in every if (one.name, one.participants) == (action.name, action.participants))
    return [one for one in dict.fromkeys(found) if one.timing is not None]


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
