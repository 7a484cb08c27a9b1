"""The human alone: (cost, length) of their optimal plans from any state (semantics 1)."""

import heapq
from collections.abc import Iterator
from fractions import Fraction

from serendipity.model import HumanPlan, Task
from serendipity.testing.oracle.alone_in_time import plans_in_time
from serendipity.testing.oracle.epochs import State, after, holds, usable

Worth = tuple[Fraction, int]
"""Cost and number of actions."""


class Alone:
    """Optimal costs of the human alone, for all states that were asked for."""

    def __init__(self, task: Task) -> None:
        self.task = task
        self._worth: dict[State, Worth | None] = {}

    def worth(self, state: State) -> Worth | None:
        """Least (cost, length) of a plan of the human's from ``state``; None if there is none."""
        if state not in self._worth:
            self._solve(state)
        return self._worth[state]

    def successors(self, state: State) -> Iterator[tuple[int, State]]:
        """The human's own applicable actions in ascending order, with what they lead to."""
        for i in self.task.human_actions:
            if usable(self.task.actions[i], state):
                yield i, after(state, [self.task.actions[i]])

    def optimal(self, state: State) -> list[tuple[int, State]]:
        """The actions that start an optimal plan; none where the goal holds or can't be reached."""
        worth = self.worth(state)
        if worth is None or holds(self.task.goal, state):
            return []
        found = []
        for i, next_state in self.successors(state):
            rest = self.worth(next_state)
            if rest is not None and (rest[0] + self.task.actions[i].cost, rest[1] + 1) == worth:
                found.append((i, next_state))
        return found

    def _solve(self, start: State) -> None:
        """Explore everything the human can reach, then one Dijkstra backward from the goal states."""
        seen, stack = {start}, [start]
        edges: dict[State, list[tuple[State, Fraction]]] = {}
        while stack:
            state = stack.pop()
            for i, next_state in self.successors(state):
                edges.setdefault(next_state, []).append((state, self.task.actions[i].cost))
                if next_state not in seen:
                    seen.add(next_state)
                    stack.append(next_state)
        final: dict[State, Worth] = {}
        goals = [state for state in seen if holds(self.task.goal, state)]
        queue: list[tuple[Fraction, int, int, State]] = [
            (Fraction(0), 0, n, state) for n, state in enumerate(goals)
        ]
        ticket = len(queue)
        while queue:
            cost, length, _, state = heapq.heappop(queue)
            if state in final:
                continue
            final[state] = (cost, length)
            for before, step in edges.get(state, ()):
                ticket += 1
                heapq.heappush(queue, (cost + step, length + 1, ticket, before))
        for state in seen:
            self._worth[state] = final.get(state)


def human_plans(task: Task) -> Iterator[HumanPlan]:
    """All optimal plans of the human alone from ``I`` that differ in names; the canonical one first."""
    if task.needs_time:
        yield from plans_in_time(task)
        return
    alone = Alone(task)
    if alone.worth(task.init) is None:
        return
    known: set[tuple[str, ...]] = set()
    stack: list[tuple[State, HumanPlan]] = [(task.init, ())]
    while stack:
        state, plan = stack.pop()
        names = tuple(task.actions[i].name for i in plan)
        if holds(task.goal, state) and names not in known:
            known.add(names)
            yield plan
        stack.extend((next_state, (*plan, i)) for i, next_state in reversed(alone.optimal(state)))


def optimal_human_plan(task: Task) -> HumanPlan | None:
    """The canonical optimal plan of the human alone, or None."""
    return next(human_plans(task), None)
