"""Observations by brute force, with time or without: the cheapest plans that embed them, and that do not."""

import heapq
from collections.abc import Sequence
from fractions import Fraction

from serendipity.model import Condition, Task
from serendipity_testing.oracle.alone import Alone
from serendipity_testing.oracle.moments import Moment


def costs_of_observed(
    task: Task,
    goal: Condition,
    observed: Sequence[str],
    waiting_cost: Fraction = Fraction(0),
    *,
    strict: bool = False,
) -> tuple[Fraction | None, Fraction | None]:
    """``cost(G, O)`` and ``cost(G, not O)`` (semantics 8), each None where there is no such plan.

    Args:
        task: the task.
        goal: what the human may want.
        observed: names of actions that they began, in order.
        waiting_cost: of an epoch of waiting before an action.
        strict: whether interference is strict.
    """
    alone = Alone(task.with_goal(goal), waiting_cost, strict=strict)
    least: dict[bool, Fraction] = {}
    seen: set[tuple[Moment, int, int, bool]] = set()
    queue = [(Fraction(0), 0, 0, Moment(task.init), 0, False)]
    ticket = 0
    while queue:
        cost, _, epoch, now, count, waits = heapq.heappop(queue)
        at = (now, min(epoch, alone.world.settled), count, waits)
        if at in seen:
            continue
        seen.add(at)
        if not waits and alone.resting(now, epoch) is not None:
            least.setdefault(count == len(observed), cost)
        for way in alone.ways(now, epoch):
            name = None if way.action is None else task.actions[way.action].name
            more = count + (count < len(observed) and name == observed[count])
            ticket += 1
            waited = way.action is None
            heapq.heappush(queue, (cost + way.price[0], ticket, way.epoch, way.moment, more, waited))
    return least.get(True), least.get(False)
