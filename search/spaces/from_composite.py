"""A composite plan as an incumbent of a mode: if it keeps the mode's rules, with the least window it fits."""

from collections.abc import Sequence

from search.context import SearchContext
from search.engine.best_first import Incumbent, Node
from search.packed.operators import Operator
from serendipity.model.task.plans import Step
from serendipity.model.task.task import HumanPlan


def as_incumbent(
    context: SearchContext, steps: Sequence[Step], plan: HumanPlan, horizon: int
) -> Incumbent | None:
    """The plan as an incumbent, or None where it breaks a rule.

    Args:
        context: of the call.
        steps: a composite plan, some action in each of its epochs.
        plan: ``pi_H``.
        horizon: ``T``.
    """
    epochs = _epochs(context, steps)
    if len(epochs) > horizon or (context.options.windowed and not plan):
        return None
    if not context.options.windowed:
        node = _nodes(context, epochs, 0)
        return Incumbent(node.key, node)
    start = min(_prefix(context, epochs, plan), len(plan) - 1) + 1
    end = max(_robots_last(context, epochs) + 1, start)
    node = _nodes(context, epochs[:end], start, waiting=max(0, end - len(epochs)))
    tail = [op for ops in epochs[end:] for op in ops]
    rest = sum(map(context.weights.team, tail))
    if context.alone.key(node.state) != rest:
        return None
    opened = context.keys.of_start(start, horizon) + (end - start + 1) * context.keys.epoch_weight
    key = node.key + opened + rest
    return Incumbent(key, node, end + 1, tuple(op.action for op in tail))


def _epochs(context: SearchContext, steps: Sequence[Step]) -> list[list[Operator]]:
    last = max((step.epoch for step in steps), default=0)
    found: list[list[Operator]] = [[] for _ in range(last)]
    for step in steps:
        found[step.epoch - 1].append(context.packed.op(step.action))
    return found


def _prefix(context: SearchContext, epochs: list[list[Operator]], plan: HumanPlan) -> int:
    """In how many epochs the human does what is planned, and nothing jointly."""
    human = context.packed.human_bit
    for epoch, (ops, planned) in enumerate(zip(epochs, plan, strict=False)):
        if [op.action for op in ops if op.agents & human] != [planned]:
            return epoch
    return min(len(epochs), len(plan))


def _robots_last(context: SearchContext, epochs: list[list[Operator]]) -> int:
    """The last epoch, from 0, in which a robot takes part; -1 without one."""
    human = context.packed.human_bit
    return max((t for t, ops in enumerate(epochs) if any(op.agents & ~human for op in ops)), default=-1)


def _nodes(context: SearchContext, epochs: list[list[Operator]], start: int, waiting: int = 0) -> Node:
    """The node after some epochs; in the last ones of them all may wait."""
    node = Node(0, 0, context.packed.init, 0, start, None, ())
    for ops in [*epochs, *([] for _ in range(waiting))]:
        state, key = node.state, node.key
        for op in ops:
            state = state & op.keep
        for op in ops:
            state |= op.put
            key += context.weights.team(op)
        node = Node(key, node.epoch + 1, state, 0, start, node, tuple(op.action for op in ops))
    return node
