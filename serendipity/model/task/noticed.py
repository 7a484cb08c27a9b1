"""A task in which the human leaves their plan for nothing but what they have noticed (semantics 14).

Search and verifier both look at such tasks.  That they are right is held by the verifier, which goes through
the plan itself, and by the brute force of the tests; both know of no such task.
"""

from bisect import bisect_left, bisect_right
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import replace
from itertools import combinations
from typing import Final

from serendipity.model.task.actions import Condition, GroundAction, apply, conflicting
from serendipity.model.task.plans import Step
from serendipity.model.task.task import HumanPlan, Task
from serendipity.model.task.variables import Variable
from serendipity.model.task.visibility import surroundings

_NOWHERE: Final = -1
"""In place of the fact that says where the human is, where they are nowhere or it is not known."""


class Noticed:
    """The task, with facts that say how far the human is in their plan, and what is news to them.

    An action becomes one for each place where the human may be, if it matters, and for each step of the plan
    that it may be: variants of one name.

    Args:
        task: without time.
        original: the task as it was given, whose facts say what is to be seen.
    """

    def __init__(self, task: Task, plan: HumanPlan, original: Task) -> None:
        self._task, seen = task, surroundings(original)
        self._human, self._parts = task.agents[task.human], seen.parts
        self._places = {fact: place for fact, (who, place) in seen.located.items() if who == self._human}
        self._steps = tuple(range(len(task.facts), len(task.facts) + len(plan) + 1))
        self._departed = self._steps[-1] + 1
        self._plan = [task.actions[number].name for number in plan]
        told = self._of_use()
        self._news = {fact: self._departed + 1 + number for number, fact in enumerate(told)}
        steps = (*(f"~step {number}" for number in range(len(self._steps))), "~departed")
        names = (*steps, *(f"~news {task.facts[fact]}" for fact in told))
        self._original: list[int] = []
        actions: list[GroundAction] = []
        for number, action in enumerate(task.actions):
            for variant in self._variants(action):
                self._original.append(number)
                actions.append(variant)
        goal, unseen = task.goal, [self._news[fact] for fact in self._wanted()]
        self.task = replace(
            task,
            facts=(*task.facts, *names),
            init=task.init | {self._steps[0]},
            actions=tuple(actions),
            goal=Condition(goal.positive, (*goal.negative, *unseen)),
            known_variables=(
                *task.variables,
                Variable((*self._steps, self._departed)),
                *(Variable((fact,)) for fact in self._news.values()),
            ),
        )

    def plan(self, plan: HumanPlan) -> HumanPlan:
        """The human's plan, an action an epoch, by ids of this task."""
        found, state = [], self.task.init
        for number in plan:
            new = bisect_left(self._original, number)
            while not self.task.actions[new].applicable(state):
                new += 1
            found.append(new)
            state = apply(state, self.task.actions[new])
        return tuple(found)

    def back(self, plan: Sequence[int]) -> tuple[int, ...]:
        """A plan by ids of the task that was given."""
        return tuple(self._original[number] for number in plan)

    def allows(self, steps: Iterable[Step]) -> bool:
        """Whether the human notices in time what a plan has them leave theirs for."""
        begun: dict[int, list[int]] = {}
        for step in steps:
            begun.setdefault(step.epoch, []).append(step.action)
        state = self.task.init
        for epoch in sorted(begun):
            ways = [[a for a in self._variants_of(i) if a.applicable(state)] for i in begun[epoch]]
            actions = [found[0] for found in ways if found]
            together = all(not conflicting(a, b, strict=False) for a, b in combinations(actions, 2))
            if not (all(ways) and together):
                return False
            state = apply(state, *actions)
        return self.task.goal.holds(state)

    def _variants_of(self, number: int) -> list[GroundAction]:
        first, last = bisect_left(self._original, number), bisect_right(self._original, number)
        return [*self.task.actions[first:last]]

    # -- what is news

    def _of_use(self) -> list[int]:
        """The facts that robots' own actions change, and the human's own actions or goal ask for."""
        task, goal = self._task, self._task.goal
        theirs = [action for action in task.actions if task.human not in action.participants]
        own = [task.actions[number] for number in task.human_actions]
        changed = {fact for action in theirs for fact in (*action.add, *action.delete)}
        asked = {fact for action in own for fact in (*action.pre, *action.neg)}
        return sorted(changed & (asked | {*goal.positive, *goal.negative}))

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

    def _variants(self, action: GroundAction) -> Iterator[GroundAction]:
        if self._task.human not in action.participants:
            yield from self._of_robots(action)
            return
        if not action.joint:
            yield from self._on_plan(action)
        for position, placed in self._placed(action, self._places):
            seen = self._seen_from(self._news, position)
            departing = self._departing(placed, [*seen, *self._changed(action)])
            unseen = self._asked(action) - {*seen} if not action.joint else ()
            steps = () if action.joint else self._steps_named(action.name)
            forbidden = [self._departed, *steps, *(self._news[fact] for fact in unseen)]
            yield _with(departing, neg=forbidden)
        asked = self._asked(action) if not action.joint else ()
        forbidden = [self._news[fact] for fact in asked]
        cleared = [self._news[fact] for fact in self._changed(action)]
        yield _with(action, pre=[self._departed], neg=forbidden, delete=cleared)

    def _on_plan(self, action: GroundAction) -> Iterator[GroundAction]:
        """As the next step of the plan."""
        goals = self._wanted()
        for fact in self._steps_named(action.name):
            for position, placed in self._placed(action, self._places):
                cleared = {*self._seen_from(self._news, position), *self._changed(action)}
                for reached in action.add:
                    if reached in self._places:
                        cleared |= {*self._seen_from(goals, reached)}
                delete = [fact, *(self._news[one] for one in cleared)]
                yield _with(placed, pre=[fact], add=[fact + 1], delete=delete)

    def _steps_named(self, name: str) -> list[int]:
        return [fact for fact, step in zip(self._steps, self._plan, strict=False) if step == name]

    def _departing(self, action: GroundAction, cleared: Iterable[int]) -> GroundAction:
        """As the first that is not of the plan."""
        delete = [*self._steps, *(self._news[fact] for fact in cleared)]
        return _with(action, add=[self._departed], delete=delete)

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

    def _asked(self, action: GroundAction) -> set[int]:
        return {fact for fact in (*action.pre, *action.neg) if fact in self._news}

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
