"""Strict interference (semantics 2) by effects alone, where actions ask for more than their own conditions.

Rules of help give actions conditions on where the human is, or what is news: nobody protects those.  So in
such tasks interference is plain, and who asks for a fact that somebody else may delete adds it.  That changes
nothing, and is in the other's way; who asks for one to be false deletes it.
"""

from collections.abc import Sequence
from dataclasses import replace

from serendipity.model.errors import UsageError
from serendipity.model.options import Options
from serendipity.model.task.actions import GroundAction
from serendipity.model.task.task import Task
from serendipity.model.task.unit_steps import CLOCK


def interfering_plainly(options: Options) -> Options:
    """The options for a task of :func:`protected`."""
    limited = options.noticed or options.max_disturbance is not None
    return options.but(interference="paper") if options.strict and limited else options


def protected(task: Task, options: Options, facts: int) -> Task:
    """The task in which effects say what strict interference forbids, where the options ask for that.

    Args:
        facts: so many, from the first on, are protected.

    Raises:
        UsageError: effects can't say it.
    """
    if interfering_plainly(options) is options:
        return task
    clock = task.agents.index(CLOCK) if CLOCK in task.agents else -1
    others = [action for action in task.actions if clock not in action.participants]
    adding, deleting, refusing = (_by_fact(others, kind) for kind in ("add", "delete", "neg"))

    def of_others(action: GroundAction, agents: Sequence[set[tuple[int, ...]]]) -> bool:
        return any(not set(who).intersection(action.participants) for one in agents for who in one)

    def kept(action: GroundAction) -> GroundAction:
        add = {f for f in action.pre if f < facts and of_others(action, [deleting.get(f, set())])}
        delete = {f for f in action.neg if f < facts and of_others(action, [adding.get(f, set())])}
        for fact in delete:
            if fact in action.add or of_others(action, [refusing[fact], deleting.get(fact, set())]):
                why = f"where several ask for a fact to be false ('{task.facts[fact]:.50}') is not known"
                raise UsageError(f"interference: strict, with noticed or max_disturbance, {why}")
        add.difference_update(action.delete)
        return replace(
            action,
            add=tuple(sorted(add.union(action.add))),
            delete=tuple(sorted(delete.union(action.delete))),
        )

    actions = tuple(action if clock in action.participants else kept(action) for action in task.actions)
    return replace(task, actions=actions, known_variables=task.variables)


def _by_fact(actions: Sequence[GroundAction], kind: str) -> dict[int, set[tuple[int, ...]]]:
    """By fact who takes part in actions that have it among such facts."""
    found: dict[int, set[tuple[int, ...]]] = {}
    for action in actions:
        for fact in getattr(action, kind):
            found.setdefault(fact, set()).add(action.participants)
    return found
