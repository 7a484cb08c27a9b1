"""Epochs for a plan that was found without a horizon: as early as the rules allow."""

from collections.abc import Iterator, Sequence
from typing import Final

from serendipity.model.task.actions import GroundAction
from serendipity.model.task.plans import Step
from serendipity.model.task.task import Task

_WAITS_FOR: Final = {
    "acts": ("acts",),
    "needs": ("adds", "deletes"),
    "forbids": ("adds", "deletes"),
    "adds": ("deletes", "forbids"),
    "deletes": ("adds", "deletes", "needs"),
}
"""By what an action does with a fact, or as an agent: after what others do with it, it comes."""


def schedule(task: Task, sets: Sequence[tuple[int, ...]]) -> tuple[Step, ...]:
    """Steps with epochs for a sequence of action sets.

    A set goes to the first epoch after all that it needs or that either would disturb (strict interference).
    From there on nothing changes what it needs, and it changes nothing that others need: the same actions
    are applicable, and come to the same state.
    """
    last: dict[tuple[str, int | str], int] = {}
    steps = []
    for chosen in sets:
        deeds = [deed for i in chosen for deed in _deeds(task.actions[i])]
        awaited = (last.get((other, what), 0) for does, what in deeds for other in _WAITS_FOR[does])
        epoch = 1 + max(awaited, default=0)
        last.update((deed, max(epoch, last.get(deed, 0))) for deed in deeds)
        steps += [Step(epoch, i) for i in chosen]
    return tuple(sorted(steps))


def _deeds(action: GroundAction) -> Iterator[tuple[str, int | str]]:
    yield from (("acts", agent) for agent in action.participants)
    yield from (("needs", fact) for fact in action.pre)
    yield from (("forbids", fact) for fact in action.neg)
    yield from (("adds", fact) for fact in action.add)
    yield from (("deletes", fact) for fact in action.delete)
