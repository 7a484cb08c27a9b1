"""The facts that change while a plan runs, as lanes: what is true from when to when."""

from collections.abc import Sequence, Set
from dataclasses import dataclass

from serendipity.model import Task
from serendipity.model.task.variables import Variable


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
        goal: whether it is a literal of the human's goal.
        spans: when it has which value; a fact by itself, and a goal, only while it is true.
    """

    label: str
    goal: bool
    spans: tuple[Span, ...]


def find_changes(
    task: Task, states: Sequence[frozenset[int]], last: int, hidden: Set[int]
) -> tuple[Change, ...]:
    """Lanes of what changes, and of the human's goals; first goals, then in order of change.

    Goals that hold all the time say nothing; they have a lane only where that is all there is to say.

    Args:
        task: whose facts they are.
        states: after each epoch, from 0.
        last: epoch up to which lanes are drawn; the last state lasts till then.
        hidden: facts that the map shows already.
    """
    goals = [_goal(task, states, last, fact, wanted=True) for fact in task.goal.positive]
    goals += [_goal(task, states, last, fact, wanted=False) for fact in task.goal.negative]
    lanes = [goal for goal in goals if [(s.first, s.last) for s in goal.spans] != [(0, last)]] or goals
    shown = {*task.goal.positive, *task.goal.negative, *hidden}
    found = []
    for variable in task.variables:
        if (variable.boolean and variable.facts[0] in shown) or not hidden.isdisjoint(variable.facts):
            continue
        values = [tuple(f for f in variable.facts if f in state) for state in states]
        changes = [epoch for epoch in range(1, len(values)) if values[epoch] != values[epoch - 1]]
        if changes:
            names = [", ".join(task.facts[f] for f in value) for value in values]
            found.append((changes[0], Change(_shared(task, variable), False, _spans(names, last))))
    found.sort(key=lambda entry: entry[0])
    return (*lanes, *(change for _, change in found))


def _goal(task: Task, states: Sequence[frozenset[int]], last: int, fact: int, *, wanted: bool) -> Change:
    """The lane of one literal of the goal: when it holds."""
    name = task.facts[fact] if wanted else f"not {task.facts[fact]}"
    return Change(name, True, _spans([name if (fact in state) == wanted else "" for state in states], last))


def _spans(names: Sequence[str], last: int) -> tuple[Span, ...]:
    """Runs of equal values; an empty one has no span."""
    spans: list[Span] = []
    for epoch, name in enumerate(names):
        end = last if epoch == len(names) - 1 else epoch
        if spans and spans[-1].last == epoch - 1 and spans[-1].value == name:
            spans[-1] = Span(spans[-1].first, end, name)
        elif name:
            spans.append(Span(epoch, end, name))
    return tuple(spans)


def _shared(task: Task, variable: Variable) -> str:
    """What the names of a variable's facts have in common: word by word, else the thing they speak of."""
    if variable.boolean:
        return task.facts[variable.facts[0]]
    first, *others = (task.facts[f].split() for f in variable.facts)
    words = [
        word if all(i < len(other) and other[i] == word for other in others) else "·"
        for i, word in enumerate(first)
    ]
    if set(words) != {"·"}:
        return " ".join(words)
    named = [word for word in first if all(word in other for other in others)]
    return " ".join(named) or " / ".join(task.facts[f] for f in variable.facts[:3])
