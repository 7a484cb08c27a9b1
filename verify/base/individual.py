"""The human alone: (cost, length) of an optimal plan of theirs from a state, by A*.

Small questions are answered state by state; what turns out to be a long one by thousands of packed states
at once, with patterns of the human's own problem as bounds (``verify.packed``).
"""

from collections.abc import Callable, Iterable, Iterator
from fractions import Fraction
from functools import cached_property
from typing import TYPE_CHECKING, Any

from serendipity.model import Deadline, HumanPlan, Task
from verify.base.bit_distances import BitDistances
from verify.base.execution import after, applicable, awake, states_of_pi_h
from verify.base.operators import OwnActions
from verify.base.shortest_paths import PathSearch
from verify.base.undecided import SEARCHING, HumanTooLargeError, during
from verify.limits import limits

if TYPE_CHECKING:
    from verify.packed.problem import PackedProblem

State = frozenset[int]
Graph = tuple[Any, Callable[[Any], Iterable[tuple[Any, int, Any]]], Callable[[Any], bool]]


class IndividualOptimum:
    """Optimal (cost, length) of the human alone; tables are built when first needed."""

    def __init__(self, task: Task, deadline: Deadline | None = None) -> None:
        self._task = task
        self.deadline = deadline or Deadline()
        self._known: dict[int | State, int | None] = {}
        self._above: dict[int | State, int] = {}
        """States from which every plan weighs more than this."""
        self._enough: dict[int | State, int] = {}
        """What a plan from a state is known to weigh: only lighter ones are looked for."""
        self._long = False
        self.head_start_cost = Fraction(0)
        """What waiting for the head start costs."""

    @cached_property
    def own(self) -> OwnActions:
        """The human's own actions."""
        return OwnActions(self._task, self.deadline)

    @cached_property
    def _projection(self) -> BitDistances:
        """Of the human's own problem without what robots may have changed: what is left at least."""
        return self._without_others(self.own.private)

    def _without_others(self, facts: frozenset[int]) -> BitDistances:
        own, most = self.own, limits().projected_states
        return BitDistances(own.operators, own.goal, most, self.deadline, own.bits.of(facts))

    @property
    def start(self) -> State | None:
        """The state from which the human's plan is predicted, after the head start; None: it ends before."""
        return self._task.init

    def predicted(self) -> tuple[Fraction, int] | None:
        """:meth:`optimum` from there, with what is paid before; None too where there is no such state."""
        state = self.start
        found = None if state is None else self.optimum(state)
        return None if found is None else (found[0] + self.paid_before, found[1])

    @property
    def paid_before(self) -> Fraction:
        """What the head start costs: who begins anything after it has waited for it (semantics 10.2).

        It is over when the plan is predicted.  Of equal plans the one of fewer actions is, so that nobody
        acts who gets as much by resting.
        """
        state = self.start
        if state is None or not self.head_start_cost:
            return Fraction(0)
        acts = self.optimum(state) != self.optimum(state - awake(self._task))
        return self.head_start_cost if acts else Fraction(0)

    def moves(self, state: State) -> Iterator[tuple[int, State]]:
        """What the human can begin alone, by ids, each with the state after the epoch."""
        for i in self.deadline.each(self._task.human_actions):
            action = self._task.actions[i]
            if applicable(action, state):
                yield i, after(state, action)

    def graph(self) -> Graph:
        """Where plans begin, what follows at what weight, and which ends one."""
        return self.own.bits.of(self._task.init), self.own.moves, self.own.goal.holds

    def optimum(self, state: State) -> tuple[Fraction, int] | None:
        """Least (cost, number of actions) from ``state``; None if the human can't reach ``G_H`` alone."""
        weight = self.weight(state)
        return None if weight is None else self.own.split(weight)

    def weight(self, state: State) -> int | None:
        """What :meth:`optimum` weighs (see :class:`OwnActions`), with the same errors."""
        if self._task.goal.holds(state):
            return 0
        key = self.sight(state)
        if key not in self._known:
            enough = self._enough.get(key)
            weight = self._least(state, enough)
            self._known[key] = enough if weight is None else weight
        return self._known[key]

    def sight(self, state: State) -> int | State:
        """What makes a difference to the human alone in a state."""
        return self.own.bits.of(state)

    def suppose(self, plan: HumanPlan) -> None:
        """Take a plan from the initial state to the goal for optimal, until a cheaper one is found."""
        self._enough[self.sight(self._task.init)] = sum(self.own.weight(i) for i in plan)

    def within(self, state: State, most: int) -> bool:
        """Whether the optimum from a state weighs no more than this; often easier to say."""
        if most < 0 or self._task.goal.holds(state):
            return most >= 0
        key = self.sight(state)
        if key not in self._known and self._above.get(key, -1) < most:
            weight = self._least(state, most + 1)
            if weight is None:
                self._above[key] = most
            else:
                self._known[key] = weight
        found = self._known.get(key)
        return found is not None and found <= most

    def learn(self, plan: HumanPlan) -> None:
        """An optimal plan from ``I`` on is optimal from each state that it leads through: no need to search.

        Args:
            plan: one that can be executed and reaches the goal; another than an optimal one teaches nothing.
        """
        weights = [self.own.weight(i) for i in plan]
        rest = sum(weights)
        if self.weight(self._task.init) != rest:
            return
        for weight, state in zip((*weights, 0), states_of_pi_h(self._task, plan, self.deadline), strict=True):
            self._known.setdefault(self.sight(state), rest)
            rest -= weight

    @during(SEARCHING)
    def _least(self, state: State, below: int | None) -> int | None:
        """The least weight of a plan from a state; None: there is none, or none below."""
        start, own = self.own.bits.of(state), self.own
        search = PathSearch(start, own.moves, self._projection.bound, self.deadline, below)
        many, most = 0 if self._long else limits().many_own_states, limits().own_states
        for expansions, (here, _) in enumerate(search):
            if own.goal.holds(here):
                return search.distance[here]
            if expansions == many:
                if not self._long and not own.may_reach_goal(start, self.deadline):
                    return None
                packed = self._packed_least(state, below)
                if packed is not None:
                    return packed if packed >= 0 else None
            if expansions >= most:
                raise HumanTooLargeError
        return None

    def _packed_least(self, state: State, below: int | None) -> int | None:
        """The same by packed states; -1 where there is no plan, None where that is no way to answer."""
        problem = self.packed
        start = None if problem is None else problem.pack([state])
        if problem is None or start is None:
            return None
        from verify.packed import cheapest_path

        self._long = True
        try:
            weight = problem.least(start, below)
        except cheapest_path.SumTooLargeError:
            self._long = False
            return None
        except cheapest_path.TooManyPackedStatesError:
            raise HumanTooLargeError from None
        return -1 if weight is None else weight

    @cached_property
    def packed(self) -> "PackedProblem | None":
        """The human's own problem over packed states; None where it is too large for that."""
        from verify.packed.operators import PackedOperator  # loads numpy, which few calls need
        from verify.packed.problem import PackedProblem, StateSpace, TooLargeError

        task, own = self._task, self.own
        try:
            space = StateSpace(len(task.facts), task.init, task.actions, self.deadline)
            operators = [
                PackedOperator(a.pre, a.neg, a.add, a.delete, weight)
                for a, weight, _ in (whole for i in self.deadline.each(own.ids) for whole in own.wholes(i))
            ]
            goal = task.goal.positive, task.goal.negative
            return PackedProblem(space, own.facts, operators, goal, self.deadline)
        except TooLargeError:
            return None
