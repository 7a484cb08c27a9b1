"""The human alone: their optimal cost from a state, and all their optimal plans.

*Optimal* means least cost, then fewest actions (semantics 1); both are in the key.
Costs are cached on the facts that their own actions mention, so a state costs one
search per projection, and a search also fills in the states along its result.
"""

from collections.abc import Callable, Iterator
from contextlib import suppress
from typing import TYPE_CHECKING, Final, NamedTuple

from search.engine.astar import AStar
from search.human.pattern_database import GoalBound
from search.human.plan_graph import PlanGraph, cheapest_ways
from search.packed.cost_vector import INFINITE_KEY, Weights, own_weights
from search.packed.operators import Operator
from search.packed.packed_task import PackedGoal, PackedTask
from search.packed.successor_generator import BesideScript, Lookup
from serendipity.model.errors import LimitReachedError
from serendipity.model.resources.deadline import Deadline
from serendipity.model.task.task import HumanPlan

if TYPE_CHECKING:
    from search.human.whole_actions import OwnPlanner

_MANY: Final = 2_000
"""States in one search after which the kernel takes over."""


class Memory:
    """Costs and plans of the human alone that have been found; good for calls that weigh alike.

    Args:
        weight: of one of their own ops; None: as :func:`.own_weights` has it.
        strict: strict interference, which matters beside bystanders.

    Attributes:
        weight, strict: the same.
        lookup: the human's own operators.
        known: optimal keys by state.
        at_least: what optimal keys are not below.
        expanded: how many states have come up outside of the kernel.
        classical: the kernel on the same question, once it has taken over.
        plans: the optimal plans from the state that was asked about last.
    """

    def __init__(
        self, packed: PackedTask, weight: Callable[[Operator], int] | None = None, *, strict: bool = False
    ) -> None:
        own = own_weights(packed)
        self.weight = weight or (lambda op: own[op.cost])
        self.strict = strict
        self.lookup = Lookup(packed.own_index, self.weight)
        if packed.clock_bit:
            self.lookup = BesideScript(packed, self.weight, strict=strict)
        self.known: dict[int, int] = {}
        self.at_least: dict[int, int] = {}
        self.expanded = 0
        self.classical: OwnPlanner | None = None
        self.plans: tuple[int, PlanGraph | None] | None = None


class FoundPlan(NamedTuple):
    """A plan of the human alone, the states that searches for it expanded, and the steps they looked at."""

    actions: tuple[int, ...]
    expanded: int
    generated: int


class TakenOverError(Exception):
    """The kernel goes on."""


class IndividualPlanner:
    """The human's optimal key to a goal with every robot idle.

    Args:
        bound: admissible lower bound to ``goal`` on sums of weights.
        memory: how operators weigh, and what earlier calls have found with the same goal and weights.
        prices: makes keys of sums of weights, then in the unit of :func:`.own_weights`, which the kernel
            knows; None: they are keys.

    Attributes:
        mask: the fields that the human's plans depend on, or change.
    """

    def __init__(
        self,
        packed: PackedTask,
        goal: PackedGoal,
        bound: GoalBound,
        memory: Memory,
        deadline: Deadline,
        prices: Weights | None = None,
    ) -> None:
        self._packed = packed
        self._goal = goal
        self._prices = prices
        self._projection = bound
        self._deadline = deadline
        self.mask = packed.all_ones if packed.clock_bit else goal.mask | bound.mask | packed.own_mask
        self._memory = memory
        self._lookup, self._known, self._at_least = memory.lookup, memory.known, memory.at_least
        self._blind = bool(goal.mask & ~bound.mask & ~packed.freedom)

    def key(self, state: int, limit: int = INFINITE_KEY) -> int:
        """The optimal key alone from a packed state; from ``limit`` (a key) on any value says "not below"."""
        if self._prices is not None and limit < INFINITE_KEY:
            limit = self._prices.own_limit(limit)
        return self._key_of(self._least_from(state & self.mask, limit))

    def _key_of(self, found: int) -> int:
        """A sum of weights as a key."""
        return found if self._prices is None else self._prices.of_own(found)

    def _least_from(self, state: int, limit: int = INFINITE_KEY) -> int:
        """The least sum of weights from a state; from ``limit`` on any value says "not below"."""
        known = self._known.get(state)
        if known is not None:
            return known
        floor = self._at_least.get(state, 0)
        if floor >= limit:
            return floor
        if self._memory.classical is None:
            with suppress(TakenOverError):
                return self._search(state, limit)
        return self._by_kernel(state, limit)

    def _by_kernel(self, state: int, limit: int) -> int:
        classical = self._memory.classical
        assert classical is not None, "it has taken over"
        try:
            found = classical.cheapest(state, self._deadline, limit)
        except LimitReachedError:
            self._at_least[state] = max(classical.least, self._at_least.get(state, 0))
            raise
        if found >= limit:
            self._at_least[state] = max(found, self._at_least.get(state, 0))
            return found
        self._known[state] = found
        return found

    def _search(self, start: int, limit: int) -> int:
        """A*; exact below ``limit``.

        It ends at goals and at states of which the key is known, and goes on for as long as
        a cheaper end may come.
        """
        search = AStar(start, self._estimate, self._deadline, limit=limit, deep_first=True)
        end, hopeless = None, True
        for number, (state, spent) in enumerate(search):
            self._count(number)
            rest = self._rest(state)
            if rest is not None:
                hopeless = hopeless and rest >= INFINITE_KEY
                if spent + rest < search.limit:
                    search.limit, end = spent + rest, state
                continue
            for option in self._lookup.options(state):
                after = state & option.keep | option.put
                search.reach(after, spent + option.weight, state, option.weight)
        if end is not None:
            return self._remember(end, search.limit - search.spent[end], search)
        if hopeless and (search.least is None or search.least >= INFINITE_KEY):
            self._known[start] = INFINITE_KEY
            return INFINITE_KEY
        self._at_least[start] = max(limit, self._at_least.get(start, 0))
        return limit

    def _estimate(self, state: int) -> int:
        """:meth:`_bound`, for a search: the kernel's may take as long as hundreds of other steps."""
        if self._memory.classical is not None:
            self._deadline.check()
        return self._bound(state)

    def _bound(self, state: int) -> int:
        """Lower bound of the optimal key from a packed state."""
        projected, classical = self._projection(state), self._memory.classical
        return projected if classical is None else max(projected, classical.bound(state, self._deadline))

    def _count(self, number: int) -> None:
        """Count a state; after many the kernel goes on, where it can, or at once where the bound is blind.

        Args:
            number: how many states have come up before in this search.

        Raises:
            TakenOverError: the kernel has been made ready to go on.
        """
        self._memory.expanded += 1
        if number == _MANY or (self._blind and self._memory.expanded == 1):
            self._take_over()
            if self._memory.classical is not None:
                raise TakenOverError

    def _take_over(self) -> None:
        """Make the kernel ready to go on, where it can."""
        if self._prices is not None and self._memory.classical is None and not self._packed.clock_bit:
            from search.human.whole_actions import alone_planner  # only here: most calls come by without

            self._memory.classical = alone_planner(self._packed, self._goal, self._deadline)

    def _rest(self, state: int) -> int | None:
        """The human's optimal key where it is known or a goal is reached; else None."""
        known = self._known.get(state)
        return 0 if known is None and self._goal.holds(state) else known

    def _remember(self, state: int, rest: int, search: AStar[int]) -> int:
        """Note the keys of all states along a cheapest way, from its end on; that of its start."""
        self._known[state] = rest
        for before, weight in search.way_back(state):
            rest += weight
            self._known[before] = rest
        return rest

    def canonical(self, state: int) -> FoundPlan | None:
        """The canonical optimal plan (semantics 1) from a packed state; None if there is no plan."""
        start = state & self.mask
        if self._memory.classical is None:
            with suppress(TakenOverError):
                graph = self._graph(start)
                if graph is None:
                    return None
                return FoundPlan(graph.canonical(), graph.expanded, graph.generated)
        if self._least_from(start) >= INFINITE_KEY:
            return None
        assert self._memory.classical is not None, "it has taken over"
        return self._found(self._memory.classical.canonical(start, self._deadline))

    def best_plan(self, state: int) -> FoundPlan | None:
        """The best plan from a packed state that searches have come across so far; None: no plan yet."""
        classical = self._memory.classical
        return None if classical is None else self._found(classical.best_so_far(state & self.mask))

    def _found(self, actions: tuple[int, ...] | None) -> FoundPlan | None:
        """What the kernel has found."""
        classical = self._memory.classical
        if actions is None or classical is None:
            return None
        expanded, generated, _ = classical.planner.counts()
        return FoundPlan(actions, self._memory.expanded + expanded, generated)

    def first_plan(self, state: int) -> tuple[int, ...] | None:
        """Some plan from a packed state, soon; None where there is none, or no way to find one soon."""
        self._take_over()
        classical = self._memory.classical
        return None if classical is None else classical.first_plan(state & self.mask, self._deadline)

    def least(self, state: int) -> int:
        """What is known so far that no key from a packed state is below."""
        state &= self.mask
        floor = max(self._known.get(state, 0), self._at_least.get(state, 0))
        return self._key_of(min(max(floor, self._bound(state)), INFINITE_KEY))

    def plans(self, state: int) -> PlanGraph | None:
        """All the human's optimal plans from a packed state; None if there is none."""
        start = state & self.mask
        try:
            return self._graph(start)
        except TakenOverError:
            return self._graph(start)

    def proved(self, state: int, plan: HumanPlan) -> None:
        """Note that a plan from a packed state is optimal, as was proved over another packing."""
        ops = [self._packed.op(action) for action in plan]
        weight = self._memory.weight
        rest = sum(map(weight, ops))
        for op in ops:
            self._known[state & self.mask] = rest
            state, rest = state & op.keep | op.put, rest - weight(op)

    def _graph(self, start: int) -> PlanGraph | None:
        last = self._memory.plans
        if last is None or last[0] != start:
            if self._memory.classical is not None:
                self._least_from(start)
            found = self._optimal(start)
            if found is not None and self._packed.in_time:
                found = found.fewest(self._packed.counted)
            last = self._memory.plans = start, found
        return last[1]

    def _optimal(self, start: int) -> PlanGraph | None:
        """The graph of the optimal plans; None if there is no plan."""
        optimum = self._known.get(start, INFINITE_KEY - 1)
        if optimum >= INFINITE_KEY:
            return None
        search = AStar(start, self._estimate, self._deadline, limit=optimum + 1)

        def steps(state: int) -> Iterator[tuple[int, int, int]]:
            for option in self._lookup.options(state):
                yield option.actions[0], state & option.keep | option.put, option.weight

        def is_goal(state: int) -> bool:
            self._count(0)
            return self._goal.holds(state)

        goals, edges, generated = cheapest_ways(search, steps, is_goal, self._deadline)
        if not goals:
            self._known[start] = INFINITE_KEY
            return None
        distance, optimum = search.spent, search.spent[goals[0]]
        for state, onward in edges.items():
            edges[state] = self._one_a_name(onward)
        for state in (*edges, *goals):
            self._known[state] = optimum - distance[state]
        return PlanGraph(start, edges, len(generated), sum(generated))

    def _one_a_name(self, steps: list[tuple[int, int]]) -> list[tuple[int, int]]:
        """The first step of each name: variants of one action make no different plan (semantics 1)."""
        names = [self._packed.task.actions[action].name for action, _ in steps]
        return [step for step, name, last in zip(steps, names, ["", *names], strict=False) if name != last]


def canonical(alone: IndividualPlanner, state: int) -> tuple[int, ...]:
    """The canonical optimal plan (semantics 1) from a packed state that has one."""
    plan = alone.canonical(state)
    assert plan is not None, "asked for plans where there are none"
    return plan.actions
