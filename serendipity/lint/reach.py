"""Delete-relaxed reachability of literals, and relevance of actions for a goal."""

from collections import defaultdict
from collections.abc import Iterable, Sequence
from collections.abc import Set as AbstractSet

from serendipity.model import Condition, Deadline, GroundAction, Task

Fact = tuple[int, bool]
"""A fact, and whether it is true."""


def missing(goal: Condition, reached: AbstractSet[Fact]) -> tuple[Fact, ...]:
    """The literals of a goal that were not reached."""
    return tuple(literal for literal in _literals(goal) if literal not in reached)


def reachable(task: Task, actions: Sequence[GroundAction], deadline: Deadline) -> set[Fact]:
    """The literals that some sequence of the actions makes true, each by itself, and maybe more.

    Made true once, a literal stays so, beside its opposite; so what is not reached here can't
    be reached at all, and what is may still be out of reach.

    Args:
        actions: those to use.
    """
    reached = {(fact, fact in task.init) for fact in range(len(task.facts))}
    waiting: defaultdict[Fact, list[GroundAction]] = defaultdict(list)
    pending = list(actions)
    while pending:
        deadline.tick()
        action = pending.pop()
        lacking = next((literal for literal in _needs(action) if literal not in reached), None)
        if lacking is not None:
            waiting[lacking].append(action)
            continue
        for literal in _makes(action):
            if literal not in reached:
                reached.add(literal)
                pending += waiting.pop(literal, ())
    return reached


def relevant(task: Task, deadline: Deadline) -> list[bool]:
    """For each action whether it may contribute to a goal, the human's or the robots'."""
    makers: defaultdict[Fact, list[int]] = defaultdict(list)
    for i, action in enumerate(deadline.each(task.actions)):
        for literal in _makes(action):
            makers[literal].append(i)
    found = [False] * len(task.actions)
    pending = [*_literals(task.goal), *_literals(task.robot_goal)]
    seen = set(pending)
    while pending:
        for i in deadline.each(makers.pop(pending.pop(), ())):
            if not found[i]:
                found[i] = True
                new = [literal for literal in _needs(task.actions[i]) if literal not in seen]
                seen.update(new)
                pending += new
    return found


def _literals(goal: Condition) -> Iterable[Fact]:
    yield from ((fact, True) for fact in goal.positive)
    yield from ((fact, False) for fact in goal.negative)


def _needs(action: GroundAction) -> Iterable[Fact]:
    yield from ((fact, True) for fact in action.pre)
    yield from ((fact, False) for fact in action.neg)


def _makes(action: GroundAction) -> Iterable[Fact]:
    yield from ((fact, True) for fact in action.add)
    yield from ((fact, False) for fact in action.delete)
