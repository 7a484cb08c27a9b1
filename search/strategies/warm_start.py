"""Warm starts: an answer that is known before a call begins, and a lower bound on all answers.

A control loop asks again and again.  What is left of an answer after an epoch is an answer to the
next call as often as not; whether it is, is found out here, by the rules of that call.
"""

from contextlib import suppress
from dataclasses import dataclass
from fractions import Fraction

from search.call.context import SearchContext
from search.engine.best_first import Incumbent, Node
from search.packed.cost_vector import INFINITE_KEY
from search.packed.operators import Operator, applicable
from search.spaces.factory import suffix_rule
from serendipity.model.errors import LimitReachedError
from serendipity.model.options import INFINITE
from serendipity.model.task.plans import Step, Window
from serendipity.model.task.task import HumanPlan

_SHARE = 0.3
"""What of the time that is left it may take to work out what the human does after the window."""


@dataclass(frozen=True, slots=True)
class WarmStart:
    """A plan and a bound that are known before a call begins.

    Attributes:
        steps: a plan; whether it is one here is to be found out.
        window: its window, or None.
        is_sure: what the human does after the window is known to be optimal from there.
        bound: no plan within ``horizon`` has a smaller objective, its window included; None: not known.
        is_best: beside that, none of that objective is better in any other respect.
        horizon: ``T`` that the bound is for, or less.
    """

    steps: tuple[Step, ...] = ()
    window: Window | None = None
    is_sure: bool = False
    bound: Fraction | None = None
    is_best: bool = False
    horizon: int | str | None = None

    def least(self, horizon: int | str) -> Fraction | None:
        """The bound, if it is one for ``T``."""
        known = self.horizon
        covers = known == INFINITE or (
            isinstance(known, int) and isinstance(horizon, int) and horizon <= known
        )
        return self.bound if covers else None


def replayed(
    context: SearchContext, plan: HumanPlan, horizon: int | None, most_cost: int | None, warm: WarmStart
) -> Incumbent | None:
    """The known plan as an incumbent, by the rules of the call; None where it breaks one of them.

    Args:
        plan: ``pi_H``; empty where there is none.
        horizon: ``T``, or None where it is infinite.
        most_cost: largest scaled cost of an acceptable plan, or None.
    """
    if not warm.steps or (warm.window is None) == context.options.windowed:
        return None  # without a window there, it is what the call begins with anyway
    if not all(context.packed.is_useful(step.action) for step in warm.steps):
        return None
    window = warm.window
    try:
        part = context.under(context.deadline.part(_SHARE))
        found = _in_order(part, plan, warm) if window is None else _around(part, plan, horizon, warm, window)
    except LimitReachedError:
        context.deadline.check()
        return None
    if found is None or found.node is None or context.keys.exceeds(found.key, most_cost):
        return None
    return found if horizon is None or found.node.epoch + len(found.tail) <= horizon else None


def warm_plan(context: SearchContext, warm: WarmStart) -> HumanPlan | None:
    """The known plan as one of the human's alone; None where it is none, or there is none."""
    task, plan = context.task, tuple(step.action for step in warm.steps)
    own = all(task.actions[i].participants == (task.human,) and context.packed.is_useful(i) for i in plan)
    if not plan or not own:
        return None
    node = _followed(context, plan, warm, max(step.epoch for step in warm.steps), 0)
    return plan if node is not None and context.packed.goal.holds(node.state) else None


def _in_order(context: SearchContext, plan: HumanPlan, warm: WarmStart) -> Incumbent | None:
    """A plan without a window."""
    node = _followed(context, plan, warm, max(step.epoch for step in warm.steps), 0)
    if node is None or not all(goal.holds(node.state) for goal in context.goals):
        return None
    return Incumbent(node.key, node)


def _around(
    context: SearchContext, plan: HumanPlan, horizon: int | None, warm: WarmStart, window: Window
) -> Incumbent | None:
    """A plan with a window, and the human's own optimal plan behind it."""
    node = _followed(context, plan, warm, window.end - 1, window.start)
    if node is None or horizon is None or node.epoch > horizon or window.start > len(plan):
        return None
    if len(window) > (context.options.max_window or len(window)):
        return None
    tail = tuple(step.action for step in warm.steps if step.epoch >= window.end)
    keys, options = context.keys, context.options
    is_sure = warm.is_sure and options.suffix == "replan" and options.preservation == "kernel"
    is_sure = is_sure and not context.weights.announces
    if is_sure:
        with suppress(LimitReachedError):
            context.alone.proved(node.state, tail)
    if is_sure and not context.task.robot_goal:  # then it takes no table, for which there may be no time
        rest = sum(option.weight for _, option in context.followed(tail))
    else:
        suffix, left = suffix_rule(context, plan), horizon - node.epoch
        rest = suffix.key(node.state, left, window.start, INFINITE_KEY)
        if rest >= INFINITE_KEY:
            return None
        tail = tail if is_sure else suffix.actions(node.state, left, window.start)
    key = node.key + keys.of_start(window.start, horizon) + len(window) * keys.epoch_weight
    return Incumbent(key + rest, node._replace(key=key), node.epoch + 1, tail)


def _followed(context: SearchContext, plan: HumanPlan, warm: WarmStart, last: int, start: int) -> Node | None:
    """The node after some epochs of the known plan; None where one is impossible, or breaks the prefix.

    Args:
        last: the last of these epochs.
        start: the first epoch of the window; 0 without one.
    """
    node = context.root._replace(start=start)
    for ops in context.by_epoch(warm.steps, last):
        epoch = node.epoch + 1
        if not all(applicable(op, node.state) for op in ops):
            return None
        if epoch < start and not _keeps_to(context, plan, epoch, ops):
            return None
        node = context.after(node, ops)
    return node


def _keeps_to(context: SearchContext, plan: HumanPlan, epoch: int, ops: list[Operator]) -> bool:
    """Whether the human does in an epoch before the window what they may do there (semantics 3.1, 3.4)."""
    human = context.packed.human_bit
    his = [op for op in ops if op.agents & human]
    if context.options.keep_prefix:
        names = context.task.names(plan)
        return all(op.agents == human and context.task.actions[op.action].name in names for op in his)
    return [op.action for op in his] == list(plan[epoch - 1 : epoch])
