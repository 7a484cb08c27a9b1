"""Serendipity: a prefix that leaves the human alone, a window, a suffix (semantics 3.1).

Nodes are (phase, epoch, packed state).  In the prefix the human follows ``pi_H``
(or, where the robot may announce itself, does any actions of ``pi_H``); a window
may open before any epoch; each epoch inside it may be its last.
"""

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from typing import NamedTuple

from search.bounds.first_interaction import Bounds
from search.bounds.prefix_bounds import FirstInteractionOnTheWay
from search.engine.best_first import Incumbent, Node
from search.engine.dominance import ParetoFront
from search.human.pattern_database import PatternDatabase
from search.human.suffix_rules import Suffix
from search.packed.cost_vector import CostLayout
from search.packed.joint_actions import Idle, JointAction
from search.packed.operators import Operator, applicable
from search.packed.packed_task import PackedTask
from search.packed.successor_generator import Successors, in_time
from serendipity.model.task.task import HumanPlan

PREFIX, WINDOW, TOUCHED = 0, 1, 2
"""Phases: before the window; in it, before and after the first touch of the human in it."""


class InLayers:
    """Rule 1: in epoch ``t`` the human does ``pi_H[t]`` (Def. 3.0), or one of several actions that are due.

    Args:
        layers: per epoch what they may do, packed actions and what they do.
    """

    def __init__(self, layers: Sequence[Sequence[tuple[Operator, JointAction]]]) -> None:
        self._layers = layers

    def options(self, epoch: int, state: int) -> Iterable[JointAction]:
        """What they may do in ``epoch`` from a packed state."""
        return [option for op, option in self._layers[epoch - 1] if applicable(op, state)]


class AnyOfPlan:
    """The paper's second (7b): any actions of ``pi_H``, in any order, or noop (semantics 3.4)."""

    def __init__(self, successors: Successors, packed: PackedTask, plan: HumanPlan) -> None:
        self._successors = successors
        self._actions = packed.task.actions
        self._planned = packed.task.names((*plan, *packed.idling))

    def options(self, epoch: int, state: int) -> Iterable[JointAction]:
        """See :class:`InLayers`."""
        going_on = self._successors.due.human(state)
        if going_on is not None:
            return going_on
        own = self._successors.human(state)
        planned = (o for o in own if self._actions[o.actions[0]].name in self._planned)
        return (*self._successors.idle, *planned)


Prefix = InLayers | AnyOfPlan
"""The human's part of the epochs before the window."""


@dataclass(eq=False)
class PrivateRest:
    """The bound in the prefix where no touch is known in advance: what the human has to do themselves.

    Attributes:
        last: the last epoch in which a window may open.
        bound: their private distances to the goal.
    """

    last: int
    bound: PatternDatabase
    keys: CostLayout
    horizon: int

    def opening(self, epoch: int, state: int, idle: Idle) -> int:
        """See :class:`.FirstInteractionOnTheWay`."""
        return self.keys.of_start(epoch + 1, self.horizon) + self.keys.epoch_weight + self.bound(state)

    def later(self, epoch: int, state: int, idle: Idle) -> int:
        """See :class:`.FirstInteractionOnTheWay`."""
        return self.opening(self.last - 1, state, idle)


PrefixBound = PrivateRest | FirstInteractionOnTheWay
"""Lower bound of the key increment from a node of the prefix after an epoch, window included."""


class _JudgedNode(NamedTuple):
    """A node of the window and the human's part of the next epoch, evaluated together.

    Attributes:
        node: the node.
        spent: key after the epoch, without what is done in it.
        rest: least key increment after it by the human's private variables, which robots don't change.
        touched: whether they have touched anything in the window by then.
    """

    node: Node
    spent: int
    rest: int
    touched: bool


@dataclass(kw_only=True, eq=False)
class Windowed:
    """The search space of plans with a window.

    Attributes:
        initial: packed initial state.
        idle: per slot 0 where robots' walks are folded, else empty.
        last: the last epoch in which a window may open (``xi1 <= |pi_H|``).
        max_window: most epochs of a window.
        most_cost: largest scaled cost of an acceptable plan, or None.
        successors: what agents can do in an epoch.
        bounds: lower bounds on what still has to be paid.
        prefix: rule 1.
        on_the_way: lower bound in the prefix.
        suffix: rule 3.
        labels: dominance among nodes of the window.
        opens_late: whether no window has to open in an epoch in which the human goes on with something: one
            that opens with the next epoch is as good, and later.
        relevant: the fields that matter to the human alone, and to goals: what robots do in the last epoch
            of a window changes one of them, or it is in vain.
        begins: the number of epochs that are over.
        opened: the first epoch of a window that is open then; 0 where none is.
    """

    initial: int
    idle: Idle = ()
    horizon: int
    last: int
    max_window: int
    most_cost: int | None = None
    keys: CostLayout
    successors: Successors
    bounds: Bounds
    prefix: Prefix
    on_the_way: PrefixBound
    suffix: Suffix
    labels: ParetoFront
    relevant: int
    opens_late: bool = False
    begins: int = 0
    opened: int = 0

    def __post_init__(self) -> None:
        self._followed = ParetoFront()

    def roots(self) -> Iterator[tuple[int, Node]]:
        """The initial state, in the prefix or in the window that is open."""
        epoch, initial = self.begins, self.initial
        phase = WINDOW if self.opened else PREFIX
        root = Node(0, epoch, initial, phase, self.opened, None, (), self.idle)
        if self.opened:
            if epoch - self.opened + 1 < self.max_window:
                self.labels.add(initial, epoch, 0, self.idle)
                yield self.keys.epoch_weight + self.bounds.private(initial), root
        elif epoch < self.last:
            self._followed.add((epoch, initial), epoch, 0, self.idle)
            yield self.on_the_way.later(epoch, initial, self.idle), root

    def alive(self, node: Node) -> bool:
        """Whether no better node makes this one superfluous."""
        if node.phase == PREFIX:
            return self._followed.alive((node.epoch, node.state), node.epoch, node.key, node.idle)
        return self.labels.alive(node.state, node.epoch, node.key, node.idle)

    def expand(self, node: Node, best: Incumbent) -> Iterator[tuple[int, Node]]:
        """Successors of a node; ends of windows are offered to ``best``."""
        if node.phase != PREFIX:
            yield from self._inside(node, best)
            return
        yield from self._open(node)
        if node.epoch + 1 < self.last:
            yield from self._follow(node, best)

    def _open(self, node: Node) -> Iterator[tuple[int, Node]]:
        start = node.epoch + 1
        if self.opens_late and start < self.last and self.successors.due.human(node.state) is not None:
            return
        key = node.key + self.keys.of_start(start, self.horizon)
        bound = node.key + self.on_the_way.opening(node.epoch, node.state, node.idle)
        bound = max(bound, key + self.keys.epoch_weight + self.bounds.team(node.state))
        if not self.keys.exceeds(bound, self.most_cost) and self.labels.add(
            node.state, node.epoch, key, node.idle
        ):
            yield bound, node._replace(key=key, phase=WINDOW, start=start)

    def _follow(self, node: Node, best: Incumbent) -> Iterator[tuple[int, Node]]:
        epoch, successors = node.epoch + 1, self.successors
        sooner = _sooner(node.idle)

        def promising(option: JointAction) -> bool:
            after = node.state & option.keep | option.put
            return node.key + option.weight + self.on_the_way.later(epoch, after, sooner) < best.key

        for part in self.prefix.options(epoch, node.state):
            for option in successors.beside(part, node.state, node.idle, promising):
                state = node.state & option.keep | option.put
                key = node.key + option.weight
                idle = successors.rested(node.idle, option, state)
                bound = key + self.on_the_way.later(epoch, state, idle)
                if bound >= best.key or self.keys.exceeds(bound, self.most_cost):
                    continue
                bound = max(bound, key + self.keys.epoch_weight + self.bounds.team(state))
                if bound < best.key and self._followed.add((epoch, state), epoch, key, idle):
                    yield bound, Node(key, epoch, state, PREFIX, 0, node, option.actions, idle)

    def _inside(self, node: Node, best: Incumbent) -> Iterator[tuple[int, Node]]:
        """Successors of a node of the window; each is offered as its end."""
        if node.epoch >= self.horizon:
            return
        successors, state = self.successors, node.state
        sooner = _sooner(node.idle)
        after = node.key + self.keys.epoch_weight + self.bounds.private(state)
        is_last = not node.idle and not self._goes_on(node.start, node.epoch + 1, after, best)
        going_on = successors.due.human(state)
        free = going_on
        if free is None:
            free = (*successors.human(state), *successors.joint(state), *successors.idle)
        for part in free:
            judged = self._judge(node, part, best)
            if judged is None:
                continue

            def promising(option: JointAction, judged: _JudgedNode = judged) -> bool:
                return self._least(judged, option, sooner) < best.key

            if is_last:
                sets: Iterable[JointAction] = successors.with_changers(part, state, self.relevant)
            else:
                sets = successors.beside(part, state, node.idle, promising)
            for option in sets:
                bound = judged.spent + option.weight + judged.rest
                if bound >= best.key or self.keys.exceeds(bound, self.most_cost):
                    break
                self._end(judged, option, best)
                if not is_last and self._goes_on(node.start, node.epoch + 1, bound, best):
                    child = self._child(judged, option)
                    bound = self._least(judged, option, child.idle) + self.keys.epoch_weight
                    if bound < best.key and self.labels.add(child.state, child.epoch, child.key, child.idle):
                        yield bound, child

    def _child(self, judged: _JudgedNode, option: JointAction) -> Node:
        """The node after an epoch of the window."""
        node = judged.node
        after = node.state & option.keep | option.put
        return Node(
            judged.spent + option.weight,
            node.epoch + 1,
            after,
            TOUCHED if judged.touched else WINDOW,
            node.start,
            node,
            option.actions,
            self.successors.rested(node.idle, option, after),
        )

    def _judge(self, node: Node, part: JointAction, best: Incumbent) -> _JudgedNode | None:
        """What the human's part of the next epoch means; None if it comes too early, or can't pay."""
        if not in_time(part, node.idle):
            return None
        at = node.state & part.keep | part.put
        rest = self.bounds.private(at)
        spent = node.key + self.keys.epoch_weight
        if spent + part.weight + rest >= best.key or node.epoch + 1 + self.bounds.steps(at) > self.horizon:
            return None
        touched = node.phase == TOUCHED or self.bounds.interactions(part.actions)
        return _JudgedNode(node, spent, rest, touched)

    def _least(self, judged: _JudgedNode, option: JointAction, idle: Idle) -> int:
        """Least key of a plan that goes on with an option; ``idle``: how long robots have been, after it."""
        node, spent, rest, touched = judged
        key = spent + option.weight
        after = node.state & option.keep | option.put
        rest = max(rest, self.bounds.team(after))
        if touched:
            return key + rest
        return key + max(rest, self.bounds.untouched(node.epoch + 1, after, key, idle))

    def _goes_on(self, start: int, epoch: int, bound: int, best: Incumbent) -> bool:
        """Whether a window may have another epoch after one, and a plan with it may still pay."""
        if epoch >= self.horizon or epoch - start + 1 >= self.max_window:
            return False
        return bound + self.keys.epoch_weight < best.key

    def _end(self, judged: _JudgedNode, option: JointAction, best: Incumbent) -> None:
        """Offer the plan whose window ends with an epoch."""
        node, key, epoch = judged.node, judged.spent + option.weight, judged.node.epoch + 1
        state, left = node.state & option.keep | option.put, self.horizon - epoch
        key += self.suffix.key(state, left, node.start, best.key - key)
        if key < best.key and not self.keys.exceeds(key, self.most_cost):
            tail = self.suffix.actions(state, left, node.start)  # where time may run out
            best.key, best.node, best.end, best.tail = key, self._child(judged, option), epoch + 1, tail


def _sooner(idle: Idle) -> Idle:
    """Idle robots after an epoch in which it is left open which of them act."""
    return tuple(epochs + 1 for epochs in idle)
