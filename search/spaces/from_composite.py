"""Answers that a composite plan suggests: agents act as it says for a while, then the human goes on alone."""

from collections.abc import Iterator, Sequence
from itertools import accumulate, combinations

from search.call.context import SearchContext
from search.engine.best_first import Incumbent, Node
from search.packed.cost_vector import INFINITE_KEY
from search.packed.operators import Operator, applicable, changed
from search.spaces.factory import suffix_rule
from serendipity.model.task.plans import Step
from serendipity.model.task.task import HumanPlan


class Suggestions:
    """Incumbents of a mode from composite plans; each one beats those before it.

    Args:
        context: of the call; nothing is announced, and ``pi_H`` need not be kept to out of order.
        plan: ``pi_H``; empty where there is none.
        most_cost: largest scaled cost of an acceptable plan, or None.
        limit: key that they have to beat.
    """

    def __init__(
        self, context: SearchContext, plan: HumanPlan, horizon: int, most_cost: int | None, limit: int
    ) -> None:
        self._context = context
        self._plan = [context.packed.op(action) for action in plan]
        self._horizon = horizon
        self._most_cost = most_cost
        self._limit = limit
        self._suffix = suffix_rule(context, plan)

    def of(self, steps: Sequence[Step]) -> Iterator[Incumbent]:
        """What a composite plan suggests."""
        epochs = self._context.by_epoch(steps, max((step.epoch for step in steps), default=0))
        if not self._context.options.windowed:
            yield from self._whole(epochs)
        if self._plan:
            yield from self._cut_short(epochs)
            yield from self._beside([op for ops in epochs for op in ops])

    def _whole(self, epochs: list[list[Operator]]) -> Iterator[Incumbent]:
        """The plan itself."""
        node = self._context.played(epochs[: self._horizon])
        if all(goal.holds(node.state) for goal in self._context.goals):
            yield from self._better(node.key, Incumbent(node.key, node))

    def _cut_short(self, epochs: list[list[Operator]]) -> Iterator[Incumbent]:
        """The plan up to an epoch; the window opens where the human leaves ``pi_H``."""
        human, node, followed = self._context.packed.human_bit, self._context.root, True
        start = 1
        for ops in epochs[: self._horizon]:
            node = self._context.after(node, ops)
            planned = self._plan[start - 1 : start]
            yield from self._ended(node._replace(start=start))
            followed = followed and [op for op in ops if op.agents & human] == planned
            if followed and start < len(self._plan):
                start += 1

    def _beside(self, ops: Sequence[Operator]) -> Iterator[Incumbent]:
        """What robots do of some actions while the human follows ``pi_H``; a window of one epoch."""
        human, node = self._context.packed.human_bit, self._context.root
        left = [op for op in ops if not op.agents & human]
        for epoch in range(1, min(len(self._plan), self._horizon) + 1):
            freely = self._chosen(node.state, epoch, left, keeps=False)
            yield from self._ended(self._context.after(node, freely)._replace(start=epoch))
            careful = self._chosen(node.state, epoch, left, keeps=True)
            node = self._context.after(node, careful)
            for op in careful[1:]:
                left.remove(op)

    def on_time(self, epochs: Sequence[Sequence[Operator]]) -> Iterator[Incumbent]:
        """What robots do in each epoch, while the human follows ``pi_H``; the last one is the window.

        In it the human does the next step of ``pi_H``, or begins what they do alone after it, or waits.
        """
        node = self._context.root
        for number, ops in enumerate(epochs[:-1]):
            together = [self._plan[number], *ops]
            if not self._fit(node.state, together):
                return
            node = self._context.after(node, together)
        last = list(epochs[-1])
        for op in self._in_window(node.state, len(epochs), last):
            together = last if op is None else [op, *last]
            if self._fit(node.state, together):
                yield from self._ended(self._context.after(node, together)._replace(start=len(epochs)))

    def exactly(self, epochs: Sequence[Sequence[Operator]]) -> Iterator[Incumbent]:
        """What all agents do in each epoch; the last one is the window."""
        yield from self._ended(self._context.played(epochs)._replace(start=len(epochs)))

    def _in_window(self, state: int, epoch: int, ops: list[Operator]) -> Iterator[Operator | None]:
        """What the human may do in a window of one epoch."""
        yield None
        yield self._plan[epoch - 1]
        after = changed(state, ops)
        if self._suffix.key(after, self._horizon, epoch, INFINITE_KEY) < INFINITE_KEY:
            for action in self._suffix.actions(after, self._horizon, epoch)[:1]:
                yield self._context.packed.op(action)

    def _fit(self, state: int, ops: Sequence[Operator]) -> bool:
        """Whether ops may happen in one epoch."""
        strict = self._context.options.strict
        pairs = combinations(ops, 2)
        return all(applicable(op, state) for op in ops) and all(
            self._context.packed.compatible(a.action, b.action, strict) for a, b in pairs
        )

    def _chosen(self, state: int, epoch: int, left: list[Operator], *, keeps: bool) -> list[Operator]:
        """The human's step of ``pi_H``, and what robots, each in its order, can do of what is left.

        Args:
            left: what robots have not done yet.
            keeps: whether the rest of ``pi_H`` stays applicable.
        """
        context, chosen = self._context, [self._plan[epoch - 1]]
        busy = chosen[0].agents
        for op in left:
            context.deadline.check()
            if not op.agents & busy and applicable(op, state):
                strict = context.options.strict
                fits = all(context.packed.compatible(op.action, one.action, strict) for one in chosen)
                if fits and (not keeps or self._goes_on(changed(state, [*chosen, op]), epoch)):
                    chosen.append(op)
            busy |= op.agents
        return chosen

    def _goes_on(self, state: int, epoch: int) -> bool:
        """Whether the rest of ``pi_H`` is applicable after an epoch."""
        rest = self._plan[epoch:]
        states = accumulate(rest, lambda before, op: changed(before, [op]), initial=state)
        return all(map(applicable, rest, states))

    def _ended(self, node: Node) -> Iterator[Incumbent]:
        """Offer the plan in which the human goes on alone after a node, with its window if there is one."""
        context, start = self._context, node.start
        key, length = node.key, node.epoch - start + 1
        if context.options.windowed:
            if length > (context.options.max_window or length):
                return
            key += context.keys.of_start(start, self._horizon) + length * context.keys.epoch_weight
        left = self._horizon - node.epoch
        limit = self._limit - key
        if limit <= 0:
            return
        rest = self._suffix.key(node.state, left, start, limit)
        if rest >= min(limit, INFINITE_KEY):
            return
        tail = self._suffix.actions(node.state, left, start)
        if context.options.windowed:
            found = Incumbent(key + rest, node._replace(key=key), node.epoch + 1, tail)
        else:
            for action in tail:
                node = self._context.after(node, [context.packed.op(action)])
            found = Incumbent(node.key, node)
        yield from self._better(key + rest, found)

    def _better(self, key: int, found: Incumbent) -> Iterator[Incumbent]:
        if key < self._limit and not self._context.keys.exceeds(key, self._most_cost):
            self._limit = key
            yield found
