"""One candidate goal beside a robots' plan that is played epoch by epoch.

All that can have happened so far, if this is the human's goal, is kept as labels: they still
follow their plan, they are inside a window, or their window is over.  Labels of the same state
and phase differ in their keys only, and the smallest is enough.
"""

from dataclasses import dataclass
from typing import NamedTuple

from search.call.context import SearchContext
from search.engine.best_first import Node
from search.packed.cost_vector import INFINITE_KEY
from search.packed.joint_actions import NOTHING, JointAction
from search.packed.operators import applicable
from search.packed.successor_generator import Successors
from search.spaces.factory import suffix_rule
from search.spaces.windowed import PREFIX, WINDOW
from serendipity.model.task.task import HumanPlan

_Place = tuple[int, int]
"""Packed state, and the window's start where that tells labels apart."""


class Ended(NamedTuple):
    """A complete timeline: its last node with robots in it, and what the human does after that."""

    key: int
    node: Node
    end: int
    """First epoch of the suffix, 0 where the human's plan is left alone."""
    tail: tuple[int, ...]


@dataclass(frozen=True, slots=True)
class Situation:
    """All that can have happened after some epochs.

    Attributes:
        follows: the human has followed their plan all the time; None if robots made that impossible.
        inside: the window is open.
        ended: the best of the windows that are over; robots must not act any more.
        bound: no completion has a smaller key.
    """

    follows: Node | None
    inside: dict[_Place, Node]
    ended: Ended | None
    bound: int


class GoalTimeline:
    """Rules 1-3 of semantics 3.1 for one candidate.

    Args:
        context: of the call, with the candidate for a goal; all candidates share a packing.
        plan: the human's, if that is their goal.
        horizon: ``T``.
    """

    def __init__(self, context: SearchContext, plan: HumanPlan, horizon: int) -> None:
        options = context.options
        self._packed = context.packed
        self._steps = context.followed(plan)
        self._suffix = suffix_rule(context, plan)
        self._private = context.bound
        self._keys = context.keys
        self._horizon = horizon
        self._max_window = options.max_window or horizon
        self._tells_starts = options.preservation == "state" or self._max_window < horizon
        self._strict = options.strict
        self._deadline = context.deadline

    def first(self) -> Situation:
        """Before the first epoch."""
        root = Node(0, 0, self._packed.init, PREFIX, 0, None, ())
        return Situation(root, {}, None, self._bound(root, {}, None))

    def after(
        self, now: Situation, epoch: int, robots: JointAction, acting: Successors, limit: int
    ) -> Situation | None:
        """After ``epoch``, in which the robots do exactly ``robots``, but for joint actions with the human.

        Args:
            now: before the epoch.
            epoch: from 1.
            robots: the robots' own actions, the same for every candidate.
            acting: what the human can do (with idle robots: alone).
            limit: labels that can't stay below this key are dropped.

        Returns:
            None if nothing fits: the robots' actions break their plan, or are too dear.
        """
        follows = self._follow(now.follows, epoch, robots)
        inside: dict[_Place, Node] = {}
        ended = None if robots.actions else now.ended
        for node in self._open(now):
            self._deadline.tick()
            for child in self._play(node, robots, acting, limit):
                place = self._place(child)
                known = inside.get(place)
                if known is None or child.key < known.key:
                    inside[place] = child
        for child in inside.values():
            ended = self._close(child, ended, limit)
        again = {at: node for at, node in inside.items() if self._goes_on(node)}
        bound = self._bound(follows, again, ended)
        return None if bound >= limit else Situation(follows, again, ended, bound)

    def complete(self, last: Situation) -> Ended | None:
        """The best timeline after the last epoch; ties go to the plan that is left alone."""
        left = None
        if last.follows is not None and self._packed.goal.holds(last.follows.state):
            # Leaving the human alone counts as the shortest and latest window (semantics 3.1).
            left = Ended(last.follows.key + self._untouched, last.follows, 0, ())
        if left is None or (last.ended is not None and last.ended.key < left.key):
            return last.ended
        return left

    @property
    def _untouched(self) -> int:
        return self._keys.epoch_weight + self._keys.of_start(max(1, len(self._steps)), self._horizon)

    def _follow(self, node: Node | None, epoch: int, robots: JointAction) -> Node | None:
        """Rule 1; beyond the end of the human's plan they wait."""
        if node is None:
            return None
        part = NOTHING
        if epoch <= len(self._steps):
            op, part = self._steps[epoch - 1]
            if not applicable(op, node.state):
                return None
        return self._together(node, part, robots)

    def _open(self, now: Situation) -> list[Node]:
        nodes = list(now.inside.values())
        at = now.follows
        if at is not None and at.epoch < min(len(self._steps), self._horizon):
            start = at.epoch + 1
            key = at.key + self._keys.of_start(start, self._horizon)
            nodes.append(at._replace(key=key, phase=WINDOW, start=start))
        return nodes

    def _play(self, node: Node, robots: JointAction, acting: Successors, limit: int) -> list[Node]:
        """Rule 2: the human is free, and robots that are idle in their own plan can join them."""
        found = []
        for part in (NOTHING, *acting.human(node.state), *acting.joint(node.state)):
            child = self._together(node, part, robots)
            if child is not None:
                key = child.key + self._keys.epoch_weight
                if key + self._private(child.state) < limit:
                    found.append(child._replace(key=key))
        return found

    def _together(self, node: Node, part: JointAction, robots: JointAction) -> Node | None:
        """The epoch after ``node`` with the human's part and the robots', if both are applicable together."""
        if part.agents & robots.agents or not self._possible(robots, node.state):
            return None
        for mine in part.actions:
            if not all(self._packed.compatible(mine, other, self._strict) for other in robots.actions):
                return None
        state = node.state & part.keep & robots.keep | part.put | robots.put
        key = node.key + part.weight + robots.weight
        actions = part.actions + robots.actions
        return Node(key, node.epoch + 1, state, node.phase, node.start, node, actions)

    def _possible(self, robots: JointAction, state: int) -> bool:
        return all(applicable(self._packed.op(i), state) for i in robots.actions)

    def _close(self, node: Node, best: Ended | None, limit: int) -> Ended | None:
        """Rule 3: the window ends after the node."""
        cap = limit if best is None else min(limit, best.key)
        left = self._horizon - node.epoch
        rest = self._suffix.key(node.state, left, node.start, cap - node.key)
        if node.key + rest >= cap:
            return best
        tail = self._suffix.actions(node.state, left, node.start)
        return Ended(node.key + rest, node, node.epoch + 1, tail)

    def _goes_on(self, node: Node) -> bool:
        return node.epoch < self._horizon and node.epoch - node.start + 1 < self._max_window

    def _place(self, node: Node) -> _Place:
        return node.state, node.start if self._tells_starts else 0

    def _bound(self, follows: Node | None, inside: dict[_Place, Node], ended: Ended | None) -> int:
        again = self._keys.epoch_weight
        bounds = [node.key + again + self._private(node.state) for node in inside.values()]
        if follows is not None:
            bounds.append(follows.key + again + self._private(follows.state))
        if ended is not None:
            bounds.append(ended.key)
        return min(bounds, default=INFINITE_KEY)
