"""What is news to the human, and what they may do in spite of it, by brute force (semantics 14)."""

from collections.abc import Sequence

from serendipity.model import HumanPlan, Task
from serendipity.model.task.visibility import surroundings
from serendipity.testing.oracle.epochs import State

Noticing = tuple[int, frozenset[int]]
"""How many steps of their plan the human has done, -1 once they have left it; and the facts that are news."""

FRESH: Noticing = (0, frozenset())
"""At first."""


class Notices:
    """Keeps up what is news.

    Args:
        task: without time.
        plan: the human's.
    """

    def __init__(self, task: Task, plan: HumanPlan) -> None:
        self._task, self._seen = task, surroundings(task)
        self._plan = [task.actions[i].name for i in plan]
        goal = {*task.goal.positive, *task.goal.negative}
        own = [task.actions[i] for i in task.human_actions]
        self._goal, self._asked = goal, goal.union(*({*action.pre, *action.neg} for action in own))

    def in_goal(self, noticing: Noticing) -> bool:
        """Whether something that the human wants is news to them."""
        return not self._goal.isdisjoint(noticing[1])

    def after(self, state: State, noticing: Noticing, begun: Sequence[int], then: State) -> Noticing | None:
        """After an epoch in which some actions are done; None where they may not be.

        Args:
            state: before it.
            noticing: before it.
            begun: the actions.
            then: the state after it.
        """
        task, (step, news) = self._task, noticing
        actions = [task.actions[i] for i in begun]
        theirs = [action for action in actions if task.human in action.participants]
        watching, onward = step >= 0, step
        if watching:
            news = news - self._visible(state)
        for action in theirs:
            planned = watching and step < len(self._plan) and self._plan[step] == action.name
            onward = step + 1 if planned else -1
            if not planned and not action.joint and not news.isdisjoint({*action.pre, *action.neg}):
                return None
        touched = {fact for action in theirs for fact in (*action.add, *action.delete)}
        robots = [action for action in actions if task.human not in action.participants]
        changed = {fact for action in robots for fact in (*action.add, *action.delete)} & self._asked
        unseen = changed - self._visible(state) if watching else changed
        reached = self._visible(then) - self._visible(state) if onward > step else frozenset()
        if not unseen.isdisjoint(touched) or not unseen.isdisjoint(reached & self._goal):
            return None  # what the human does, or comes to see, nobody else does at the same time
        return onward, (news | unseen) - touched - (reached & self._goal)

    def _visible(self, state: State) -> frozenset[int]:
        """The facts about the human, or the place where they are; all where there are no places."""
        human, located = self._task.agents[self._task.human], self._seen.located
        if all(who != human for who, _ in located.values()):
            return frozenset(range(len(self._task.facts)))
        about = {human} | {place for f, (who, place) in located.items() if who == human and f in state}
        return frozenset(f for f, parts in enumerate(self._seen.parts) if not parts.isdisjoint(about))
