"""Robots' action sequences, with the human simulated (semantics 6, optimising under a model).

A node is an epoch, the true state, and the human's mind: what they expect to see and
what they mean to do.  They do not wait for anybody, but in equal state and mind an
earlier epoch is no worse: robots can do the same, only sooner, and they answer the
same.  So labels dominate as elsewhere, on state and mind.
"""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import NamedTuple

from search.engine.best_first import Incumbent, Node
from search.engine.dominance import ParetoFront
from search.modes.simulation.human import Glance, Human, HumanStep, Intention, Start
from search.packed.successor_generator import Successors


class Mind(NamedTuple):
    """The human between two epochs.

    Attributes:
        belief: what they expect to see; 0 where they see everything anyway.
        intention: what remains of their plan.
        guarded: they must have a plan alone in the true state (``no_block``).
        waited: weight of the waiting that they pay for once they begin something.
    """

    belief: int
    intention: Intention
    guarded: bool
    waited: int = 0


@dataclass(eq=False)
class Reactive:
    """The search space of robots' action sequences.

    Attributes:
        no_block: robots must not leave them without a plan.
        most_cost: largest scaled cost of an acceptable plan, or None.
        keeps: robots must not make a plan impossible that the human would go on with: one that is being
            followed works after every epoch, unless an observant human drops it for a cheaper one.
        begins: whether a set of actions may be what happens in the first epoch; None: any.
    """

    human: Human
    successors: Successors
    start: Start
    horizon: int
    no_block: bool = True
    most_cost: int | None = None
    keeps: bool = False
    begins: Callable[[tuple[int, ...]], bool] | None = None

    def __post_init__(self) -> None:
        packed = self.human.packed
        self._goals = self.human.context.goals
        in_time = packed.in_time or self.human.asleep
        self._offers_idle = self.human.sees_all and not packed.task.robot_goal and not in_time
        self._width = packed.all_ones.bit_length()
        self._labels = ParetoFront()
        self._minds: list[Mind] = []
        self._numbers: dict[Mind, int] = {}

    def roots(self) -> Iterator[tuple[int, Node]]:
        """The initial state, and what the human has in mind."""
        init = self.start.state
        mind = self._number(Mind(self._belief(self.start.belief), self.start.intention, False))
        node = Node(0, 0, init, mind << 1, 0, None, ())
        self._labels.add(self._place(node), 0, 0)
        yield self.human.context.bound(init), node

    def alive(self, node: Node) -> bool:
        """Whether no better node makes this one superfluous."""
        return self._labels.alive(self._place(node), node.epoch, node.key)

    def expand(self, node: Node, best: Incumbent) -> Iterator[tuple[int, Node]]:
        """Successors of a node; complete plans are offered to ``best``."""
        if node.parent is None and self._offer(node, best):
            return
        if node.epoch == self.horizon:
            return
        mind, state, human = self._minds[node.phase >> 1], node.state, self.human
        steps = human.unasked(state, node.epoch, mind.belief, mind.intention)
        if steps is None:
            expected = state if human.sees_all else mind.belief
            belief, look = human.look(expected, state, mind.intention, settled=bool(node.phase & 1))
            steps, stuck = self._steps(state, belief, look), self._stuck(state, look)
            if self._offers_idle and not stuck:
                self._offer_idle(node, look.intention, best)
        else:
            stuck = (mind.guarded or self.no_block) and human.stuck(state)
        if not (mind.guarded and stuck):
            for step in steps:
                yield from self._children(node, mind, best, step, guarded=self.no_block and not stuck)

    def _steps(self, state: int, belief: int, look: Glance) -> Iterator[HumanStep]:
        """What the human may do after a look: joint actions that they accept, or what they decide on."""
        for joint in self.successors.joint(state):
            op = self.human.packed.op(joint.actions[0])
            if self.human.accepts(op, belief, look.best):
                yield self.human.joins(op, belief, look)
        yield self.human.goes_on(belief, state, look)

    def _children(
        self, node: Node, mind: Mind, best: Incumbent, step: HumanStep, *, guarded: bool
    ) -> Iterator[tuple[int, Node]]:
        """What robots can do beside the human's part."""
        epoch, state, human = node.epoch + 1, node.state, self.human
        part, waited = human.paid(step.option, mind.waited)
        settled = step.settled
        alone = state & part.keep | part.put
        # Robots don't change the variables that the bound looks at.
        rest = human.context.bound(alone)
        if node.key + part.weight + rest >= best.key:
            return
        if guarded and not human.sees_all:
            own = human.follows(state, part)
            guarded = own is not None and not human.stuck(own)  # else it is their own mistake
        number = self._number(Mind(self._belief(step.belief), step.intention, guarded, waited)) << 1
        for option in self.successors.with_robots(part, state):
            key = node.key + option.weight
            bound = key + rest
            if bound >= best.key or self.human.keys.exceeds(bound, self.most_cost):
                break
            if epoch == 1 and self.begins is not None and not self.begins(option.actions):
                continue
            after = state & option.keep | option.put
            if settled and self.keeps and self._spoils(alone, after, step.intention):
                continue
            as_expected = settled and not (self.human.sees_all and (after ^ alone) & human.concern)
            child = Node(key, epoch, after, number | as_expected, 0, node, option.actions)
            if self._labels.add(self._place(child), epoch, key) and not self._offer(child, best):
                yield bound, child

    def _offer(self, node: Node, best: Incumbent) -> bool:
        """Whether the goals hold, and the human is up: the plan ends there."""
        if node.epoch < self.human.asleep or not all(goal.holds(node.state) for goal in self._goals):
            return False
        if node.key < best.key and not self.human.keys.exceeds(node.key, self.most_cost):
            best.key, best.node, best.end, best.tail = node.key, node, 0, ()
        return True

    def _offer_idle(self, node: Node, intention: Intention, best: Incumbent) -> None:
        """Offer the plan in which robots do nothing any more: the human does as intended."""
        key = node.key + intention.weight
        if key >= best.key or len(intention.actions) > self.horizon - node.epoch:
            return
        if self.human.keys.exceeds(key, self.most_cost):
            return
        best.key, best.node, best.end, best.tail = key, node, node.epoch + 1, intention.actions

    def _stuck(self, state: int, look: Glance) -> bool:
        """Whether the human has no plan alone in the true state."""
        if self.human.sees_all:
            return look.best is None
        return self.no_block and self.human.stuck(state)

    def _spoils(self, alone: int, after: int, rest: Intention) -> bool:
        """Whether robots make impossible what the human would go on with.

        Args:
            alone: the state that the human's part of an epoch leads to.
            after: the one that the whole epoch leads to.
            rest: what the human means to do from then on.
        """
        goal, human = self._goals[0], self.human
        if not (alone ^ after) & human.concern or goal.holds(after):
            return False
        if not self.human.sees_all:
            return human.works(alone, rest) and not human.works(after, rest)
        look = human.decide(after, rest)
        return look.kept is None and (look.best is None or look.best >= rest.cost)

    def _belief(self, belief: int) -> int:
        return 0 if self.human.sees_all else belief

    def _number(self, mind: Mind) -> int:
        """A number for a mind, the same for equal ones."""
        number = self._numbers.setdefault(mind, len(self._minds))
        if number == len(self._minds):
            self._minds.append(mind)
        return number

    def _place(self, node: Node) -> int:
        return node.phase >> 1 << self._width | node.state
