"""The human executes ``pi_H`` exactly while robots, without the human, see to ``G_R`` (semantics 3.1)."""

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import accumulate

from search.call.context import SearchContext
from search.engine.best_first import Incumbent, Node, solve_space
from search.packed.joint_actions import NOTHING, JointAction
from search.packed.operators import Operator, applicable
from search.packed.packed_task import PackedGoal
from search.packed.successor_generator import Successors
from serendipity.model.task.task import HumanPlan


@dataclass(kw_only=True, eq=False)
class FixedHumanPlan:
    """The search space of plans in which the human does not deviate.

    Attributes:
        initial: packed initial state.
        horizon: number of epochs ``T``, or None for any.
        steps: the human's packed actions and what they do, in order.
        goals: what has to hold at the end.
        successors: what agents can do in an epoch.
        begins: the number of epochs that are over.
    """

    initial: int
    horizon: int | None
    steps: list[tuple[Operator, JointAction]]
    goals: tuple[PackedGoal, ...]
    successors: Successors
    begins: int = 0

    def __post_init__(self) -> None:
        self._best: dict[tuple[int, int], int] = {}
        weights = [option.weight for _, option in reversed(self.steps)]
        self._rest = list(accumulate(weights, initial=0))[::-1]

    def roots(self) -> Iterator[tuple[int, Node]]:
        """The initial state."""
        self._best[self.begins, self.initial] = 0
        yield self._left(self.begins), Node(0, self.begins, self.initial, 0, 0, None, ())

    def alive(self, node: Node) -> bool:
        """Whether the state was not reached cheaper in the same epoch."""
        return self._best[self._told(node.epoch), node.state] == node.key

    def expand(self, node: Node, best: Incumbent) -> Iterator[tuple[int, Node]]:
        """Successors of a node; it is offered to ``best`` where ``pi_H`` is over and goals hold."""
        done = node.epoch >= len(self.steps)
        reached = done and node.key < best.key and all(goal.holds(node.state) for goal in self.goals)
        if reached and self.successors.due.may_end(node.state, node.epoch, self.horizon):
            best.key, best.node = node.key, node
        if node.epoch == self.horizon:
            return
        epoch = node.epoch + 1
        part = NOTHING
        if not done:
            op, part = self.steps[node.epoch]
            if not applicable(op, node.state):
                return
        for option in self.successors.with_robots(part, node.state):
            state = node.state & option.keep | option.put
            key = node.key + option.weight
            if key < self._best.get((self._told(epoch), state), best.key):
                self._best[self._told(epoch), state] = key
                yield key + self._left(epoch), Node(key, epoch, state, 0, 0, node, option.actions)

    def _told(self, epoch: int) -> int:
        """An epoch, as far as it matters: without a horizon not after the end of ``pi_H``."""
        return min(epoch, len(self.steps)) if self.horizon is None else epoch

    def _left(self, epoch: int) -> int:
        """What the rest of the human's plan costs after an epoch."""
        return self._rest[epoch] if epoch < len(self.steps) else 0


def follow_plan(context: SearchContext, plan: HumanPlan, horizon: int | None, best: Incumbent) -> None:
    """Make an incumbent the best plan in which the human does exactly ``pi_H``.

    Args:
        plan: ``pi_H``, which fits ``T``.
        horizon: ``T``, or None where it is infinite.
        best: the incumbent, of an infinite key.
    """
    steps = context.followed(plan)
    if not context.task.robot_goal:
        best.key = sum(option.weight for _, option in steps)
        return
    space = FixedHumanPlan(
        initial=context.packed.init,
        horizon=horizon,
        steps=steps,
        goals=context.goals,
        successors=context.successors(),
    )
    solve_space(space, best, context.deadline)
