"""The facts that change while a plan runs, as lanes: what is true from when to when."""

from collections.abc import Sequence, Set
from dataclasses import dataclass

from serendipity.model import Task
from serendipity.model.variables import Variable


@dataclass(frozen=True, slots=True)
class Span:
    """A value that a lane has after each of the epochs ``first .. last`` (0: initially)."""

    first: int
    last: int
    value: str


@dataclass(frozen=True, slots=True)
class Change:
    """A lane: a fact by itself, or a variable of several facts.

    Attributes:
        label: the fact, or what its values share.
        goal: whether the human's goal names it.
        spans: when it has which value; a fact by itself has spans only while it is true.
    """

    label: str
    goal: bool
    spans: tuple[Span, ...]


def find_changes(
    task: Task, states: Sequence[frozenset[int]], last: int, hidden: Set[int]
) -> tuple[Change, ...]:
    """Lanes of what changes, and of the human's goals; first goals, then in order of change.

    Args:
        task: whose facts they are.
        states: after each epoch, from 0.
        last: epoch up to which lanes are drawn; the last state lasts till then.
        hidden: facts that the map shows already.
    """
    goals = {*task.goal.positive, *task.goal.negative}
    found = []
    for variable in task.variables:
        goal = not goals.isdisjoint(variable.facts)
        if not goal and not hidden.isdisjoint(variable.facts):
            continue
        values = [tuple(f for f in variable.facts if f in state) for state in states]
        changes = [epoch for epoch in range(1, len(values)) if values[epoch] != values[epoch - 1]]
        if changes or goal:
            found.append((not goal, changes[:1], _lane(task, variable, goal, values, last)))
    return tuple(change for *_, change in sorted(found, key=lambda entry: entry[:2]))


def _lane(task: Task, variable: Variable, goal: bool, values: Sequence[tuple[int, ...]], last: int) -> Change:
    spans: list[Span] = []
    names = [", ".join(task.facts[f] for f in value) for value in values]
    for epoch, name in enumerate(names):
        end = last if epoch == len(names) - 1 else epoch
        if spans and spans[-1].last == epoch - 1 and spans[-1].value == name:
            spans[-1] = Span(spans[-1].first, end, name)
        elif name:
            spans.append(Span(epoch, end, name))
    label = task.facts[variable.facts[0]] if variable.boolean else _shared(task, variable)
    return Change(label, goal, tuple(spans))


def _shared(task: Task, variable: Variable) -> str:
    """What the names of a variable's facts have in common, word by word."""
    first, *others = (task.facts[f].split() for f in variable.facts)
    words = [
        word if all(i < len(other) and other[i] == word for other in others) else "·"
        for i, word in enumerate(first)
    ]
    return " ".join(words) if set(words) != {"·"} else " / ".join(task.facts[f] for f in variable.facts[:3])
