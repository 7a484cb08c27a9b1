"""A* (Hart, Nilsson and Raphael 1968), for whoever says what a step is.

The loop over what comes up is the caller's::

    search = AStar(start, estimate, deadline, limit=limit)
    for state, spent in search:
        for weight, after in steps(state):
            search.reach(after, spent + weight, state, step)

so that it may end where it likes, go back along a cheapest way (:meth:`AStar.way_back`), and lower the
limit when it has found something.  The estimate is consistent, but for states from which nobody goes on: a
state comes up once, when its cost is known.
"""

from collections.abc import Callable, Hashable, Iterator
from heapq import heappop, heappush
from typing import Any, Generic, TypeVar

from serendipity.model.resources.deadline import Deadline

State = TypeVar("State", bound=Hashable)


class AStar(Generic[State]):
    """States by what has been spent on the way to them and what is at least missing.

    Args:
        start: where it starts; states are ordered, the smaller one comes first where all else is equal.
        estimate: consistent lower bound of what is missing from a state.
        limit: what costs as much or more does not come up.
        deep_first: of states with equal sums those come first on which more has been spent, else those
            on which less has.

    Attributes:
        limit: may be lowered while the search is iterated.
        spent: the least cost of each state that was reached, as far as it is known; it is exact for
            those that have come up.
    """

    def __init__(
        self,
        start: State,
        estimate: Callable[[State], int],
        deadline: Deadline,
        *,
        limit: int,
        deep_first: bool = False,
    ) -> None:
        self.limit = limit
        self.spent: dict[State, int] = {start: 0}
        self._estimate = estimate
        self._deadline = deadline
        self._sign = -1 if deep_first else 1
        self._queue: list[tuple[int, int, State]] = [(estimate(start), 0, start)]
        self._closed: set[State] = set()
        self._before: dict[State, tuple[State, Any]] = {}

    @property
    def least(self) -> int | None:
        """No way on over what has not come up costs less; None where nothing is left."""
        return self._queue[0][0] if self._queue else None

    def __iter__(self) -> Iterator[tuple[State, int]]:
        """States, and what has been spent, as they come up, each once."""
        queue, closed, spent = self._queue, self._closed, self.spent
        while queue and queue[0][0] < self.limit:
            _, _, state = heappop(queue)
            if state not in closed:
                closed.add(state)
                self._deadline.tick()
                yield state, spent[state]

    def reach(self, state: State, spent: int, before: State, step: object = None) -> None:
        """Note a way to a state, if it is the cheapest so far."""
        known = self.spent.get(state)
        if known is not None and spent >= known:
            return
        self.spent[state] = spent
        self._before[state] = before, step
        heappush(self._queue, (spent + self._estimate(state), self._sign * spent, state))

    def way_back(self, state: State) -> Iterator[tuple[State, Any]]:
        """The states before a state on the cheapest way to it, with the step from each, back to the start."""
        while state in self._before:
            state, step = self._before[state]
            yield state, step
