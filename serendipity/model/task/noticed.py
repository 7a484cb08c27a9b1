"""A task in which the human leaves their plan for nothing but what they have noticed (semantics 14).

Search and verifier both look at such tasks.  That they are right is held by the verifier, which goes through
the plan itself, and by the brute force of the tests; both know of no such task.
"""

from bisect import bisect_left, bisect_right
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import replace
from typing import Final

from serendipity.model.errors import UsageError
from serendipity.model.task.actions import Condition, GroundAction, apply
from serendipity.model.task.plans import Step
from serendipity.model.task.single_epochs import epochs
from serendipity.model.task.task import HumanPlan, Task
from serendipity.model.task.unit_steps import RESTING, WAITING, asked_of
from serendipity.model.task.variables import Variable
from serendipity.model.task.visibility import surroundings

_NOWHERE: Final = -1
"""In place of the fact that says where the human is, where they are nowhere or it is not known."""


class Noticed:
    """The task, with facts that say how far the human is in their plan, and what is news to them.

    An action becomes one for each place where the human may be, if it matters, and for each step of the plan
    that it may be: variants of one name.

    Args:
        task: in single epochs.
        original: the task as it was given, whose facts say what is to be seen.

    Raises:
        UsageError: somebody else moves the human.
    """

    def __init__(self, task: Task, plan: HumanPlan, original: Task) -> None:
        self._task, seen, self._given = task, surroundings(original), range(len(original.facts))
        self._human, self._parts = task.agents[task.human], seen.parts
        self._places = {fact: place for fact, (who, place) in seen.located.items() if who == self._human}
        self._going_on = frozenset(number for _, number in task.due)
        self._plan = [task.actions[number].name for number in plan if self._begins(number)]
        self._steps = tuple(range(len(task.facts), len(task.facts) + len(self._plan) + 1))
        self._departed = self._steps[-1] + 1
        self._require_own_walks()
        told = self._of_use()
        self._news = {fact: self._departed + 1 + number for number, fact in enumerate(told)}
        steps = (*(f"~step {number}" for number in range(len(self._steps))), "~departed")
        names = (*steps, *(f"~news {task.facts[fact]}" for fact in told))
        self._original: list[int] = []
        actions: list[GroundAction] = []
        for number in range(len(task.actions)):
            for variant in self._variants(number):
                self._original.append(number)
                actions.append(variant)
        goal, unseen = task.goal, [self._news[fact] for fact in self._wanted()]
        self.task = replace(
            task,
            facts=(*task.facts, *names),
            init=task.init | {self._steps[0]},
            actions=tuple(actions),
            goal=Condition(goal.positive, (*goal.negative, *unseen)),
            due=tuple((fact, new) for fact, number in task.due for new in self._ids(number)),
            known_variables=(
                *task.variables,
                Variable((*self._steps, self._departed)),
                *(Variable((fact,)) for fact in self._news.values()),
            ),
        )

    def plan(self, plan: HumanPlan) -> HumanPlan:
        """The human's plan, an action an epoch, by ids of this task."""
        steps = [Step(epoch, number) for epoch, number in enumerate(plan, start=1)]
        played = self._played(steps, len(plan))
        return tuple(chosen[number] for number, (_, chosen) in zip(plan, played, strict=True))

    def back(self, plan: Sequence[int]) -> tuple[int, ...]:
        """A plan by ids of the task that was given."""
        return tuple(self._original[number] for number in plan)

    def allows(self, steps: Iterable[Step], last: int) -> bool:
        """Whether the human notices in time what a plan has them leave theirs for; ``last`` is ``T``."""
        told = self._told(self.task.init)
        for after, chosen in self._played(steps, last):
            actions = [self.task.actions[new] for new in chosen.values() if new != _NOWHERE]
            both = {f for a in actions for f in a.add} & {f for a in actions for f in a.delete}
            if len(actions) < len(chosen) or self._told(both):
                return False
            told = after
        return told.isdisjoint(self.task.goal.negative)

    def _played(self, steps: Iterable[Step], last: int) -> Iterator[tuple[frozenset[int], dict[int, int]]]:
        """Epochs, as far as anything happens in them: facts of its own after it, and the variants of actions.

        Where an action has none that can be done, that is ``_NOWHERE``.
        """
        numbers = {id(action): number for number, action in enumerate(self._task.actions)}
        told = self._told(self.task.init)
        for before, actions in epochs(self._task, steps, last):
            state, chosen = before | told, dict[int, int]()
            for number in (numbers[id(action)] for action in actions):
                ways = (new for new in self._ids(number) if self.task.actions[new].applicable(state))
                chosen[number] = next(ways, _NOWHERE)
            done = [self.task.actions[new] for new in chosen.values() if new != _NOWHERE]
            told = self._told(apply(state, *done))
            yield told, chosen

    def _told(self, facts: Iterable[int]) -> frozenset[int]:
        """Those of some facts that the task that was given does not have."""
        return frozenset(fact for fact in facts if fact >= len(self._task.facts))

    def _ids(self, number: int) -> range:
        """Ids of an action's variants."""
        return range(bisect_left(self._original, number), bisect_right(self._original, number))

    def _begins(self, number: int) -> bool:
        """Whether somebody begins an action; what goes on, and waiting, is none of the human's steps."""
        return number not in self._going_on and self._task.actions[number].name not in (WAITING, RESTING)

    def _is_known(self, number: int) -> bool:
        """Whether an action is none of those that the human has to notice, nor one of theirs."""
        task = self._task
        return task.human in task.actions[number].participants or number in task.of_bystanders

    def _require_own_walks(self) -> None:
        others = (action for action in self._task.actions if self._task.human not in action.participants)
        moved = {fact for action in others for fact in (*action.add, *action.delete)} & self._places.keys()
        if moved:
            name = self._task.facts[min(moved)]
            raise UsageError(f"noticed: where somebody else moves the human ('{name:.50}') is not known")

    # -- what is news

    def _of_use(self) -> list[int]:
        """The facts that robots' own actions change, and the human's own actions or goal ask for."""
        task, goal = self._task, self._task.goal
        theirs = [action for number, action in enumerate(task.actions) if not self._is_known(number)]
        changed = {fact for action in theirs for fact in (*action.add, *action.delete)}
        asked = {fact for number in task.human_actions for fact in self._asks(number)}
        return sorted(changed & (asked | {*goal.positive, *goal.negative}) & {*self._given})

    def _asks(self, number: int) -> set[int]:
        """What an action asks for; of what goes on, only that."""
        action = self._task.actions[number]
        return asked_of(self._task, action) if number in self._going_on else {*action.pre, *action.neg}

    def _wanted(self) -> list[int]:
        goal = self._task.goal
        return [fact for fact in (*goal.positive, *goal.negative) if fact in self._news]

    def _seen_from(self, facts: Iterable[int], position: int) -> list[int]:
        """Those of some facts that the human sees from a position, while they follow their plan."""
        if not self._places:
            return [*facts]
        about = {self._human, self._places.get(position)}
        return [fact for fact in facts if not about.isdisjoint(self._parts[fact])]

    def _changed(self, action: GroundAction) -> list[int]:
        return [fact for fact in (*action.add, *action.delete) if fact in self._news]

    # -- variants

    def _variants(self, number: int) -> Iterator[GroundAction]:
        action = self._task.actions[number]
        if not self._is_known(number):
            yield from self._of_robots(action)
        elif self._task.human not in action.participants or action.name in (WAITING, RESTING):
            yield action
        else:
            asked = set() if action.joint else self._asks(number).intersection(self._news)
            yield from self._on_plan(number)
            if number not in self._going_on:
                yield from self._leaving(action, asked)
            forbidden = [self._news[fact] for fact in asked]
            cleared = [self._news[fact] for fact in self._changed(action)]
            yield _with(action, pre=[self._departed], neg=forbidden, delete=cleared)

    def _on_plan(self, number: int) -> Iterator[GroundAction]:
        """As the next step of the plan, or as what goes on meanwhile."""
        goals, action = self._wanted(), self._task.actions[number]
        for position, placed in self._placed(action, self._places):
            cleared = {*self._seen_from(self._news, position), *self._changed(action)}
            for reached in action.add:
                if reached in self._places:
                    cleared |= {*self._seen_from(goals, reached)}
            seen = _with(placed, delete=[self._news[one] for one in cleared])
            if number in self._going_on:
                yield _with(seen, neg=[self._departed])
                continue
            for fact in () if action.joint else self._steps_named(action.name):
                yield _with(seen, pre=[fact], add=[fact + 1], delete=[fact])

    def _leaving(self, action: GroundAction, asked: set[int]) -> Iterator[GroundAction]:
        """As the first that is not of the plan."""
        steps = () if action.joint else self._steps_named(action.name)
        for position, placed in self._placed(action, self._places):
            seen = self._seen_from(self._news, position)
            cleared = [self._news[fact] for fact in (*seen, *self._changed(action))]
            forbidden = [self._departed, *steps, *(self._news[fact] for fact in asked.difference(seen))]
            yield _with(placed, neg=forbidden, add=[self._departed], delete=[*self._steps, *cleared])

    def _steps_named(self, name: str) -> list[int]:
        return [fact for fact, step in zip(self._steps, self._plan, strict=False) if step == name]

    def _of_robots(self, action: GroundAction) -> Iterator[GroundAction]:
        changed = self._changed(action)
        if not changed:
            yield action
            return
        yield _with(action, pre=[self._departed], add=[self._news[fact] for fact in changed])
        about = {word for fact in changed for word in self._parts[fact]}
        watching = [fact for fact, place in self._places.items() if place in about]
        for position, placed in self._placed(action, watching):
            unseen = set(changed) - {*self._seen_from(changed, position)}
            yield _with(placed, neg=[self._departed], add=[self._news[fact] for fact in unseen])

    def _placed(self, action: GroundAction, positions: Iterable[int]) -> Iterator[tuple[int, GroundAction]]:
        """An action for each of some positions of the human, and one for all others."""
        known = [fact for fact in positions if fact in action.pre]
        if known:
            yield known[0], action
            return
        possible = [fact for fact in positions if fact not in action.neg]
        for fact in possible:
            yield fact, _with(action, pre=[fact])
        yield _NOWHERE, _with(action, neg=possible)


def _with(
    action: GroundAction,
    *,
    pre: Iterable[int] = (),
    neg: Iterable[int] = (),
    add: Iterable[int] = (),
    delete: Iterable[int] = (),
) -> GroundAction:
    """An action that asks for more, and does more."""
    adds = {*action.add, *add}
    return replace(
        action,
        pre=tuple(sorted({*action.pre, *pre})),
        neg=tuple(sorted({*action.neg, *neg})),
        add=tuple(sorted(adds)),
        delete=tuple(sorted({*action.delete, *delete} - adds)),
    )
