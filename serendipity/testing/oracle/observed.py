"""Observations by brute force, with time or without: the cheapest plans that embed them, and that do not."""

import heapq
from collections.abc import Sequence
from fractions import Fraction

from serendipity.model import Condition, Task
from serendipity.testing.oracle.alone import Alone
from serendipity.testing.oracle.moments import Moment


def costs_of_observed(
    task: Task, goal: Condition, observed: Sequence[str], *, strict: bool = False
) -> tuple[Fraction | None, Fraction | None]:
    """``cost(G, O)`` and ``cost(G, not O)`` (semantics 8), each None where there is no such plan.

    Args:
        task: the task.
        goal: what the human may want.
        observed: names of actions that they began, in order.
        strict: whether interference is strict.
    """
    alone = Alone(task.with_goal(goal), strict=strict)
    least: dict[bool, Fraction] = {}
    seen: set[tuple[Moment, int, int]] = set()
    queue = [(Fraction(0), 0, 0, Moment(task.init), 0)]
    ticket = 0
    while queue:
        cost, _, epoch, now, count = heapq.heappop(queue)
        at = (now, min(epoch, alone.world.settled), count)
        if at in seen:
            continue
        seen.add(at)
        if alone.is_over(now, epoch):
            least.setdefault(count == len(observed), cost)
        for way in alone.ways(now, epoch):
            name = None if way.action is None else task.actions[way.action].name
            more = count + (count < len(observed) and name == observed[count])
            ticket += 1
            heapq.heappush(queue, (cost + way.price[0], ticket, way.epoch, way.moment, more))
    return least.get(True), least.get(False)
