"""Landmarks of the human: actions of which they need one, whatever robots have left behind but a few values.

Landmarks of one state bound what the human pays from others: those hold that no value in which the other
state differs could make void.

Source: LM-cut of Helmert and Domshlak, Landmarks, critical paths and abstractions (2009), where whatever
robots could provide may be had as well, and is never paid for.
"""

from collections.abc import Callable, Collection, Sequence
from heapq import heapify, heappop, heappush
from typing import Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from search.packed.cost_vector import FAR
from search.packed.packed_task import PackedTask
from search.short_windows.independent.provision import Value
from search.short_windows.independent.rows import Amounts, Rows, codes
from serendipity.model.resources.deadline import Deadline

_UNMET: Final = -1

_AT_ONCE: Final = 8
"""Landmarks that are looked up together, by the bits of a byte."""


class Landmark(NamedTuple):
    """Actions of which the human needs one, or one of some values.

    Attributes:
        cost: what they pay for it at least, other landmarks left out; :data:`FAR` where no action will do.
        void: the values with which it need not be.
    """

    cost: int
    void: frozenset[Value]


class Landmarks:
    """The human's own task without deletes; the amount of each of their operators is above 0."""

    def __init__(self, packed: PackedTask, amount: Callable[..., int], deadline: Deadline) -> None:
        self._deadline = deadline
        self._number: dict[Value, int] = {}
        self._goal = list(map(self._fact, packed.assigned(packed.goal.need_mask, packed.goal.need)))
        asked = [
            list(map(self._fact, packed.assigned(op.need_mask, op.need))) for op in deadline.each(packed.own)
        ]
        self._always = self._fact((0, 0))
        """What is true from the start, for operators that ask for nothing."""
        self._values = list(self._number)
        cheapest: dict[tuple[tuple[int, ...], tuple[int, ...]], int] = {}
        for op, needs in zip(packed.own, asked, strict=True):
            known = map(self._number.get, packed.assigned(packed.all_ones & ~op.keep, op.put))
            adds = tuple(fact for fact in known if fact is not None and fact not in needs)
            if adds:
                shape = tuple(needs) or (self._always,), adds
                cheapest[shape] = min(amount(op), cheapest.get(shape, FAR))
        self._needs = [needs for needs, _ in cheapest]
        self._adds = [adds for _, adds in cheapest]
        self._amounts = list(cheapest.values())
        self._askers = self._by_fact(self._needs)
        self._adders = self._by_fact(self._adds)

    def _fact(self, value: Value) -> int:
        return self._number.setdefault(value, len(self._number))

    def _by_fact(self, lists: list[tuple[int, ...]]) -> list[list[int]]:
        found: list[list[int]] = [[] for _ in self._values]
        for number, facts in enumerate(lists):
            for fact in facts:
                found[fact].append(number)
        return found

    def of(self, state: int, given: Collection[Value]) -> list[Landmark]:
        """Landmarks of a state, whose costs add up; others may have the given values instead of its own."""
        true = [number for (field, value), number in self._number.items() if state & field == value]
        gifts = {number for value in given if (number := self._number.get(value)) is not None}
        return _Cuts(self, true, gifts.difference(true)).found()


class _Cuts:
    """The landmarks of one state, one after another; gifts are facts that robots could provide."""

    def __init__(self, task: Landmarks, true: Collection[int], gifts: Collection[int]) -> None:
        self._needs, self._adds, self._values = task._needs, task._adds, task._values
        self._askers, self._adders, self._goal = task._askers, task._adders, task._goal
        self._deadline = task._deadline
        self._true, self._gifts = true, gifts
        self._left = list(task._amounts)
        self._far = [2 * FAR] * len(self._values)
        """Per fact what the dearest that it takes costs; no gift comes cheap."""
        self._dearest = [_UNMET] * len(self._needs)
        """Per operator the dearest fact that it asks for, once all of them can be had."""
        self._explore()

    def found(self) -> list[Landmark]:
        goal, far = list(self._goal), self._far
        found = []
        while goal:
            self._deadline.tick()
            last = max(goal, key=far.__getitem__)
            if not far[last]:
                break
            is_given = far[last] >= FAR
            zone = self._zone(last, is_given)
            void = frozenset(self._values[fact] for fact in zone if fact in self._gifts)
            if is_given:
                goal.remove(last)
                found.append(Landmark(FAR, void))
                continue
            cut = self._cut(zone)
            least = min(self._left[op] for op in cut)
            found.append(Landmark(least, void))
            self._lower(cut, least)
        return found

    def _explore(self) -> None:
        """How far all facts are."""
        far, missing = self._far, list(map(len, self._needs))
        for fact in self._gifts:
            far[fact] = FAR
        for fact in self._true:
            far[fact] = 0
        queue = [(far[fact], fact) for fact in (*self._true, *self._gifts)]
        heapify(queue)
        while queue:
            distance, fact = heappop(queue)
            if distance > far[fact]:
                continue
            for op in self._askers[fact]:
                missing[op] -= 1
                if not missing[op]:
                    self._dearest[op] = fact
                    self._reach(op, queue)

    def _reach(self, op: int, queue: list[tuple[int, int]]) -> None:
        far = self._far
        distance = far[self._dearest[op]] + self._left[op]
        for fact in self._adds[op]:
            if distance < far[fact]:
                far[fact] = distance
                heappush(queue, (distance, fact))

    def _lower(self, cut: Collection[int], least: int) -> None:
        """Operators cost less from now on, and facts are nearer."""
        far, dearest = self._far, self._dearest
        queue: list[tuple[int, int]] = []
        for op in cut:
            self._left[op] -= least
            self._reach(op, queue)
        while queue:
            distance, fact = heappop(queue)
            if distance > far[fact]:
                continue
            for op in self._askers[fact]:
                if dearest[op] == fact:
                    dearest[op] = max(self._needs[op], key=far.__getitem__)
                    self._reach(op, queue)

    def _zone(self, goal: int, is_given: bool) -> set[int]:
        """Facts from which there is nothing left to pay, as far as the dearest of each operator goes.

        Args:
            goal: what is asked for.
            is_given: it takes a gift; then all facts from which one gets there.
        """
        zone, left, dearest = {goal}, self._left, self._dearest
        stack = [goal]
        while stack:
            for op in self._adders[stack.pop()]:
                fact = dearest[op]
                if fact != _UNMET and fact not in zone and (is_given or not left[op]):
                    zone.add(fact)
                    stack.append(fact)
        return zone

    def _cut(self, zone: set[int]) -> list[int]:
        """Operators that lead from outside into a zone."""
        dearest, adds = self._dearest, self._adds
        before = {fact for fact in (*self._true, *self._gifts) if fact not in zone}
        stack, cut = list(before), []
        while stack:
            fact = stack.pop()
            for op in self._askers[fact]:
                if dearest[op] != fact:
                    continue
                if not zone.isdisjoint(adds[op]):
                    cut.append(op)
                    continue
                for added in adds[op]:
                    if added not in before:
                        before.add(added)
                        stack.append(added)
        return cut


def left_to_pay(landmarks: Sequence[Landmark], rows: Rows) -> Amounts:
    """Lower bounds on what the human pays from packed states, at most :data:`FAR`.

    Args:
        landmarks: of one state; the others differ from it in values only that were given then.
    """
    tables: dict[int, NDArray[np.bool_]] = {}
    for number, landmark in enumerate(landmarks):
        for field, value in landmark.void:
            table = tables.setdefault(
                field, np.zeros((len(landmarks), 1 << field.bit_count()), dtype=np.bool_)
            )
            table[number, value >> (field & -field).bit_length() - 1] = True
    at = {field: codes(rows, field) for field in tables}
    found = np.zeros(rows.shape[1], dtype=np.int64)
    for first in range(0, len(landmarks), _AT_ONCE):
        some = slice(first, first + _AT_ONCE)
        void = np.zeros(rows.shape[1], dtype=np.uint8)
        for field, table in tables.items():
            if table[some].any():
                void |= np.packbits(table[some], axis=0, bitorder="little")[0][at[field]]
        found += _sums([landmark.cost for landmark in landmarks[some]])[void]
        np.minimum(found, FAR, out=found)
    return found


def _sums(costs: Sequence[int]) -> Amounts:
    """By the bits of a byte what all landmarks but those cost."""
    found = np.zeros(1, dtype=np.int64)
    for cost in (*costs, *[0] * (_AT_ONCE - len(costs))):
        found = np.concatenate([found + cost, found])
    return found
