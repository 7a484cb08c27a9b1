"""The human alone: their optimal cost from a state, and all their optimal plans.

*Optimal* means least cost, then fewest actions (semantics 1); both are in the key.
Costs are cached on the facts that their own actions mention, so a state costs one
search per projection, and a search also fills in the states along its result.
"""

from collections.abc import Callable, Iterator
from typing import Final, Protocol

from search.algorithms.astar import AStar
from search.human.pattern_database import PatternDatabase
from search.packed.cost_vector import INFINITE_KEY, Weights, own_weights
from search.packed.operators import Operator
from search.packed.packed_task import PackedGoal, PackedTask
from search.packed.successor_generator import Lookup
from serendipity.model.errors import LimitReachedError
from serendipity.model.resources.deadline import Deadline

_MANY: Final = 2_000
"""States after which a better bound is worth its tables."""

_A_WHILE: Final = 0.5
"""Seconds without which they are not begun: loading what makes them takes some of that already."""

_SHARE: Final = 0.25
"""What of the time that is left they may take."""

Edges = dict[int, list[tuple[int, int]]]
"""Per state the actions that continue an optimal plan, ascending, with their successors."""


class PlanGraph:
    """The optimal plans from a state as a graph: they share prefixes and suffixes.

    Args:
        start: the packed state that they start from.
        edges: the steps that lie on an optimal plan.
        expanded: states that the search for them expanded.
        generated: steps that it looked at.
    """

    def __init__(self, start: int, edges: Edges, expanded: int, generated: int) -> None:
        self._start = start
        self._edges = edges
        self.expanded = expanded
        self.generated = generated

    def canonical(self) -> tuple[int, ...]:
        """The plan that takes the smallest action at each step (semantics 1)."""
        return next(self.plans())

    def plans(self) -> Iterator[tuple[int, ...]]:
        """All of them, in string order, lazily."""
        path: list[int] = []
        open_steps = [iter(self._edges.get(self._start, ()))]
        if self._start not in self._edges:
            yield ()
            return
        while open_steps:
            step = next(open_steps[-1], None)
            if step is None:
                open_steps.pop()
                if path:
                    path.pop()
                continue
            action, after = step
            path.append(action)
            if after in self._edges:
                open_steps.append(iter(self._edges[after]))
            else:
                yield tuple(path)
                path.pop()

    def layers(self) -> list[set[int]]:
        """Per step the actions that some optimal plan does then."""
        found: list[set[int]] = []
        layer = {self._start}
        while steps := [step for state in layer for step in self._edges.get(state, ())]:
            found.append({action for action, _ in steps})
            layer = {after for _, after in steps}
        return found

    def count(self) -> int:
        """How many there are, without listing them."""
        counts: dict[int, int] = {}
        pending = [self._start]
        while pending:
            state = pending[-1]
            after = [successor for _, successor in self._edges.get(state, ())]
            missing = [successor for successor in after if successor not in counts]
            if missing:
                pending.extend(missing)
            else:
                counts[state] = sum(counts[successor] for successor in after) if after else 1
                pending.pop()
        return counts[self._start]


class Memory:
    """What has been found out about the human alone; good for calls that weigh alike.

    Attributes:
        lookup: the human's own operators.
        known: optimal keys by state.
        at_least: what optimal keys are not below.
        expanded: how many states have come up, until the bound was refined.
        refined: a better bound than the projection onto private fields, once there is one.
        plans: the optimal plans from the state that was asked about last.
    """

    def __init__(self, lookup: Lookup) -> None:
        self.lookup = lookup
        self.known: dict[int, int] = {}
        self.at_least: dict[int, int] = {}
        self.expanded = 0
        self.refined: Callable[[int], int] | None = None
        self.plans: tuple[int, PlanGraph | None] | None = None


class HumanOptimum(Protocol):
    """What the human does alone, optimally, with every robot idle."""

    def key(self, state: int, limit: int = INFINITE_KEY) -> int:
        """The optimal key alone from a packed state; from ``limit`` (a key) on any value says "not below"."""

    def plans(self, state: int) -> "PlanGraph | None":
        """All the human's optimal plans from a packed state; None if there is none."""


class IndividualPlanner:
    """The human's optimal key to a goal with every robot idle.

    Args:
        encoding: the packed task.
        goal: what has to hold at the end.
        weight: key increment of one of their own ops.
        bound: admissible lower bound to ``goal``.
        deadline: polled at each state that comes up.
        memory: what earlier calls have found with the same goal and weights.
    """

    def __init__(
        self,
        packed: PackedTask,
        goal: PackedGoal,
        weight: Callable[[Operator], int],
        bound: PatternDatabase,
        deadline: Deadline,
        memory: Memory | None = None,
    ) -> None:
        self._packed = packed
        self._goal = goal
        self._weight = weight
        self._projection = bound
        self._deadline = deadline
        self._mask = goal.mask | bound.mask | packed.own_mask
        self._memory = memory or Memory(Lookup(packed.own_index, weight))
        self._lookup = self._memory.lookup
        self._known = self._memory.known
        self._at_least = self._memory.at_least

    def key(self, state: int, limit: int = INFINITE_KEY) -> int:
        """See :class:`HumanOptimum`."""
        state &= self._mask
        known = self._known.get(state)
        if known is not None:
            return known
        floor = self._at_least.get(state, 0)
        if floor >= limit:
            return floor
        return self._search(state, limit)

    def _search(self, start: int, limit: int) -> int:
        """A*; exact below ``limit``.

        It ends at goals and at states of which the key is known, and goes on for as long as
        a cheaper end may come.
        """
        search = AStar(start, self._bound, self._deadline, limit=limit, deep_first=True)
        parents: dict[int, tuple[int, int]] = {}
        end, hopeless = None, True
        for state, spent in search:
            if self._refines(start):
                return self.key(start, limit)
            rest = self._rest(state)
            if rest is not None:
                hopeless = hopeless and rest >= INFINITE_KEY
                if spent + rest < search.limit:
                    search.limit, end = spent + rest, state
                continue
            for option in self._lookup.options(state):
                after = state & option.keep | option.put
                if search.reach(after, spent + option.weight):
                    parents[after] = state, option.weight
        if end is not None:
            return self._remember(end, search.limit - search.spent[end], parents)
        if hopeless and (search.least is None or search.least >= INFINITE_KEY):
            self._known[start] = INFINITE_KEY
            return INFINITE_KEY
        self._at_least[start] = max(limit, self._at_least.get(start, 0))
        return limit

    def _bound(self, state: int) -> int:
        """Lower bound of the optimal key from a packed state."""
        projected, refined = self._projection(state), self._memory.refined
        return projected if refined is None else max(projected, refined(state))

    def _refines(self, start: int) -> bool:
        """Whether so many states have come up that the bound has been refined: a search begins anew then.

        Args:
            start: where it began; that nothing leads to a goal from there may show.
        """
        memory = self._memory
        memory.expanded += 1
        if memory.expanded != _MANY:
            return False
        left = self._deadline.left()
        if left is not None and left < _A_WHILE:
            return False
        # Loaded only here: it takes longer than most calls, which come by without it.
        from search.abstractions.bound import own_bound
        from search.abstractions.reachability import may_reach

        packed = self._packed
        if not may_reach(start, self._goal, packed.fields, packed.own, self._deadline):
            self._known[start] = INFINITE_KEY
            return True
        part = self._deadline if left is None else self._deadline.within(left * _SHARE)
        try:
            memory.refined = own_bound(packed, self._goal, self._weight, self._lookup, start, part)
        except LimitReachedError:
            self._deadline.check()
        return memory.refined is not None

    def _rest(self, state: int) -> int | None:
        """The human's optimal key where it is known or a goal is reached; else None."""
        known = self._known.get(state)
        return 0 if known is None and self._goal.holds(state) else known

    def _remember(self, state: int, rest: int, parents: dict[int, tuple[int, int]]) -> int:
        """Note the keys of all states along a cheapest way, from its end on; that of its start.

        Args:
            state: where it ends.
            rest: the human's optimal key there.
            parents: the state before each state but the start, and the weight of the step.
        """
        self._known[state] = rest
        while state in parents:
            state, weight = parents[state]
            rest += weight
            self._known[state] = rest
        return rest

    def plans(self, state: int) -> "PlanGraph | None":
        """See :class:`HumanOptimum`."""
        start = state & self._mask
        last = self._memory.plans
        if last is None or last[0] != start:
            last = self._memory.plans = start, self._optimal(start)
        return last[1]

    def _optimal(self, start: int) -> PlanGraph | None:
        """The graph of the optimal plans; None if there is no plan.

        Every state whose bound does not exceed the optimum is expanded; edges that lie on
        an optimal path are then those between exact distances.
        """
        optimum = self._known.get(start, INFINITE_KEY - 1)
        if optimum >= INFINITE_KEY:
            return None
        search = AStar(start, self._bound, self._deadline, limit=optimum + 1)
        expanded: dict[int, list[tuple[int, int, int]]] = {}
        goals = []
        for state, spent in search:
            if self._refines(start):
                return self._optimal(start)
            steps: list[tuple[int, int, int]] = []
            expanded[state] = steps
            if self._goal.holds(state):
                search.limit = spent + 1  # the first one is a cheapest one, others are no dearer
                goals.append(state)
                continue
            for option in self._lookup.options(state):
                after, cost = state & option.keep | option.put, spent + option.weight
                steps.append((option.actions[0], after, cost))
                search.reach(after, cost)
        if not goals:
            self._known[start] = INFINITE_KEY
            return None
        distance, optimum = search.spent, search.spent[goals[0]]
        edges = _edges_into(goals, expanded, distance, self._deadline)
        for state, onward in edges.items():
            edges[state] = self._one_a_name(onward)
        for state in (*edges, *goals):
            self._known[state] = optimum - distance[state]
        return PlanGraph(start, edges, len(expanded), sum(map(len, expanded.values())))

    def _one_a_name(self, steps: list[tuple[int, int]]) -> list[tuple[int, int]]:
        """The first step of each name: variants of one action make no different plan (semantics 1)."""
        names = [self._packed.task.actions[action].name for action, _ in steps]
        return [step for step, name, last in zip(steps, names, ["", *names], strict=False) if name != last]


class PricedPlanner:
    """:class:`IndividualPlanner` to ``G_H``, in the keys of a call; what it finds serves other calls.

    Args:
        packed: the packed task.
        bound: what :func:`.own_projection` finds.
        memory: what earlier calls have found, see :func:`own_memory`.
        weights: key increments of the call, which say nothing of communication.
        deadline: polled at each state that comes up.
    """

    def __init__(
        self, packed: PackedTask, bound: PatternDatabase, memory: Memory, weights: Weights, deadline: Deadline
    ) -> None:
        own = own_weights(packed)
        self._alone = IndividualPlanner(packed, packed.goal, lambda op: own[op.cost], bound, deadline, memory)
        self._weights = weights

    def key(self, state: int, limit: int = INFINITE_KEY) -> int:
        """See :class:`HumanOptimum`."""
        if limit >= INFINITE_KEY:
            found = self._alone.key(state)
        else:
            found = self._alone.key(state, self._weights.own_limit(limit))
        return found if found >= INFINITE_KEY else self._weights.of_own({state: found})[state]

    def plans(self, state: int) -> PlanGraph | None:
        """See :class:`HumanOptimum`."""
        return self._alone.plans(state)


def own_memory(packed: PackedTask) -> Memory:
    """Nothing yet, in the unit of :func:`.own_weights`."""
    own = own_weights(packed)
    return Memory(Lookup(packed.own_index, lambda op: own[op.cost]))


def canonical(alone: HumanOptimum, state: int) -> tuple[int, ...]:
    """The canonical optimal plan (semantics 1) from a packed state that has one."""
    graph = alone.plans(state)
    assert graph is not None, "asked for plans where there are none"
    return graph.canonical()


def _edges_into(
    goals: list[int],
    expanded: dict[int, list[tuple[int, int, int]]],
    distance: dict[int, int],
    deadline: Deadline,
) -> Edges:
    tight: dict[int, list[tuple[int, int]]] = {}
    for state, steps in expanded.items():
        deadline.tick()
        for action, after, cost in steps:
            if distance.get(after) == cost:
                tight.setdefault(after, []).append((action, state))
    edges: Edges = {}
    pending, seen = list(goals), set(goals)
    while pending:
        after = pending.pop()
        for action, state in tight.get(after, ()):
            edges.setdefault(state, []).append((action, after))
            if state not in seen:
                seen.add(state)
                pending.append(state)
    for onward in edges.values():
        onward.sort()
    return edges
