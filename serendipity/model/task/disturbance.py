"""How much a plan disturbs the human (semantics 13): weights, and a task whose actions say it.

Search and verifier both look at such tasks.  That they weigh right is held by the verifier, which counts in
the plan itself, and by the brute force of the tests; both know of no such task.
"""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from fractions import Fraction
from typing import Final

from serendipity.model.errors import UsageError
from serendipity.model.numbers import exact
from serendipity.model.task.actions import GroundAction
from serendipity.model.task.task import Task
from serendipity.model.task.visibility import surroundings

KINDS: Final = ("ask", "meet", "sight")


@dataclass(frozen=True, slots=True)
class Disturbance:
    """What counts as disturbing the human.

    Attributes:
        ask: weight of an action in which they take part with a robot.
        meet: of a robot's own action that begins, or brings it, to where the human is.
        sight: of a robot's own action that changes a fact about the place where the human is; in each epoch
            in which it does.
    """

    ask: Fraction
    meet: Fraction
    sight: Fraction


def disturbance_from(text: str | None) -> Disturbance:
    """The weights of a text such as ``"ask=2, sight=1"`` (or a UsageError); without any each is 1."""
    if text is None:
        return Disturbance(*[Fraction(1)] * 3)
    found = dict.fromkeys(KINDS, Fraction(0))
    for part in str(text).split(","):
        name, _, value = part.strip().partition("=")
        if name not in KINDS:
            raise UsageError(f"disturbance: expected weights such as ask=1,meet=1,sight=1, got {text!r:.50}")
        found[name] = exact(value, f"disturbance: {name}")
        if found[name] < 0:
            raise UsageError(f"disturbance: {name}: expected at least 0, got {value}")
    return Disturbance(**found)


class DisturbanceTask:
    """A task in which each action of robots disturbs as much wherever the human is.

    An action that disturbs them in some places only becomes one for each of these, and one for all others:
    variants of one name.

    Args:
        task: in single epochs.
        original: the task as it was given, whose facts count.

    Attributes:
        original: their ids in the task that was given.
    """

    def __init__(self, task: Task, kinds: Disturbance, original: Task) -> None:
        self._kinds, self._task, seen = kinds, task, surroundings(original)
        self._parts, self._located = seen.parts, seen.located
        going_on = {action for _, action in task.due}
        human = task.agents[task.human]
        self._places = {fact: place for fact, (who, place) in seen.located.items() if who == human}
        self.weights: list[Fraction] = []
        self.original: list[int] = []
        actions: list[GroundAction] = []
        for number, action in enumerate(task.actions):
            for weight, variant in self._variants(action, begins=number not in going_on):
                self.weights.append(weight)
                self.original.append(number)
                actions.append(variant)
        by_number: dict[int, list[int]] = {}
        for new, number in enumerate(self.original):
            by_number.setdefault(number, []).append(new)
        due = tuple((fact, new) for fact, number in task.due for new in by_number[number])
        self.task = replace(task, actions=tuple(actions), due=due, known_variables=task.variables)

    def _variants(self, action: GroundAction, *, begins: bool) -> Iterator[tuple[Fraction, GroundAction]]:
        task = self._task
        if task.human in action.participants:
            yield self._kinds.ask if action.joint and begins else Fraction(0), action
            return
        is_robots = task.script.people.isdisjoint(action.participants)
        weights = self._weights(action, begins=begins) if is_robots else {}
        for fact, weight in weights.items():
            if fact not in action.neg:
                yield weight, replace(action, pre=tuple(sorted({*action.pre, fact})))
        if not weights.keys() & set(action.pre):
            yield Fraction(0), replace(action, neg=tuple(sorted({*action.neg, *weights})))

    def _weights(self, action: GroundAction, *, begins: bool) -> Mapping[int, Fraction]:
        """By fact that says where the human is what the action disturbs them then, if it does."""
        known = len(self._parts)
        changed = {part for f in (*action.add, *action.delete) if f < known for part in self._parts[f]}
        robots = {self._task.agents[agent] for agent in action.participants}
        named = (*action.pre, *action.add) if begins else action.add
        located = (self._located.get(fact, ("", "")) for fact in named)
        there = {place for who, place in located if who in robots}
        found = {}
        for fact, place in self._places.items():
            weight = self._kinds.sight * (place in changed) + self._kinds.meet * (place in there)
            if weight:
                found[fact] = weight
        return found
