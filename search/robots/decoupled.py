"""Robots' walks, folded into what they walk to.

A robot's *walk* changes nothing but its own place, and nobody depends on that; whatever else
it does, a *deed*, happens at one place.  Walks then commute with everything, so a search
need not decide on them: a robot can do a deed at a place if it has been idle for as many
epochs as the way there is long, and pays for the way then.  What would be a product of
the robots' positions becomes a sum (decoupled search, Gnad and Hoffmann 2018, with the
robots as leaves).  Plans get their walks back at the end, right before each deed.  Where a step takes several
epochs (:mod:`serendipity.model.task.unit_steps`), the cheapest way may not be the fastest: a deed then comes
once for each way that is not both slower and dearer than another.

Glossary: *slot* - index of a robot among ``task.robots``; *idle* - per slot, for how many
epochs a robot has done no deed, as far as it matters.
"""

from collections.abc import Callable, Iterator, Sequence
from heapq import heappop, heappush
from itertools import count, product
from typing import NamedTuple

from search.engine.best_first import Node
from search.packed.cost_vector import Weights, own_costs
from search.packed.joint_actions import Idle, JointAction, together
from search.packed.operator_index import LiteralIndex
from search.packed.operators import Operator, Signature, union
from search.packed.packed_task import PackedTask
from search.packed.successor_generator import MOST_KEPT, Successors, in_time
from search.packed.table import StateCache
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


class Move(NamedTuple):
    """A step of a walk: the place that it leads to, its epochs, its cost, and the ops of its epochs."""

    there: int
    epochs: int
    cost: int
    ops: tuple[Operator, ...]


class Way(NamedTuple):
    """A walk: its epochs, its cost, its last step: from which place, by which way to it, which action."""

    epochs: int
    cost: int
    before: int
    number: int
    action: int


class Deeds(NamedTuple):
    """Ops of robots with their center actions, by literal, and the fields, places too, that they ask for."""

    by_literal: LiteralIndex[tuple[CenterAction, Operator]]
    mask: int


Known = StateCache[list[JointAction]]
"""What of some deeds is possible, by the fields that they ask for."""


class Decoupled:
    """The walks of robots that can be folded.

    Attributes:
        bits: per slot a robot in bit sets of agents.
        fields: per slot the place of a robot.
        mask: all of them.
        joint: joint deeds.
        led: deeds without the human, by their first robot.
        foldable: whether every robot's walks can be folded.
    """

    def __init__(self, packed: PackedTask, places: PositionVariables, deadline: Deadline) -> None:
        self._packed = packed
        self.bits = [1 << robot for robot in packed.task.robots]
        self.fields = [places.field[bit] for bit in self.bits]
        self.mask = sum(self.fields)
        self._moves: list[dict[int, list[Move]]] = [{} for _ in self.fields]
        self._from: dict[tuple[int, int], dict[int, list[Way]]] = {}
        self._most: dict[tuple[int, int], int] = {}
        self._costs = own_costs(packed)
        self._going_on = frozenset(action for _, action in packed.task.due)
        self.joint = _by_largest([], packed)
        self.led: list[Deeds] = []
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
            if self._is_elsewhere(form):
                return False
            begun = form._replace(ops=[op for op in form.ops if op.action not in self._going_on])
            rest = self._without_walks(begun, own_facts)
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
        costs = [{move.cost for moves in way.values() for move in moves} for way in self._moves]
        return bool(self._going_on) or all(len(cost) <= 1 for cost in costs)

    def _place_facts(self) -> list[set[int]]:
        """Per slot the facts of its place, and of how far what it does is."""
        task = self._packed.task
        packed = {fact: bits[0] for fact, bits in enumerate(self._packed.fact_bits) if bits is not None}
        rests = {task.facts[fact]: packed[fact] for fact in task.at_rest if fact in packed}
        each = zip(self.fields, task.robots, strict=True)
        masks = (place | rests.get(f"free {task.agents[robot]}", 0) for place, robot in each)
        return [{fact for fact, field in packed.items() if field & mask} for mask in masks]

    def _is_elsewhere(self, form: Signature) -> bool:
        """Whether ops mention the place of a robot that takes no part."""
        pairs = zip(self.bits, self.fields, strict=True)
        return any(not form.agents & bit and form.mentions & place for bit, place in pairs)

    def _without_walks(self, form: Signature, facts: Sequence[set[int]]) -> Signature:
        """The form without the ops in which a robot does nothing but walk; those are noted."""
        if form.agents not in self.bits:
            return form
        slot = self.bits.index(form.agents)
        place, freedom = self.fields[slot], self._packed.freedom
        if form.need_mask & ~freedom != place or form.forbids or not form.sets & (place | freedom):
            return form
        rest = []
        for op in form.ops:
            move = self._move(op, place, facts[slot])
            if move is None:
                rest.append(op)
            else:
                self._moves[slot].setdefault(op.need & place, []).append(move)
        return form._replace(ops=rest)

    def _move(self, op: Operator, place: int, facts: set[int]) -> Move | None:
        """A step of a walk from its first epoch on; None if it is none."""
        ops, state = self._packed.chain(op), op.need
        for part in ops:
            action = self._packed.task.actions[part.action]
            if not facts.issuperset((*action.pre, *action.neg, *action.add, *action.delete)):
                return None
            state = state & part.keep | part.put
        cost = sum(self._costs[part.cost] for part in ops)
        there = state & place
        return None if there == op.need & place else Move(there, len(ops), cost, ops)

    def _deed(self, form: Signature) -> CenterAction | None:
        """None where the form leaves a place open."""
        pairs = enumerate(zip(self.bits, self.fields, strict=True))
        at = tuple((slot, place) for slot, (bit, place) in pairs if form.agents & bit)
        if form.forbids & self.mask or any(form.need_mask & place != place for _, place in at):
            return None
        return CenterAction(form, form.need_mask & ~self.mask, at)

    def farthest(self, slot: int, here: int) -> int:
        """The most epochs from a place to another."""
        most = self._most.get((slot, here))
        if most is None:
            most = max(ways[-1].epochs for ways in self.ways(slot, here).values())
            self._most[slot, here] = most
        return most

    def walk(self, slot: int, here: int, there: int, most: int) -> list[tuple[int, int]]:
        """The cheapest walk within a number of epochs: actions, and how long before its end each begins."""
        ways = self.ways(slot, here)
        number = max((i for i, way in enumerate(ways[there]) if way.epochs <= most), default=0)
        actions, left = [], 0
        while there != here:
            way = ways[there][number]
            there, number = way.before, way.number
            left += way.epochs - ways[there][number].epochs
            actions.append((way.action, left))
        return actions[::-1]

    def ways(self, slot: int, here: int) -> dict[int, list[Way]]:
        """Per place that walks lead to the fastest way, and slower ones that are cheaper, in this order."""
        known = self._from.get((slot, here))
        if known is not None:
            return known
        found: dict[int, list[Way]] = {}
        ticket = count()
        queue = [(0, 0, next(ticket), here, Way(0, 0, here, 0, -1))]
        while queue:
            epochs, cost, _, place, way = heappop(queue)
            ways = found.setdefault(place, [])
            if ways and ways[-1].cost <= cost:
                continue
            ways.append(way)
            for move in self._moves[slot].get(place, ()):
                after = Way(epochs + move.epochs, cost + move.cost, place, len(ways) - 1, move.ops[0].action)
                if move.there not in found or found[move.there][-1].cost > after.cost:
                    heappush(queue, (after.epochs, after.cost, next(ticket), move.there, after))
        self._from[slot, here] = found
        return found

    def steps(self, node: Node) -> Iterator[Step]:
        """The walks that lead to a node's deeds, each right before its deed."""
        while node.parent is not None:
            begun = (action for action in node.actions if action not in self._going_on)
            for op in map(self._packed.op, begun):
                for slot, (bit, place) in enumerate(zip(self.bits, self.fields, strict=True)):
                    if op.agents & bit:
                        here, most = node.parent.state & place, node.parent.idle[slot]
                        walk = self.walk(slot, here, op.need & place, most)
                        yield from (Step(node.epoch - left, action) for action, left in walk)
            node = node.parent


def _by_largest(deeds: Sequence[CenterAction], packed: PackedTask) -> Deeds:
    """Center actions by the value of the largest field that they ask for, places aside."""
    largest_first = sorted(packed.fields, key=lambda field: -len(packed.values(field)))
    found = Deeds(LiteralIndex(), union(deed.form.need_mask | deed.form.forbids for deed in deeds))
    for deed in deeds:
        field = next((field for field in largest_first if deed.need_mask & field), 0)
        for op in deed.form.ops:
            found.by_literal.add(field, op.need & field, (deed, op))
    return found


class DecoupledSuccessors(Successors):
    """Successors whose robots do deeds only; their walks are in the weights.

    Args:
        walks: the robots' walks, foldable.
        weights: key increments of ops, and of walks.
    """

    def __init__(
        self, packed: PackedTask, walks: Decoupled, weights: Weights, deadline: Deadline, *, strict: bool
    ) -> None:
        super().__init__(packed, weights.team, deadline, strict=strict, idle=True)
        self._walks = walks
        self._weights = weights
        self._joint_deeds = walks.joint, Known(MOST_KEPT)
        self._led_deeds = [(deeds, Known(MOST_KEPT)) for deeds in walks.led]
        self._rests: dict[Idle, Idle] = {}  # of equal ones, nodes keep the same
        self._latest: tuple[int, Idle, list[list[JointAction]]] = (-1, (), [])

    def joint(self, state: int) -> list[JointAction]:
        """See :class:`Successors`."""
        return self._options(*self._joint_deeds, state)

    def beside(
        self, first: JointAction, state: int, idle: Idle, promising: Callable[[JointAction], bool]
    ) -> list[JointAction]:
        """See :class:`Successors`."""
        found = [first]
        if self.due:
            found = [
                together(first, others) for others in self.due.others(state) if self._fits(first, others)
            ]
        for options in self._in_time(state, idle):
            more = [deed for deed in options if self._fits(deed, first) and promising(together(first, deed))]
            found += [together(chosen, deed) for deed in more for chosen in self._beside(deed, found)]
        found.sort(key=lambda option: option.weight)
        return [*self.due.with_last(iter(found), state)] if self.due else found

    def _beside(self, deed: JointAction, sets: list[JointAction]) -> list[JointAction]:
        """The sets that a deed fits."""
        self._deadline.tick()
        return [chosen for chosen in sets if self._fits(deed, chosen)]

    def rested(self, idle: Idle, option: JointAction, state: int) -> Idle:
        """See :class:`Successors`."""
        walks, busy = self._walks, option.agents
        rests = tuple(
            0
            if busy & walks.bits[slot]
            else min(epochs + 1, walks.farthest(slot, state & walks.fields[slot]))
            for slot, epochs in enumerate(idle)
        )
        return self._rests.setdefault(rests, rests)

    def _in_time(self, state: int, idle: Idle) -> list[list[JointAction]]:
        """Deeds to which the robots that lead them can have walked by now."""
        if self._latest[:2] != (state, idle):
            by_leader = (self._options(*led, state) for led in self._led_deeds)
            self._latest = state, idle, [[deed for deed in led if in_time(deed, idle)] for led in by_leader]
        return self._latest[2]

    def _options(self, deeds: Deeds, known: Known, state: int) -> list[JointAction]:
        """Deeds that are possible after a walk, cheapest first."""
        found = known.get(state & deeds.mask)
        if found is None:
            found = self._found(deeds, state)
            known.keep(state & deeds.mask, found, len(found))
        return found

    def _found(self, deeds: Deeds, state: int) -> list[JointAction]:
        self._deadline.check()
        walks, found = self._walks, []
        for deed, op in deeds.by_literal.candidates(state):
            need = op.need & deed.need_mask
            if state & deed.need_mask != need or any(state & m == v for m, v in op.forbidden):
                continue
            keep, put, ways = op.keep, op.put, []
            for slot, field in deed.at:
                here, place = state & field, op.need & field
                there = walks.ways(slot, here).get(place)
                if there is None:
                    break
                if keep & field:
                    keep, put = keep & ~field, put | place
                ways.append([(slot, way.epochs, way.cost) for way in there])
            else:
                for chosen in product(*ways):
                    walked = sum(self._weights.of_walk(cost, steps) for _, steps, cost in chosen)
                    due = tuple((slot, steps) for slot, steps, _ in chosen)
                    weight = self._weights.team(op) + walked
                    found.append(JointAction(weight, keep, put, (op.action,), op.agents, due))
        found.sort(key=lambda option: option.weight)
        return found
