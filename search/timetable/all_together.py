"""Windows of one epoch, all agents at once: every state beside the human's timetable, epoch by epoch.

Where robots take from one another all the time, what each can do by itself says little.  But as long as
the human follows ``pi_H`` robots are in their way, and there may be few enough states to look at all.
"""

from bisect import bisect_left
from collections.abc import Collection, Generator
from typing import Final

from search.apart.conditions import lost_values
from search.classical.problem import ACTIONS_BITS, ClassicalProblem
from search.context import SearchContext
from search.engine.best_first import Incumbent, Progress
from search.human.own_problem import own_planner
from search.kernel.library import library
from search.packed.cost_vector import own_costs
from search.spaces.factory import suffix_rule
from search.spaces.from_composite import Suggestions
from search.timetable.epochs import Epochs
from serendipity.model.errors import LimitReachedError
from serendipity.model.task.task import HumanPlan

_SHARE: Final = 0.9
"""What of the time that is left it may take."""

_MOST_ACTIONS: Final = 2_000
"""Every pair of them is told apart."""

_MOST_AGENTS: Final = 63

_MOST_STATES: Final = 10_000_000

_MOST_COST_BITS: Final = 24
"""Of an action, so that sums of many are no more than 64 bits with a number of actions."""

_MOST_AMOUNT: Final = 1 << 62


def all_together(
    context: SearchContext, plan: HumanPlan, horizon: int, best: Incumbent, progress: Progress, longer: int
) -> Generator[Incumbent, None, None]:
    """Yield the incumbent whenever a window of one epoch has made it better; raise the bound after all.

    Args:
        context: of the call, in a mode with windows.
        plan: ``pi_H``.
        horizon: ``T``.
        best: the incumbent, which is made better.
        progress: what is known so far, which is brought up to date.
        longer: no plan with a longer window has a smaller key.

    Raises:
        LimitReachedError: the deadline of the call came, not only that of its part for this.
    """
    part = context.under(context.deadline.part(_SHARE))
    try:
        epochs = _epochs(part)
        if epochs is None:
            return
        is_whole = yield from _windows(part, epochs, plan, horizon, best)
    except LimitReachedError:
        context.deadline.check()
        return
    if is_whole:
        progress.bound = max(progress.bound, min(longer, best.key))


def _windows(
    context: SearchContext, epochs: Epochs, plan: HumanPlan, horizon: int, best: Incumbent
) -> Generator[Incumbent, None, bool]:
    """Look at all windows of one epoch, the earliest first; whether there were few enough states."""
    keys, suffix = context.keys, suffix_rule(context, plan)
    for epoch, action in enumerate(plan, 1):
        start = keys.epoch_weight + keys.of_start(epoch, horizon)
        left = epochs.leave(_amount(context, best.key - start), _MOST_STATES)
        if left is None:
            return False
        for leaving in left:
            if start + context.amount_key(leaving.total) >= best.key:
                break
            limit = best.key - start - context.amount_key(leaving.paid)
            if suffix.key(epochs.end(leaving), horizon - epoch, epoch, limit) < limit:
                suggestions = Suggestions(context, plan, horizon, None, best.key)
                for found in suggestions.exactly(epochs.ways(leaving)):
                    best.key, best.node, best.end, best.tail = found.key, found.node, found.end, found.tail
                    yield best
        limit = _amount(context, best.key - keys.epoch_weight)
        if epoch < len(plan) and not epochs.advance(context.packed.op(action), limit, _MOST_STATES):
            return False
    return True


def _flags(field: int, values: int, chosen: Collection[int]) -> bytes:
    """For each value of a field 1 if it is among some."""
    lowest = field & -field
    return bytes(value * lowest in chosen for value in range(values))


def _amount(context: SearchContext, limit: int) -> int:
    """The least amount of which the key is not below a limit."""
    return bisect_left(range(_MOST_AMOUNT), limit, key=context.amount_key)


def _epochs(context: SearchContext) -> Epochs | None:
    """What the kernel looks at; None where it can't, or the mode's rules are others."""
    options, packed, kernel = context.options, context.packed, library()
    operators = (*packed.own, *packed.joint, *packed.others)
    if kernel is None or len(operators) > _MOST_ACTIONS or len(context.task.agents) > _MOST_AGENTS:
        return None
    plain = options.suffix == "replan" and options.preservation == "kernel" and not options.keep_prefix
    if not plain or options.max_cost is not None or context.task.robot_goal or context.weights.announces:
        return None
    after = own_planner(packed, packed.goal, context.relevant, context.deadline)
    costs = [context.weights.scaled_cost(op) for op in operators]
    if after is None or max(costs).bit_length() > _MOST_COST_BITS:
        return None
    fields = tuple((field, len(packed.values(field))) for field in packed.fields)
    weights = tuple((cost << ACTIONS_BITS) + 1 for cost in costs)
    problem = ClassicalProblem(fields, operators, weights, packed.goal, 1)
    own, lost = own_costs(packed), lost_values(packed)
    dead = b"".join(_flags(field, values, lost.get(field, ())) for field, values in fields)
    ratio = next((context.weights.scaled_cost(op) // own[op.cost] for op in packed.own if own[op.cost]), 1)
    return Epochs(
        kernel,
        context.task,
        problem,
        after,
        dead,
        after.problem.unit * ratio,
        packed.init,
        context.deadline,
        strict=options.strict,
    )
