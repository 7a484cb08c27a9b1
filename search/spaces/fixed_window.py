"""The search space of plans that fit one given window, under any weights (semantics 3.2)."""

from collections.abc import Callable, Iterator, Sequence

from search.bounds.first_interaction import Bounds
from search.bounds.prefix_bounds import FirstInteractionOnTheWay
from search.call.context import SearchContext
from search.engine.best_first import Incumbent, Node
from search.engine.dominance import ParetoFront
from search.human.suffix_rules import Suffix
from search.packed.joint_actions import JointAction
from search.packed.operators import Operator
from search.packed.successor_generator import Successors
from search.spaces.factory import BoundsAlong, prefix_rule, suffix_rule
from search.spaces.windowed import PREFIX, TOUCHED, WINDOW
from serendipity.model.task.plans import Window
from serendipity.model.task.task import HumanPlan


class Weighed:
    """The task under some weights, and bounds, which the spaces of all windows share.

    Args:
        plan: ``pi_H``.
        weight: key increment of an op.
        robots: the same for a robots' op by the index of its cost.
        limit: key that a plan has to beat.
    """

    def __init__(
        self,
        context: SearchContext,
        plan: HumanPlan,
        horizon: int,
        weight: Callable[[Operator], int],
        robots: Sequence[int],
        limit: int,
    ) -> None:
        self.initial = context.packed.init
        self.horizon = horizon
        self.prefix = prefix_rule(context, plan)
        self.successors = Successors(context.packed, weight, context.deadline, strict=context.options.strict)
        self.suffix: Suffix = suffix_rule(context, plan)
        opened = [0] * len(plan)
        along = BoundsAlong(context, plan, horizon, limit, opened, robots, idle=False)
        self.on_the_way: FirstInteractionOnTheWay = along.on_the_way
        # It is not about what has been done, and in time only the last node of a window is its end.
        self._helped = None if self.successors.in_time else along.off_plan
        self.bounds = Bounds(context.bound, context.steps, touches=context.interactions)
        self._choices: dict[int, list[tuple[int, int, int]]] = {}

    def untouched(self, epoch: int, state: int, until: int) -> int:
        """Least key increment before the first touch in the window, if robots act up to ``until``."""
        if self._helped is None:
            return 0
        choices = self._choices.get(state)
        if choices is None:
            choices = self._choices[state] = self._helped.choices(state)
        return next(total for total, steps, latest in choices if epoch + steps <= min(until, latest))


class FixedWindow:
    """The search space of plans that fit one window.

    Only the window's end is left open to waiting: a node inside it stands for everybody
    waiting until the end, too, where nothing else happens by then.
    """

    def __init__(self, weighed: Weighed, window: Window) -> None:
        self._weighed = weighed
        self._window = window
        self._opens = window.start - 1
        self._left = weighed.horizon + 1 - window.end
        self._labels = ParetoFront()

    def roots(self) -> Iterator[tuple[int, Node]]:
        """The initial state."""
        initial = self._weighed.initial
        phase = PREFIX if self._opens else WINDOW
        self._remember(0, initial, 0)
        yield self._bound_before(0, initial), Node(0, 0, initial, phase, 0, None, ())

    def alive(self, node: Node) -> bool:
        """Whether no better node makes this one superfluous."""
        return self._labels.alive(self._place(node.epoch, node.state), node.epoch, node.key)

    def expand(self, node: Node, best: Incumbent) -> Iterator[tuple[int, Node]]:
        """Successors; a node of the window is offered to ``best`` as the last in which anybody acts."""
        if node.phase == PREFIX:
            for part in self._weighed.prefix.options(node.epoch + 1, node.state):
                yield from self._follow(node, part, best)
            return
        successors, state = self._weighed.successors, node.state
        is_last = node.epoch + 1 == self._window.end
        if is_last or not successors.in_time:
            self._end(node, best)
        if not is_last:
            for part in successors.free(state):
                yield from self._act(node, part, best)

    def _follow(self, node: Node, part: JointAction, best: Incumbent) -> Iterator[tuple[int, Node]]:
        """Robots act while the human takes their step of ``pi_H``."""
        epoch = node.epoch + 1
        phase = PREFIX if epoch < self._opens else WINDOW
        for option in self._weighed.successors.with_robots(part, node.state):
            state = node.state & option.keep | option.put
            key = node.key + option.weight
            bound = key + self._bound_before(epoch, state)
            if bound < best.key and self._remember(epoch, state, key):
                yield bound, Node(key, epoch, state, phase, 0, node, option.actions)

    def _act(self, node: Node, part: JointAction, best: Incumbent) -> Iterator[tuple[int, Node]]:
        """Inside the window, with the human's part of an epoch."""
        epoch, bounds, weighed = node.epoch + 1, self._weighed.bounds, self._weighed
        # Robots don't change the variables that the private bound looks at.
        at = node.state & part.keep | part.put
        rest = bounds.private(at)
        if epoch + bounds.steps(at) > weighed.horizon:
            return
        touched = node.phase == TOUCHED or bounds.interactions(part.actions)
        phase = TOUCHED if touched else WINDOW
        for option in weighed.successors.with_robots(part, node.state):
            key = node.key + option.weight
            bound = key + rest
            if bound >= best.key:
                break
            state = node.state & option.keep | option.put
            if not touched:
                bound = max(bound, key + weighed.untouched(epoch, state, self._window.end - 1))
            if bound < best.key and self._remember(epoch, state, key):
                yield bound, Node(key, epoch, state, phase, 0, node, option.actions)

    def _bound_before(self, epoch: int, state: int) -> int:
        """Least key increment after an epoch of the prefix, in which the human follows ``pi_H``."""
        return self._weighed.on_the_way.opening_after(self._opens, epoch, state, self._window.end - 1)

    def _remember(self, epoch: int, state: int, key: int) -> bool:
        """Whether the state was not reached as cheaply before: in that epoch, or in the window by then."""
        return self._labels.add(self._place(epoch, state), epoch, key)

    def _place(self, epoch: int, state: int) -> int | tuple[int, int]:
        """Where nobody waits for the end, before the window and in time, epochs tell states apart."""
        early = epoch < self._opens or self._weighed.successors.in_time
        return (epoch, state) if early else state

    def _end(self, node: Node, best: Incumbent) -> None:
        suffix, limit = self._weighed.suffix, best.key - node.key
        rest = suffix.key(node.state, self._left, self._window.start, limit)
        if rest < limit:
            tail = suffix.actions(node.state, self._left, self._window.start)  # where time may run out
            best.key, best.node, best.end, best.tail = node.key + rest, node, self._window.end, tail
