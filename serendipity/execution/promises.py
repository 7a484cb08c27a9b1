"""What robots promise to the person, whichever of the possible goals is theirs (see :mod:`.guard`)."""

from collections.abc import Iterable, Sequence
from copy import copy

from search import PreparedTask
from serendipity.execution.advice import Allows
from serendipity.execution.guard import Hands
from serendipity.execution.imagined import Imagined, useful
from serendipity.model.options import Options
from serendipity.model.resources.deadline import Deadline
from serendipity.model.task.task import Task


class Promises:
    """What robots must not do, now and as long as the person goes on like this.

    Args:
        tasks: the task with each of the goals that the person may have.
        options: in force.
        told: the person keeps to the robots' plan: then there is nothing to promise.
        surely: whether robots manage whatever is possible.

    Attributes:
        hands: what robots can do.
    """

    def __init__(self, tasks: Sequence[Task], options: Options, *, told: bool, surely: bool) -> None:
        self.hands = Hands(tasks[0])
        self._tasks = tasks
        self._options = options
        self._told = told
        self._surely = surely
        self._imagined: list[Imagined | None] = [None] * len(tasks)
        self._useful: frozenset[int] | None = None

    def again(self) -> "Promises":
        """The same, with the same tables, which go their own way from here."""
        other = copy(self)
        other._imagined = [None if imagined is None else imagined.again() for imagined in self._imagined]
        return other

    def to(self, goal: int) -> Imagined:
        """The person with a goal; one that was looked at."""
        imagined = self._imagined[goal]
        assert imagined is not None, "asked for a goal that was not looked at"
        return imagined

    def acted(self, own: int | None, executed: Sequence[int], tried: int | None) -> None:
        """Say what the person did, as :class:`.guard.Following` takes it."""
        for imagined in self._imagined:
            if imagined is not None:
                imagined.following.acted(own, executed, tried)

    def surprised(self) -> None:
        """The world is other than what actions have made it, and everybody knows."""
        self._imagined = [None] * len(self._tasks)

    def look(self, state: frozenset[int], goals: Iterable[int], deadline: Deadline) -> list[int]:
        """The person looks up; those goals that they can reach alone.

        Args:
            state: ids of the facts that are true.
            goals: those that the person may have.
            deadline: polled, now and for as long as the promises are asked about.

        Raises:
            LimitReachedError: the deadline came first.
        """
        found = []
        for goal in goals:
            imagined = self._imagined[goal]
            if imagined is None:
                imagined = self._imagine(goal, state, deadline)
            imagined.companion.under(deadline)
            imagined.following.look(state)
            if not imagined.following.hopeless:
                found.append(goal)
        return found

    def _imagine(self, goal: int, state: frozenset[int], deadline: Deadline) -> Imagined:
        if self._useful is None:
            several = self._tasks if len(self._tasks) > 1 else ()
            self._useful = frozenset[int]().union(*(useful(PreparedTask(t), deadline) for t in several))
        imagined = self._imagined[goal] = Imagined(
            self._tasks[goal], self._options, self.hands, state, deadline, self._useful, told=self._told
        )
        return imagined

    def allows(self, goals: Iterable[int], beside: Sequence[int] = ()) -> Allows:
        """What may happen in the epoch that is to come, whichever of some goals the person has.

        Args:
            goals: the goals.
            beside: ids of what robots do in any case.
        """
        human, actions = self._tasks[0].human, self._tasks[0].actions
        following = [self.to(goal).following for goal in goals]
        known: dict[tuple[int, ...], bool] = {}

        def allowed(chosen: Sequence[int]) -> bool:
            others = tuple(sorted(i for i in chosen if actions[i].participants != (human,)))
            found = known.get(others)
            if found is None:
                offers = [i for i in others if human in actions[i].participants]
                robots = [*beside, *(i for i in others if human not in actions[i].participants)]
                found = known[others] = not any(
                    one.spoilt(robots, offers, surely=self._surely) for one in following
                )
            return found

        return (lambda _: True) if self._told else allowed
