"""What is news to the human, and what they may do in spite of it, by brute force (semantics 14)."""

from collections.abc import Iterable
from typing import NamedTuple

from serendipity.model import GroundAction, HumanPlan, Task
from serendipity.model.task.visibility import surroundings
from serendipity_testing.oracle.epochs import State, parts_of

Noticing = tuple[int, frozenset[int]]
"""How many steps of their plan the human has done, -1 once they have left it; and the facts that are news."""

FRESH: Noticing = (0, frozenset())
"""At first."""


class Happening(NamedTuple):
    """What an action asks and does in an epoch, whether it begins in it, and whether it is known to all."""

    part: GroundAction
    begins: bool
    known: bool


class Notices:
    """Keeps up what is news.

    Args:
        task: the task.
        plan: the human's.
    """

    def __init__(self, task: Task, plan: HumanPlan) -> None:
        self._task, self._seen = task, surroundings(task)
        self._plan = [task.actions[i].name for i in plan]
        self._goal = {*task.goal.positive, *task.goal.negative}
        own = [part for i in task.human_actions for part in parts_of(task.actions[i])]
        self._asked = self._goal.union(*({*part.pre, *part.neg} for part in own))

    def in_goal(self, noticing: Noticing) -> bool:
        """Whether something that the human wants is news to them."""
        return not self._goal.isdisjoint(noticing[1])

    def after(
        self, state: State, noticing: Noticing, happening: Iterable[Happening], then: State
    ) -> Noticing | None:
        """After an epoch in which some actions begin, or go on; None where they may not.

        Args:
            state: before it.
            noticing: before it.
            happening: of what bystanders do, or others are at from the start, all is known.
            then: the state after it.
        """
        task, (step, news) = self._task, noticing
        seen, watching, onward = self._visible(state), step >= 0, step
        if watching:
            news = news - seen
        theirs = [one for one in happening if task.human in one.part.participants]
        for part, begins, _ in theirs:
            if begins:
                planned = (
                    watching and self._plan[step : step + 1] == [part.name] and len(part.participants) == 1
                )
                onward = step + 1 if planned else -1
            if onward < 0 and len(part.participants) == 1 and not news.isdisjoint({*part.pre, *part.neg}):
                return None
        touched = {fact for part, *_ in theirs for fact in (*part.add, *part.delete)}
        robots = [part for part, _, known in happening if not known and task.human not in part.participants]
        unseen = {fact for part in robots for fact in (*part.add, *part.delete)} & self._asked
        unseen = unseen - seen if watching else unseen
        reached = (self._visible(then) - seen) & self._goal if theirs and onward >= 0 else frozenset()
        if not unseen.isdisjoint(touched) or not unseen.isdisjoint(reached):
            return None  # what the human does, or comes to see, nobody else does at the same time
        return onward, (news | unseen) - touched - reached

    def _visible(self, state: State) -> frozenset[int]:
        """The facts about the human, or the place where they are; all where there are no places."""
        human, located = self._task.agents[self._task.human], self._seen.located
        if all(who != human for who, _ in located.values()):
            return frozenset(range(len(self._task.facts)))
        about = {human} | {place for f, (who, place) in located.items() if who == human and f in state}
        return frozenset(f for f, parts in enumerate(self._seen.parts) if not parts.isdisjoint(about))
