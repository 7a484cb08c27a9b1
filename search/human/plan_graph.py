"""All optimal plans of the human alone, as a graph."""

from collections.abc import Callable, Hashable, Iterable, Iterator, Sequence
from dataclasses import dataclass
from typing import TypeVar

from search.engine.astar import AStar
from serendipity.model.resources.deadline import Deadline

State = TypeVar("State", bound=Hashable)

Edges = dict[int, list[tuple[int, int]]]
"""Per state the actions that continue an optimal plan, ascending, with their successors."""


@dataclass(eq=False)
class PlanGraph:
    """The optimal plans from a state as a graph, and what the search for it expanded, and generated."""

    start: int
    edges: Edges
    expanded: int
    generated: int

    def canonical(self) -> tuple[int, ...]:
        """The plan that takes the smallest action at each step (semantics 1)."""
        return next(self.plans())

    def plans(self) -> Iterator[tuple[int, ...]]:
        """All of them, in string order, lazily."""
        return (plan for plan, _ in self._with_ends(all_ways=True))

    def ending(self, fits: Callable[[int], bool]) -> tuple[int, ...] | None:
        """The first plan whose last state fits; None where none does."""
        return next((plan for plan, end in self._with_ends(all_ways=False) if fits(end)), None)

    def _with_ends(self, *, all_ways: bool) -> Iterator[tuple[tuple[int, ...], int]]:
        """Plans and their last states, in string order; unless ``all_ways``, only the first to each state."""
        if self.start not in self.edges:
            yield (), self.start
        plan, way, open_steps = list[int](), [self.start], [iter(self.edges.get(self.start, ()))]
        left = set[int]()
        while open_steps:
            action, after = next(open_steps[-1], (-1, 0))
            if action < 0:
                left.add(way.pop())
                open_steps.pop()
                del plan[-1:]
            elif all_ways or after not in left:
                plan.append(action)
                if after not in self.edges:
                    yield tuple(plan), after
                way.append(after)
                open_steps.append(iter(self.edges.get(after, ())))

    def distinct(self, name: Callable[[int], str]) -> Iterator[tuple[int, ...]]:
        """Those that differ in the names of actions, each as it comes first; some actions have no name."""
        seen: set[tuple[int, tuple[str, ...]]] = set()
        told: set[tuple[str, ...]] = set()
        pending: list[tuple[int, tuple[int, ...], tuple[str, ...]]] = [(self.start, (), ())]
        while pending:
            state, plan, names = pending.pop()
            if (state, names) in seen:
                continue
            seen.add((state, names))
            if state not in self.edges and names not in told:
                told.add(names)
                yield plan
            for action, after in reversed(self.edges.get(state, ())):
                mine = name(action)
                pending.append((after, (*plan, action), (*names, mine) if mine else names))

    def fewest(self, size: Callable[[int], int]) -> "PlanGraph":
        """Those plans alone that have the fewest actions; some have size 0, being no actions of their own."""
        least: dict[int, int] = {}
        edges: Edges = {}
        for state, onward in self._from_the_end():
            least[state] = min((size(action) + least[after] for action, after in onward), default=0)
            kept = [step for step in onward if size(step[0]) + least[step[1]] == least[state]]
            if kept:
                edges[state] = kept
        return PlanGraph(self.start, edges, self.expanded, self.generated)

    def size(self, size: Callable[[int], int]) -> int:
        """The number of actions in its first plan, as :meth:`fewest` counts them."""
        return sum(map(size, self.canonical()))

    def drawn(self, choose: Callable[[Sequence[tuple[int, int]]], tuple[int, int]]) -> tuple[int, ...]:
        """One of them, put together by a choice of one of several (action, successor) at each step."""
        plan: list[int] = []
        state = self.start
        while onward := self.edges.get(state):
            action, state = choose(onward)
            plan.append(action)
        return tuple(plan)

    def layers(self) -> list[set[int]]:
        """Per step the actions that some optimal plan does then."""
        found: list[set[int]] = []
        layer = {self.start}
        while steps := [step for state in layer for step in self.edges.get(state, ())]:
            found.append({action for action, _ in steps})
            layer = {after for _, after in steps}
        return found

    def count(self) -> int:
        """How many there are, without listing them."""
        counts: dict[int, int] = {}
        for state, onward in self._from_the_end():
            counts[state] = sum(counts[after] for _, after in onward) if onward else 1
        return counts[self.start]

    def _from_the_end(self) -> Iterator[tuple[int, Sequence[tuple[int, int]]]]:
        """Every state with its steps, each after all that these lead to."""
        seen: set[int] = set()
        pending = [self.start]
        while pending:
            onward = self.edges.get(pending[-1], ())
            missing = [after for _, after in onward if after not in seen]
            if missing:
                pending += missing
                continue
            state = pending.pop()
            if state not in seen:
                seen.add(state)
                yield state, onward


def cheapest_ways(
    search: AStar[State],
    steps: Callable[[State], Iterable[tuple[int, State, int]]],
    is_goal: Callable[[State], bool],
    deadline: Deadline,
) -> tuple[list[State], dict[State, list[tuple[int, State]]], list[int]]:
    """Where the cheapest ways of a search end, the steps on them, and how many each state has that came up.

    Every state whose bound does not exceed the optimum is expanded; steps on a cheapest way are then those
    between exact distances.

    Args:
        search: one that has not begun.
        steps: of a state: action, successor, weight.
    """
    goals: list[State] = []
    expanded: dict[State, list[tuple[int, State, int]]] = {}
    for state, spent in search:
        expanded[state] = []
        if is_goal(state):
            search.limit = spent + 1  # the first one is a cheapest one, others are no dearer
            goals.append(state)
            continue
        for action, after, weight in steps(state):
            expanded[state].append((action, after, spent + weight))
            search.reach(after, spent + weight, state)
    tight: dict[State, list[tuple[int, State]]] = {}
    for state, onward in expanded.items():
        deadline.tick()
        for action, after, cost in onward:
            if search.spent.get(after) == cost:
                tight.setdefault(after, []).append((action, state))
    edges: dict[State, list[tuple[int, State]]] = {}
    pending, seen = list(goals), set(goals)
    while pending:
        after = pending.pop()
        for action, state in tight.get(after, ()):
            edges.setdefault(state, []).append((action, after))
            if state not in seen:
                seen.add(state)
                pending.append(state)
    for chosen in edges.values():
        chosen.sort()
    return goals, edges, [*map(len, expanded.values())]
