"""The team where epochs don't count, as a problem for the kernel."""

from collections.abc import Callable, Iterator
from functools import reduce

from search.classical.circles import TooManyError, circles
from search.classical.planner import ClassicalPlanner
from search.classical.problem import classical_problem
from search.kernel.library import library
from search.packed.cost_vector import Weights
from search.packed.operators import Operator
from search.packed.packed_task import PackedGoal, PackedTask
from serendipity.model.errors import LimitReachedError
from serendipity.model.resources.deadline import Deadline

Sets = list[tuple[int, ...]]
"""Sets of actions, one after another."""


class Team:
    """The cheapest plans of the team, from any state, as long as all agents may do what they like.

    Args:
        planner: the kernel on the team's problem.
        actions: per operator of the problem its actions.
    """

    def __init__(self, planner: ClassicalPlanner, actions: list[tuple[int, ...]]) -> None:
        self.planner = planner
        self.actions = actions

    def better_plans(self, state: int, deadline: Deadline, on_bound: Callable[[int], None]) -> Iterator[Sets]:
        """Some plan from a packed state soon, then cheaper ones; at the end the last one is a cheapest.

        There is no plan where none comes.  Plans are sets of actions.

        Args:
            on_bound: told now and then what no plan is cheaper than.
        """
        planner = self.planner
        first = planner.first_plan(state, deadline)
        if first is None:
            return
        on_bound(planner.bound(state, deadline))
        yield from self._plans(first)
        amount = planner.amount(first)
        try:
            best = planner.cheapest_plan(state, deadline, amount, on_bound)
        except LimitReachedError:
            yield from self._plans(planner.best_so_far(state))
            raise
        yield from self._plans(best)

    def go_on(self, state: int, deadline: Deadline, on_bound: Callable[[int], None]) -> Iterator[Sets]:
        """:meth:`better_plans` from where a limit came; no other plans may have been asked for since.

        There is no better plan than those before where none comes.
        """
        try:
            self.planner.go_on(deadline, on_bound)
        except LimitReachedError:
            yield from self._plans(self.planner.best_so_far(state))
            raise
        yield from self._plans(self.planner.best_so_far(state))

    def _plans(self, numbers: list[int] | None) -> Iterator[Sets]:
        """The plan of some operators, where there is one."""
        if numbers is not None:
            yield [self.actions[number] for number in numbers]


def team_planner(
    packed: PackedTask, goal: PackedGoal, weights: Weights, deadline: Deadline, *, strict: bool
) -> Team | None:
    """The team's problem in the kernel; None without a kernel that could.

    Amounts are in the unit of :meth:`.Weights.key_of`.

    Args:
        weights: what actions cost the team; communication is left out.
        strict: strict interference, which keeps apart what could be in a circle.
    """
    kernel = library()
    if kernel is None:
        return None
    operators = [*packed.own, *packed.joint, *packed.others]
    try:
        together = [] if strict else list(circles(packed, operators, deadline))
    except TooManyError:
        return None
    costs = [weights.scaled_cost(op) for op in operators]
    cost = dict(zip(operators, costs, strict=True))
    costs += [sum(map(cost.__getitem__, circle)) for circle in together]
    actions: list[tuple[int, ...]] = [(op.action,) for op in operators]
    actions += [tuple(op.action for op in circle) for circle in together]
    operators += [reduce(_both, circle) for circle in together]
    kept = packed.lasting
    if kept != packed.all_ones:  # plans are but bounds then: which epochs they take is left out
        seen = {_projected(op, kept): number for number, op in reversed([*enumerate(operators)])}
        numbers = sorted(number for op, number in seen.items() if ~op.keep & kept)
        operators = [_projected(operators[number], kept) for number in numbers]
        costs, actions = [costs[number] for number in numbers], [actions[number] for number in numbers]
        goal = goal.within(kept)
    fields = [(field, len(packed.values(field))) for field in packed.fields if field & kept]
    problem = classical_problem(fields, operators, costs, goal, map(len, actions))
    return None if problem is None else Team(ClassicalPlanner(kernel, problem, deadline), actions)


def _projected(op: Operator, kept: int) -> Operator:
    """An op as some fields see it; those that look alike are equal."""
    forbidden = tuple((field, value) for field, value in op.forbidden if field & kept)
    need_mask, keep = op.need_mask & kept, op.keep | ~kept
    return Operator(need_mask, op.need & kept, keep, op.put & kept, forbidden, 0, op.agents, op.cost)


def _both(a: Operator, b: Operator) -> Operator:
    return Operator(
        a.need_mask | b.need_mask,
        a.need | b.need,
        a.keep & b.keep,
        a.put | b.put,
        (*a.forbidden, *b.forbidden),
        a.action,
        a.agents | b.agents,
        a.cost,
    )
