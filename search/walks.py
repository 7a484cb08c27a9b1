"""Robots' walks, folded into what they walk to.

A robot's *walk* changes nothing but its own place, at no risk to anybody; whatever else
it does, a *deed*, happens at one place.  Walks then commute with everything, so a search
need not decide on them: a robot can do a deed at a place if it has been idle for as many
epochs as the way there is long, and pays for the way then.  What would be a product of
the robots' positions becomes a sum (decoupled search, Gnad and Hoffmann 2018, with the
robots as leaves).  Plans get their walks back at the end, right before each deed.

Glossary: *slot* - index of a robot among ``task.robots``; *idle* - per slot, for how many
epochs a robot has done no deed, as far as it matters.
"""

from collections import Counter, deque
from collections.abc import Callable, Iterable, Iterator, Sequence
from itertools import chain
from typing import NamedTuple

from search.best_first import Node
from search.clock import Clock
from search.encoding import Encoding, Op
from search.provision import Places
from search.successors import Idle, Option, Successors, in_time, together
from serendipity.model.plans import Step


class Deed(NamedTuple):
    """An op of robots that is no walk.

    Attributes:
        op: the op.
        need_mask, need: what it asks for, places aside.
        at: where each robot that takes part has to be: slot and place.
    """

    op: Op
    need_mask: int
    need: int
    at: tuple[tuple[int, int], ...]


class Walks:
    """The walks of robots that can be folded; kept with the packed task.

    Args:
        encoding: the packed task.
        clock: asked for time.

    Attributes:
        fields: per slot the place of a robot.
        mask: all of them.
        joint: joint deeds.
        led: deeds without the human, by their first robot.
        foldable: whether every robot's walks can be folded.
    """

    def __init__(self, encoding: Encoding, clock: Clock) -> None:
        self._encoding = encoding
        self._clock = clock
        places = encoding.derived(Places, clock)
        self._bits = [1 << robot for robot in encoding.task.robots]
        self.fields = [places.field[bit] for bit in self._bits]
        self.mask = sum(self.fields)
        self._moves: list[dict[int, list[tuple[int, Op]]]] = [{} for _ in self.fields]
        self._from: dict[tuple[int, int], dict[int, tuple[int, int, int]]] = {}
        self.joint = DeedIndex((), ())
        self.led: list[DeedIndex] = []
        self.foldable = all(self.fields) and self._fold(clock)

    def _fold(self, clock: Clock) -> bool:
        packed = self._encoding
        joint: list[Deed] = []
        led: dict[int, list[Deed]] = {}
        if (packed.goal.mask | packed.robot_goal.mask | packed.own_mask) & self.mask:
            return False
        own_facts = self._place_facts()
        for op in (*packed.joint, *packed.others):
            clock.tick()
            slot = self._walker(op, own_facts)
            if slot >= 0:
                place = self.fields[slot]
                self._moves[slot].setdefault(op.need & place, []).append((op.put & place, op))
                continue
            deed = self._deed(op)
            if deed is None:
                return False
            if op.agents & packed.human_bit:
                joint.append(deed)
            else:
                led.setdefault(op.agents & -op.agents, []).append(deed)
        self.joint = DeedIndex(joint, packed.fields)
        self.led = [DeedIndex(deeds, packed.fields) for _, deeds in sorted(led.items())]
        costs = [{op.cost for moves in way.values() for _, op in moves} for way in self._moves]
        return all(len(cost) <= 1 for cost in costs)

    def _place_facts(self) -> list[set[int]]:
        """Per slot the facts of its place."""
        found: list[set[int]] = [set() for _ in self.fields]
        for fact, bits in enumerate(self._encoding.fact_bits):
            if bits is not None and bits[0] & self.mask:
                found[self.fields.index(bits[0])].add(fact)
        return found

    def _walker(self, op: Op, facts: Sequence[set[int]]) -> int:
        """The slot of the robot that walks in an op, or -1 if it is no walk."""
        if op.agents not in self._bits or op.need < 0:
            return -1
        slot = self._bits.index(op.agents)
        place = self.fields[slot]
        if op.need_mask != place or op.forbidden or not place & ~op.keep:
            return -1
        action = self._encoding.task.actions[op.action]
        mentioned = (*action.pre, *action.neg, *action.add, *action.delete)
        return slot if facts[slot].issuperset(mentioned) else -1

    def _deed(self, op: Op) -> Deed | None:
        """None where a place is left open, or is somebody's who takes no part."""
        at = []
        for slot, (bit, place) in enumerate(zip(self._bits, self.fields, strict=True)):
            if op.agents & bit:
                if op.need_mask & place != place:
                    return None
                at.append((slot, op.need & place))
            elif (op.need_mask | ~op.keep) & place:
                return None
        if any(mask & self.mask for mask, _ in op.forbidden):
            return None
        return Deed(op, op.need_mask & ~self.mask, op.need & ~self.mask, tuple(at))

    def touched_by(self, ops: Iterable[Op]) -> bool:
        """Whether some of the human's ops mention a robot's place."""
        return any(self._encoding.mentioned(op) & self.mask for op in ops)

    def weights(self, weight: Callable[[Op], int]) -> list[int]:
        """Per slot the key increment of one step of a walk."""
        steps = (next((op for moves in way.values() for _, op in moves), None) for way in self._moves)
        return [0 if op is None else weight(op) for op in steps]

    def distance(self, slot: int, here: int, there: int) -> int:
        """Steps from one place to another; -1 if no walk leads there."""
        found = self._ways(slot, here).get(there)
        return -1 if found is None else found[0]

    def farthest(self, slot: int, here: int) -> int:
        """The most steps from a place to another."""
        *_, (steps, _, _) = self._ways(slot, here).values()  # breadth first: the last is the farthest
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
            for op in map(self._encoding.op, node.actions):
                for slot, (bit, place) in enumerate(zip(self._bits, self.fields, strict=True)):
                    if op.agents & bit:
                        walk = self.walk(slot, node.parent.state & place, op.need & place)
                        yield from map(Step, range(node.epoch - len(walk), node.epoch), walk)
            node = node.parent


class DeedIndex:
    """Deeds by the rarest value that they ask for."""

    def __init__(self, deeds: Sequence[Deed], fields: Sequence[int]) -> None:
        by_lowest_bit = {field & -field: field for field in fields}
        asked = [list(_values(deed, by_lowest_bit)) for deed in deeds]
        counts = Counter(chain.from_iterable(asked))
        self._always: list[Deed] = []
        self._by_field: dict[int, dict[int, list[Deed]]] = {}
        for deed, pairs in zip(deeds, asked, strict=True):
            if not pairs:
                self._always.append(deed)
                continue
            field, value = min(pairs, key=lambda pair: counts[pair])
            self._by_field.setdefault(field, {}).setdefault(value, []).append(deed)

    def candidates(self, state: int) -> Iterator[Deed]:
        """Deeds that may be possible in a packed state."""
        yield from self._always
        for field, by_value in self._by_field.items():
            yield from by_value.get(state & field, ())


def _values(deed: Deed, by_lowest_bit: dict[int, int]) -> Iterator[tuple[int, int]]:
    """The fields that a deed asks for, places aside, and their values."""
    left = deed.need_mask
    while left:
        field = by_lowest_bit[left & -left]
        yield field, deed.need & field
        left &= ~field


class FoldedSuccessors(Successors):
    """Successors whose robots do deeds only; their walks are in the weights.

    Args:
        encoding: the packed task.
        walks: the robots' walks, foldable.
        weight: key increment of an op.
        strict: strict interference (SPEC 2).
    """

    def __init__(
        self, encoding: Encoding, walks: Walks, weight: Callable[[Op], int], *, strict: bool
    ) -> None:
        super().__init__(encoding, weight, strict=strict, idle=True)
        self._walks = walks
        self._weight = weight
        self._step = walks.weights(weight)
        self._possible: dict[int, tuple[list[Option], list[list[Option]]]] = {}

    def joint(self, state: int) -> list[Option]:
        """See :class:`Successors`."""
        return self._all(state)[0]

    def beside(
        self, first: Option, state: int, idle: Idle, promising: Callable[[Option], bool]
    ) -> list[Option]:
        """See :class:`Successors`."""
        found = [first]
        for options in self._all(state)[1]:
            more = [
                deed
                for deed in options
                if in_time(deed, idle)
                and not deed.agents & first.agents
                and self._fits(deed, first)
                and promising(together(first, deed))
            ]
            found += [
                together(chosen, deed)
                for deed in more
                for chosen in found
                if not deed.agents & chosen.agents and self._fits(deed, chosen)
            ]
        found.sort(key=lambda option: option.weight)
        return found

    def rested(self, idle: Idle, option: Option, state: int) -> Idle:
        """See :class:`Successors`."""
        busy = {slot for slot, _ in option.due}
        walks = self._walks
        return tuple(
            0 if slot in busy else min(epochs + 1, walks.farthest(slot, state & walks.fields[slot]))
            for slot, epochs in enumerate(idle)
        )

    def _all(self, state: int) -> tuple[list[Option], list[list[Option]]]:
        found = self._possible.get(state)
        if found is None:
            led = [self._options(index, state) for index in self._walks.led]
            found = self._possible[state] = self._options(self._walks.joint, state), led
        return found

    def _options(self, index: DeedIndex, state: int) -> list[Option]:
        """Deeds that are possible after a walk, cheapest first."""
        walks, found = self._walks, []
        for deed in index.candidates(state):
            op = deed.op
            if state & deed.need_mask != deed.need or any(state & m == v for m, v in op.forbidden):
                continue
            weight, keep, put, due = self._weight(op), op.keep, op.put, []
            for slot, place in deed.at:
                field = walks.fields[slot]
                steps = walks.distance(slot, state & field, place)
                if steps < 0:
                    break
                weight += steps * self._step[slot]
                if keep & field:
                    keep, put = keep & ~field, put | place
                due.append((slot, steps))
            else:
                found.append(Option(weight, keep, put, (op.action,), op.agents, tuple(due)))
        found.sort(key=lambda option: option.weight)
        return found
