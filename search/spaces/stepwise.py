"""Composite planning within ``T``, an epoch put together agent by agent.

The same plans as those of :class:`.Unrestricted`, for tasks whose goals are shared: there the bound on the
team tells after an agent's action whether the others are worth looking at, which saves most of the sets.  Not
so where the action may take from others what they ask for: they act on the state before the epoch, and the
bound is about what can be done after the action.
"""

from collections.abc import Iterator
from typing import NamedTuple

from search.engine.best_first import Incumbent, Node
from search.engine.dominance import ParetoFront
from search.bounds.first_interaction import Bounds
from search.packed.packed_task import PackedGoal
from search.packed.successor_generator import NOTHING, JointAction, Successors


class PartialNode(NamedTuple):
    """Some agents have chosen what they do in the epoch after ``node.epoch``; the others have not.

    Attributes:
        node: before the epoch.
        chosen: what they do.
        turn: whose turn it is, by the place in :meth:`.Successors.groups`; 0 where the epoch is over.
        bound: least key of a plan that goes on from here.
        judged: whether that of the team has been asked for, or says nothing.
    """

    node: Node
    chosen: JointAction
    turn: int
    bound: int
    judged: bool


class Stepwise:
    """The search space of composite plans within a horizon.

    Args:
        initial: packed initial state.
        horizon: number of epochs ``T``.
        goals: what has to hold at the end.
        successors: what agents can do in an epoch.
        bounds: lower bounds on what still has to be paid; that on the team counts.
        labels: which nodes make others superfluous.
        greed: what the bound counts for in the order of nodes; with more than 1 a plan is found sooner, and
            its optimality is not proved.
    """

    def __init__(
        self,
        *,
        initial: int,
        horizon: int,
        goals: tuple[PackedGoal, ...],
        successors: Successors,
        bounds: Bounds,
        labels: ParetoFront,
        greed: int = 1,
    ) -> None:
        self._greed = greed
        self._initial = initial
        self._horizon = horizon
        self._goals = goals
        self._successors = successors
        self._bounds = bounds
        self._labels = labels
        self._groups: dict[int, tuple[list[list[JointAction]], list[int]]] = {}

    def roots(self) -> Iterator[tuple[int, PartialNode]]:
        """The initial state."""
        self._labels.add(self._initial, 0, 0)
        node = Node(0, 0, self._initial, 0, 0, None, ())
        bound = self._bounds.team(self._initial)
        yield self._ranked(PartialNode(node, NOTHING, 0, bound, judged=True))

    def alive(self, partial: PartialNode) -> bool:
        """Whether no cheaper node that is as early makes this one superfluous."""
        node = partial.node
        return self._labels.alive(node.state, node.epoch, node.key)

    def expand(self, partial: PartialNode, best: Incumbent) -> Iterator[tuple[int, PartialNode]]:
        """What the next agent may do; plans in which the others wait are offered to ``best``."""
        node, chosen, turn, known, judged = partial
        if not judged:
            known = self._judge(partial)
            if known > partial.bound:
                if known < best.key:
                    yield self._ranked(partial._replace(bound=known, judged=True))
                return
        if node.parent is None and not chosen.actions:
            self._offer(node, best)
        if node.epoch >= self._horizon:
            return
        groups, asked = self._options(node.state)
        for option in (NOTHING, *groups[turn]):
            together = self._successors.beside_others(chosen, option)
            if together is None:
                continue
            after = node.state & together.keep | together.put
            key = node.key + together.weight
            bound = max(known, key + self._bounds.private(after))
            if bound >= best.key:
                continue
            if option.actions:
                self._offer(Node(key, node.epoch + 1, after, 0, 0, node, together.actions), best)
            # Waiting is the same state again.
            again = not option.actions and not ~chosen.keep & asked[turn]
            if turn + 1 < len(groups):
                done = again or bool(~together.keep & asked[turn + 1])
                yield self._ranked(PartialNode(node, together, turn + 1, bound, done))
            elif (
                together.actions
                and node.epoch + 1 + self._bounds.steps(after) <= self._horizon
                and self._labels.add(after, node.epoch + 1, key)
            ):
                child = Node(key, node.epoch + 1, after, 0, 0, node, together.actions)
                yield self._ranked(PartialNode(child, NOTHING, 0, bound, again))

    def _ranked(self, partial: PartialNode) -> tuple[int, PartialNode]:
        spent = partial.node.key + partial.chosen.weight
        return spent + self._greed * (partial.bound - spent), partial

    def _judge(self, partial: PartialNode) -> int:
        """Least key by the bound on the team, which is the dearest one."""
        node, chosen = partial.node, partial.chosen
        after = node.state & chosen.keep | chosen.put
        return node.key + chosen.weight + self._bounds.team(after)

    def _options(self, state: int) -> tuple[list[list[JointAction]], list[int]]:
        """What each agent can do, and what is asked for from its turn on."""
        found = self._groups.get(state)
        if found is None:
            groups = self._successors.groups(state)
            found = self._groups[state] = groups, self._successors.asked_from(groups)
        return found

    def _offer(self, node: Node, best: Incumbent) -> None:
        if node.key < best.key and all(goal.holds(node.state) for goal in self._goals):
            best.key, best.node = node.key, node
