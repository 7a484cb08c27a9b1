"""Of all cheapest plans the first: the smallest operator at each step.

Some cheapest plan is put in order first, which costs no search.  Then for each step smaller operators are
asked about: whether a cheapest plan begins with one.  One that begins none still begins none after an
operator that has nothing to do with it (sleep sets of Godefroid, Partial-Order Methods for the
Verification of Concurrent Systems, 1996).
"""

from collections.abc import Sequence
from heapq import heapify, heappop, heappush

from search.classical.planner import ClassicalPlanner
from search.packed.cost_vector import INFINITE_KEY
from search.packed.operators import Operator, asked_by
from serendipity.model.resources.deadline import Deadline


def canonical_plan(planner: ClassicalPlanner, state: int, deadline: Deadline) -> list[int] | None:
    """The cheapest plan with the smallest operators, by their numbers; None where there is no plan."""
    operators = planner.problem.operators
    left = planner.cheapest(state, deadline)
    if left >= INFINITE_KEY:
        return None
    known = planner.known_plan(state, deadline)
    if planner.is_canonical(state):
        return known
    rest = in_order(operators, known or (), deadline)
    plan: list[int] = []
    refuted: set[int] = set()
    while rest:
        for number in planner.allowed(state):
            if number >= rest[0]:
                break
            if number in refuted:
                continue
            deadline.check()
            op = operators[number]
            after, amount = state & op.keep | op.put, left - planner.amount((number,))
            may_be = amount >= 0 and planner.bound(after, deadline) <= amount
            if may_be and planner.cheapest(after, deadline, amount + 1) == amount:
                rest = [number, *in_order(operators, planner.known_plan(after, deadline) or (), deadline)]
                break
            refuted.add(number)
        chosen = operators[rest[0]]
        plan.append(rest.pop(0))
        state, left = state & chosen.keep | chosen.put, left - planner.amount(plan[-1:])
        refuted = {number for number in refuted if _independent(operators[number], chosen)}
    return plan


def in_order(operators: Sequence[Operator], plan: Sequence[int], deadline: Deadline) -> list[int]:
    """Of all orders of a plan's operators, given by their numbers, that do the same the first."""
    waits = [0] * len(plan)
    after: list[list[int]] = [[] for _ in plan]
    sets = [~operators[number].keep for number in plan]
    asks = [asked_by(operators[number]) for number in plan]
    for later in range(len(plan)):
        deadline.check()
        touches = sets[later] | asks[later]
        for earlier in range(later):
            if sets[earlier] & touches or sets[later] & asks[earlier]:
                after[earlier].append(later)
                waits[later] += 1
    ready = [(plan[place], place) for place, count in enumerate(waits) if not count]
    heapify(ready)
    found = []
    while ready:
        number, place = heappop(ready)
        found.append(number)
        for later in after[place]:
            waits[later] -= 1
            if not waits[later]:
                heappush(ready, (plan[later], later))
    return found


def _independent(a: Operator, b: Operator) -> bool:
    """Whether neither sets what the other one asks for or sets: then their order does not matter."""
    return not (~a.keep & (asked_by(b) | ~b.keep) or ~b.keep & asked_by(a))
