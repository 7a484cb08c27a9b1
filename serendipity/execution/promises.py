"""What robots promise to the person, whichever of the possible goals is theirs (see :mod:`.guard`)."""

from collections.abc import Iterable, Sequence

from search import PreparedTask
from serendipity.execution.guard import Following, Hands
from serendipity.execution.world import World
from serendipity.model.resources.deadline import Deadline
from serendipity.model.task.plans import PlanStep
from serendipity.model.task.task import Task


class Promises:
    """What robots must not do, now and as long as the person goes on like this.

    Args:
        tasks: the task with each of the goals that the person may have.
        strict: whether interference is strict.
        told: the person keeps to the robots' plan: then there is nothing to promise.

    Attributes:
        hands: what robots can do.
    """

    def __init__(self, tasks: Sequence[Task], *, strict: bool, told: bool) -> None:
        self.hands = Hands(tasks[0])
        self._told = told
        self._following = [Following(PreparedTask(task), strict=strict) for task in tasks]

    def to(self, goal: int) -> Following:
        """What the person may be following towards a goal."""
        return self._following[goal]

    def acted(self, own: int | None) -> None:
        """Say what the person did by themselves."""
        for following in self._following:
            following.acted(own)

    def look(
        self, state: frozenset[int], goals: Iterable[int], deadline: Deadline
    ) -> dict[int, frozenset[int]]:
        """For each goal that the person can reach alone, ids of what robots must leave alone.

        Args:
            state: ids of the facts that are true.
            goals: those that the person may have.
            deadline: polled.

        Raises:
            LimitReachedError: the deadline came first.
        """
        found = {}
        for goal in goals:
            needed = self._following[goal].look(state, deadline)
            if not self._following[goal].hopeless:
                found[goal] = frozenset[int]() if self._told else self.hands.off(needed)
        return found

    def broken_by(
        self,
        steps: Sequence[PlanStep],
        offers: Sequence[PlanStep],
        world: World,
        goals: Iterable[int],
        deadline: Deadline,
    ) -> PlanStep | None:
        """The first of some steps that could make it dearer for the person, beside those before it.

        Args:
            steps: what robots mean to do by themselves in an epoch.
            offers: joint actions that the person may take part in.
            world: where they stand.
            goals: those that the person may have.
            deadline: polled.

        Raises:
            LimitReachedError: the deadline came first.
        """
        if self._told:
            return None
        ready, actions = [world.of(step) for step in offers], [world.of(step) for step in steps]
        for count, step in enumerate(steps, start=1):
            if any(self._following[goal].spoilt(actions[:count], ready, deadline) for goal in goals):
                return step
        return None
