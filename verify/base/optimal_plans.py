"""The human's optimal plans from any state, robots idle: predictions of ``pi_H``, replanning.

*Optimal* is least cost, then fewest actions (semantics 1).
"""

from collections.abc import Callable, Iterable, Iterator, Sequence
from fractions import Fraction
from heapq import heappop, heappush
from typing import TypeVar

from serendipity.model import Condition, HumanPlan, Task
from verify.base.due import onward, waited
from verify.base.execution import State, idling
from verify.base.individual import IndividualOptimum

P = TypeVar("P")


def along(
    start: P, onward: Callable[[P], Iterable[tuple[int, P]]], is_end: Callable[[P], bool]
) -> Iterator[HumanPlan]:
    """Plans that lead from a place to an end, in the order of the actions that lead on from each."""
    if is_end(start):
        yield ()
    plan, left = list[int](), [iter(onward(start))]
    while left:
        step = next(left[-1], None)
        if step is None:
            left.pop()
            del plan[-1:]
            continue
        plan.append(step[0])
        left.append(iter(onward(step[1])))
        if is_end(step[1]):
            yield tuple(plan)


class OptimalPlans:
    """The human's optimal plans, from what the rule checker knows of their cost.

    All but :meth:`cost_of` raise a TooManyStatesError, or a LimitReachedError at the deadline of ``alone``.
    """

    def __init__(self, task: Task, alone: IndividualOptimum | None = None) -> None:
        self._task = task
        self.alone = IndividualOptimum(task) if alone is None else alone
        self.deadline = self.alone.deadline

    def cost(self, state: State) -> Fraction | None:
        """``h``: the least cost; None for infinity."""
        worth = self.alone.optimum(state)
        return None if worth is None else worth[0]

    def cost_of(self, plan: Sequence[int], state: State, *, strict: bool = False) -> Fraction | None:
        """``c``: what a plan costs if it works from a state, robots idle; None for infinity."""
        total, here = Fraction(0), state
        for i in plan:
            after = onward(self._task, here, (i,), strict=strict)
            if after is None:
                return None
            total, here = total + self._task.actions[i].cost, after
        return total if self._task.goal.holds(here) else None

    def canonical(self, state: State | None = None) -> HumanPlan | None:
        """The plan that semantics 1 predicts from a state; None if the human can't reach their goal."""
        return next(self.plans(state), None)

    def plans(self, state: State | None = None) -> Iterator[HumanPlan]:
        """All optimal plans from a state, or the initial one; the canonical one first."""
        start = self._task.init if state is None else state
        return along(start, self.steps, lambda here: self.alone.weight(here) == 0)

    def steps(self, state: State) -> Iterator[tuple[int, State]]:
        """Actions that start an optimal plan from ``state``, in string order, with their results.

        Of several with one name, which are variants of one action, the first.
        """
        last, least = None, self.alone.weight(state)
        for i, successor in self.alone.moves(state) if least else ():
            assert least is not None
            name = self._task.actions[i].name
            if name != last and self.alone.within(successor, least - self.alone.own.weight(i)):
                last = name
                yield i, successor

    def earliest(self, state: State) -> Iterator[HumanPlan]:
        """All optimal plans in time from a state; of those that begin the same, who does so earliest.

        Who acts comes before who waits, so of plans of equal names that one is met first (semantics 10.3).
        """
        names, waiting = [action.name for action in self._task.actions], idling(self._task)
        seen, found = set[tuple[tuple[str, ...], State]](), set[tuple[str, ...]]()
        left: list[tuple[HumanPlan, State]] = [] if self.alone.optimum(state) is None else [((), state)]
        while left:
            plan, here = left.pop()
            acted = tuple(names[i] for i in plan if i not in waiting)
            if (acted, here) in seen:
                continue
            seen.add((acted, here))
            if self.alone.weight(here) == 0 and acted not in found:
                found.add(acted)
                yield plan
            left += reversed([((*plan, i), following) for i, following in self.steps(here)])

    def lasting(
        self, state: State, left: int, reached: Condition, talk: Sequence[int] = (), *, strict: bool
    ) -> HumanPlan | None:
        """The plan from a state, of the optimal ones after which something holds once some epochs are over.

        Args:
            state: in which no robot is at anything.
            left: the number of epochs; a plan has no more.
            reached: what has to hold then: a script may undo what a plan reaches.
            talk: by action what it adds to the objective; the plan of the least is the one, and of these the
                canonical one.
            strict: interference as in semantics 2, which says what disturbs a bystander.
        """
        worth, task, seen = self.alone.optimum(state), self._task, set[State]()
        queue = [] if worth is None or worth[1] > left else [(0, HumanPlan(), state)]
        while queue:
            added, plan, here = heappop(queue)
            if here in seen:
                continue
            seen.add(here)
            if task.goal.holds(here):
                end = waited(task, here, left - len(plan), strict=strict)
                if end is not None and reached.holds(end):
                    return plan
            for i, following in self.steps(here):
                heappush(queue, (added + (talk[i] if talk else 0), (*plan, i), following))
        return None
