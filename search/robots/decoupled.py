"""Robots' walks, folded into what they walk to.

A robot's *walk* changes nothing but its own place, and nobody depends on that; whatever else
it does, a *deed*, happens at one place.  Walks then commute with everything, so a search
need not decide on them: a robot can do a deed at a place if it has been idle for as many
epochs as the way there is long, and pays for the way then.  What would be a product of
the robots' positions becomes a sum (decoupled search, Gnad and Hoffmann 2018, with the
robots as leaves).  Plans get their walks back at the end, right before each deed.

Glossary: *slot* - index of a robot among ``task.robots``; *idle* - per slot, for how many
epochs a robot has done no deed, as far as it matters.
"""

from collections import deque
from collections.abc import Callable, Iterable, Iterator, Sequence
from typing import NamedTuple

from search.engine.best_first import Node
from search.packed.joint_actions import Idle, JointAction, together
from search.packed.operator_index import LiteralIndex
from search.packed.operators import Operator, Signature
from search.packed.packed_task import PackedTask
from search.packed.state_cache import StateCache
from search.packed.successor_generator import MOST_KEPT, Successors, in_time
from search.robots.transition_graphs import PositionVariables
from serendipity.model.resources.deadline import Deadline
from serendipity.model.task.plans import Step


class CenterAction(NamedTuple):
    """A form of robots' ops that are no walks.

    Attributes:
        form: the ops.
        need_mask: the fields that they ask for, places aside.
        at: the robots that take part: slot, and field of the place where each has to be.
    """

    form: Signature
    need_mask: int
    at: tuple[tuple[int, int], ...]


CenterActionIndex = LiteralIndex[tuple[CenterAction, Operator]]
"""Ops of robots with their center actions."""


class Decoupled:
    """The walks of robots that can be folded.

    Args:
        packed: the packed task.
        places: where robots are.
        deadline: polled while they are found.

    Attributes:
        fields: per slot the place of a robot.
        mask: all of them.
        joint: joint deeds.
        led: deeds without the human, by their first robot.
        foldable: whether every robot's walks can be folded.
    """

    def __init__(self, packed: PackedTask, places: PositionVariables, deadline: Deadline) -> None:
        self._packed = packed
        self._bits = [1 << robot for robot in packed.task.robots]
        self.fields = [places.field[bit] for bit in self._bits]
        self.mask = sum(self.fields)
        self._moves: list[dict[int, list[tuple[int, Operator]]]] = [{} for _ in self.fields]
        self._from: dict[tuple[int, int], dict[int, tuple[int, int, int]]] = {}
        self.joint: CenterActionIndex = LiteralIndex()
        self.led: list[CenterActionIndex] = []
        # What only robots together move is the place of each of them, and of none alone.
        apart = all(self.fields) and len({*self.fields}) == len(self.fields)
        self.foldable = apart and self._fold(deadline)

    def _fold(self, deadline: Deadline) -> bool:
        packed = self._packed
        joint: list[CenterAction] = []
        led: dict[int, list[CenterAction]] = {}
        if (packed.goal.mask | packed.robot_goal.mask | packed.own_mask) & self.mask:
            return False
        own_facts = self._place_facts()
        for form in (*packed.joint_forms, *packed.other_forms):
            deadline.check()
            rest = self._without_walks(form, own_facts)
            if not rest.ops:
                continue
            deed = self._deed(rest)
            if deed is None:
                return False
            if form.agents & packed.human_bit:
                joint.append(deed)
            else:
                led.setdefault(form.agents & -form.agents, []).append(deed)
        self.joint = _by_largest(joint, packed)
        self.led = [_by_largest(deeds, packed) for _, deeds in sorted(led.items())]
        costs = [{op.cost for moves in way.values() for _, op in moves} for way in self._moves]
        return all(len(cost) <= 1 for cost in costs)

    def _place_facts(self) -> list[set[int]]:
        """Per slot the facts of its place."""
        found: list[set[int]] = [set() for _ in self.fields]
        for fact, bits in enumerate(self._packed.fact_bits):
            if bits is not None and bits[0] & self.mask:
                found[self.fields.index(bits[0])].add(fact)
        return found

    def _without_walks(self, form: Signature, facts: Sequence[set[int]]) -> Signature:
        """The form without the ops in which a robot does nothing but walk; those are noted."""
        if form.agents not in self._bits:
            return form
        slot = self._bits.index(form.agents)
        place = self.fields[slot]
        if form.need_mask != place or form.forbids or not form.sets & place:
            return form
        rest = []
        for op in form.ops:
            action = self._packed.task.actions[op.action]
            if facts[slot].issuperset((*action.pre, *action.neg, *action.add, *action.delete)):
                self._moves[slot].setdefault(op.need & place, []).append((op.put & place, op))
            else:
                rest.append(op)
        return form._replace(ops=rest)

    def _deed(self, form: Signature) -> CenterAction | None:
        """None where the form leaves a place open, or asks for that of a robot that takes no part."""
        at = []
        for slot, (bit, place) in enumerate(zip(self._bits, self.fields, strict=True)):
            if form.agents & bit:
                if form.need_mask & place != place:
                    return None
                at.append((slot, place))
            elif (form.need_mask | form.sets) & place:
                return None
        if form.forbids & self.mask:
            return None
        return CenterAction(form, form.need_mask & ~self.mask, tuple(at))

    def touched_by(self, ops: Iterable[Operator]) -> bool:
        """Whether some of the human's ops mention a robot's place."""
        return any(self._packed.mentioned(op) & self.mask for op in ops)

    def weights(self, weight: Callable[[Operator], int]) -> list[int]:
        """Per slot the key increment of one step of a walk."""
        steps = (next((op for moves in way.values() for _, op in moves), None) for way in self._moves)
        return [0 if op is None else weight(op) for op in steps]

    def distance(self, slot: int, here: int, there: int) -> int:
        """Steps from one place to another; -1 if no walk leads there."""
        found = self._ways(slot, here).get(there)
        return -1 if found is None else found[0]

    def farthest(self, slot: int, here: int) -> int:
        """The most steps from a place to another."""
        steps, _, _ = next(
            reversed(self._ways(slot, here).values())
        )  # breadth first: the last is the farthest
        return steps

    def walk(self, slot: int, here: int, there: int) -> list[int]:
        """The actions of a shortest walk."""
        actions = []
        ways = self._ways(slot, here)
        while there != here:
            _, there, action = ways[there]
            actions.append(action)
        return actions[::-1]

    def _ways(self, slot: int, here: int) -> dict[int, tuple[int, int, int]]:
        """Per place the number of steps, the place before it, and the action from there."""
        found = self._from.get((slot, here))
        if found is None:
            found = {here: (0, here, -1)}
            pending = deque([here])
            while pending:
                place = pending.popleft()
                for after, op in self._moves[slot].get(place, ()):
                    if after not in found:
                        found[after] = (found[place][0] + 1, place, op.action)
                        pending.append(after)
            self._from[slot, here] = found
        return found

    def steps(self, node: Node) -> Iterator[Step]:
        """The walks that lead to a node's deeds, each right before its deed."""
        while node.parent is not None:
            for op in map(self._packed.op, node.actions):
                for slot, (bit, place) in enumerate(zip(self._bits, self.fields, strict=True)):
                    if op.agents & bit:
                        walk = self.walk(slot, node.parent.state & place, op.need & place)
                        yield from map(Step, range(node.epoch - len(walk), node.epoch), walk)
            node = node.parent


def _by_largest(deeds: Iterable[CenterAction], packed: PackedTask) -> CenterActionIndex:
    """Center actions by the value of the largest field that they ask for, places aside."""
    largest_first = sorted(packed.fields, key=lambda field: -len(packed.values(field)))
    index: CenterActionIndex = LiteralIndex()
    for deed in deeds:
        field = next((field for field in largest_first if deed.need_mask & field), 0)
        for op in deed.form.ops:
            index.add(field, op.need & field, (deed, op))
    return index


class DecoupledSuccessors(Successors):
    """Successors whose robots do deeds only; their walks are in the weights.

    Args:
        encoding: the packed task.
        walks: the robots' walks, foldable.
        weight: key increment of an op.
        deadline: polled while deeds are looked for.
        strict: strict interference (semantics 2).
    """

    def __init__(
        self,
        packed: PackedTask,
        walks: Decoupled,
        weight: Callable[[Operator], int],
        deadline: Deadline,
        *,
        strict: bool,
    ) -> None:
        super().__init__(packed, weight, deadline, strict=strict, idle=True)
        self._walks = walks
        self._weight = weight
        self._step = walks.weights(weight)
        self._possible: StateCache[tuple[list[JointAction], list[list[JointAction]]]] = StateCache(MOST_KEPT)
        self._rests: dict[Idle, Idle] = {}  # of equal ones, nodes keep the same
        self._latest: tuple[int, Idle, list[list[JointAction]]] = (-1, (), [])

    def joint(self, state: int) -> list[JointAction]:
        """See :class:`Successors`."""
        return self._all(state)[0]

    def beside(
        self, first: JointAction, state: int, idle: Idle, promising: Callable[[JointAction], bool]
    ) -> list[JointAction]:
        """See :class:`Successors`."""
        found = [first]
        for options in self._in_time(state, idle):
            more = [deed for deed in options if self._fits(deed, first) and promising(together(first, deed))]
            found += [together(chosen, deed) for deed in more for chosen in self._beside(deed, found)]
        found.sort(key=lambda option: option.weight)
        return found

    def _beside(self, deed: JointAction, sets: list[JointAction]) -> list[JointAction]:
        """The sets that a deed fits."""
        self._deadline.tick()
        return [chosen for chosen in sets if self._fits(deed, chosen)]

    def rested(self, idle: Idle, option: JointAction, state: int) -> Idle:
        """See :class:`Successors`."""
        busy = {slot for slot, _ in option.due}
        walks = self._walks
        rests = tuple(
            0 if slot in busy else min(epochs + 1, walks.farthest(slot, state & walks.fields[slot]))
            for slot, epochs in enumerate(idle)
        )
        return self._rests.setdefault(rests, rests)

    def _in_time(self, state: int, idle: Idle) -> list[list[JointAction]]:
        """Deeds to which the robots that lead them can have walked by now."""
        if self._latest[:2] != (state, idle):
            ready = [[deed for deed in led if in_time(deed, idle)] for led in self._all(state)[1]]
            self._latest = state, idle, ready
        return self._latest[2]

    def _all(self, state: int) -> tuple[list[JointAction], list[list[JointAction]]]:
        found = self._possible.get(state)
        if found is None:
            led = [self._options(index, state) for index in self._walks.led]
            found = self._options(self._walks.joint, state), led
            self._possible.keep(state, found, len(found[0]) + sum(map(len, led)))
        return found

    def _options(self, index: CenterActionIndex, state: int) -> list[JointAction]:
        """Deeds that are possible after a walk, cheapest first."""
        self._deadline.check()
        walks, found = self._walks, []
        for deed, op in index.candidates(state):
            need = op.need & deed.need_mask
            if state & deed.need_mask != need or any(state & m == v for m, v in op.forbidden):
                continue
            weight, keep, put, due = self._weight(op), op.keep, op.put, []
            for slot, field in deed.at:
                place = op.need & field
                steps = walks.distance(slot, state & field, place)
                if steps < 0:
                    break
                weight += steps * self._step[slot]
                if keep & field:
                    keep, put = keep & ~field, put | place
                due.append((slot, steps))
            else:
                found.append(JointAction(weight, keep, put, (op.action,), op.agents, tuple(due)))
        found.sort(key=lambda option: option.weight)
        return found
