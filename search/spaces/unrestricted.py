"""Communication and composite planning: no prefix, no window (semantics 3.4, Def. 1.1)."""

from collections.abc import Iterator
from dataclasses import dataclass

from search.bounds.first_interaction import Bounds
from search.engine.best_first import Incumbent, Node
from search.engine.dominance import ParetoFront
from search.packed.cost_vector import CostLayout
from search.packed.joint_actions import JointAction
from search.packed.packed_task import PackedGoal
from search.packed.successor_generator import Successors

UNTOUCHED, TOUCHED = 0, 1
"""Phases: before and after the human's first touch."""


@dataclass(kw_only=True, eq=False)
class Unrestricted:
    """The search space of composite plans.

    Attributes:
        initial: packed initial state.
        horizon: number of epochs ``T``, or None for any.
        most_cost: largest scaled cost of an acceptable plan, or None.
        goals: what has to hold at the end.
        successors: what agents can do in an epoch.
        bounds: lower bounds on what still has to be paid.
        labels: which nodes make others superfluous.
    """

    initial: int
    horizon: int | None
    most_cost: int | None
    goals: tuple[PackedGoal, ...]
    keys: CostLayout
    successors: Successors
    bounds: Bounds
    labels: ParetoFront

    def roots(self) -> Iterator[tuple[int, Node]]:
        """The initial state."""
        self.labels.add(self.initial, 0, 0)
        yield self.bounds.untouched(0, self.initial, 0, ()), Node(0, 0, self.initial, UNTOUCHED, 0, None, ())

    def alive(self, node: Node) -> bool:
        """Whether no cheaper node that is as early makes this one superfluous."""
        return self.labels.alive(node.state, node.epoch, node.key)

    def expand(self, node: Node, best: Incumbent) -> Iterator[tuple[int, Node]]:
        """Successors of a node; those in which the goals hold are offered to ``best``."""
        if node.parent is None:
            self._offer(node, best)
        epoch = node.epoch if self._in_turn else node.epoch + 1
        if self.horizon is not None and epoch > self.horizon:
            return
        bounds = self.bounds
        for part, option in self._together(node.state):
            after = node.state & option.keep | option.put
            key = node.key + option.weight
            bound = key + bounds.private(after)
            if bound >= best.key or self.keys.exceeds(bound, self.most_cost) or self._is_idle(node, option):
                continue
            if self.horizon is not None and epoch + bounds.steps(after) > self.horizon:
                continue
            touched = node.phase == TOUCHED or bounds.interactions(part.actions)
            if not touched:
                bound = max(bound, key + bounds.untouched(epoch, after, key, ()))
            bound = max(bound, key + bounds.team(after))
            if bound >= best.key:
                continue
            if self.labels.add(after, epoch, key):
                child = Node(key, epoch, after, TOUCHED if touched else UNTOUCHED, 0, node, option.actions)
                if not self._offer(child, best):
                    yield bound, child

    @property
    def _in_turn(self) -> bool:
        """Whether epochs don't count: what happens in one could as well happen one after the other."""
        return self.horizon is None and not self.successors.in_time

    def _is_idle(self, node: Node, option: JointAction) -> bool:
        """Whether an epoch changes nothing: nobody acts, and nothing happens by itself."""
        return not option.actions and self.successors.due.is_calm(node.state)

    def _offer(self, node: Node, best: Incumbent) -> bool:
        """Whether a plan ends at the node (going on could only cost more)."""
        if node.key >= best.key or not all(goal.holds(node.state) for goal in self.goals):
            return False
        if not self.successors.due.may_end(node.state, node.epoch, self.horizon):
            return False  # it will be offered later
        best.key, best.node = node.key, node
        return True

    def _together(self, state: int) -> Iterator[tuple[JointAction, JointAction]]:
        """The human's part of each action set, and the whole set."""
        successors = self.successors
        if self._in_turn:
            yield from successors.in_turn(state)
            return
        for part in successors.free(state):
            for option in successors.with_robots(part, state):
                yield part, option
