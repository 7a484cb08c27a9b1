"""Successors: sets of actions that agents can do in one epoch (semantics 2).

Ops are looked up under their leader by the value of one field, the one that most
of the leader's actions ask for (a position, as a rule).
"""

from collections.abc import Callable, Collection, Iterable, Iterator, Sequence
from itertools import chain
from typing import Final

from search.packed.due import Due
from search.packed.joint_actions import NOTHING, Idle, JointAction, as_option, together
from search.packed.operator_index import OperatorIndex
from search.packed.operators import Operator, applicable, asked_by
from search.packed.packed_task import PackedTask
from search.packed.table import StateCache
from serendipity.model.resources.deadline import Deadline
from serendipity.model.task.actions import disables

MOST_KEPT: Final = 50_000
"""Options that are kept for states: some 10 MiB, and more than the search for a building asks for."""

_MANY = 1023
"""All ones in binary: sets of actions between two looks at the deadline, less one."""


class Lookup:
    """Weighted ops of one leader; what a value of the index allows is put together once."""

    def __init__(
        self, index: OperatorIndex[Operator], weight: Callable[[Operator], int], barred: Collection[int] = ()
    ) -> None:
        self._index = index
        self._field = index.field
        self._weight = weight
        self._barred = barred
        self._weighted: dict[int, list[tuple[Operator, JointAction]]] = {}

    def options(self, state: int) -> list[JointAction]:
        """What is applicable in a packed state, cheapest first."""
        candidates = self._weighted.get(state & self._field)
        if candidates is None:
            candidates = self._prepare(state)
        return [
            option
            for op, option in candidates
            if state & op.need_mask == op.need and (not op.forbidden or applicable(op, state))
        ]

    def _prepare(self, state: int) -> list[tuple[Operator, JointAction]]:
        allowed = (op for op in self._index.candidates(state) if op.action not in self._barred)
        found = [(op, as_option(op, self._weight(op))) for op in allowed]
        found.sort(key=lambda pair: (pair[1].weight, pair[0].action))
        self._weighted[state & self._field] = found
        return found


class BesideScript(Lookup):
    """The human's options, each with what bystanders do in its epoch, and with what the clock changes."""

    def __init__(self, packed: PackedTask, weight: Callable[[Operator], int], *, strict: bool) -> None:
        super().__init__(packed.own_index, weight)
        self._due = Due(packed, weight, strict=strict)
        waits = [packed.op(action) for action in packed.idling if not packed.prices_waiting]
        self._waiting = [as_option(op, weight(op)) for op in waits]  # else it is in the index

    def options(self, state: int) -> list[JointAction]:
        """What is possible in a packed state."""
        going_on = self._due.human(state)
        found = super().options(state) if going_on is None else [*going_on]
        others = self._due.others(state)
        if self._due.last(state) is None and others and not others[0].actions:
            return found
        if going_on is None:
            found += self._waiting
        return list(self._due.with_last(self._beside(found, others), state))

    def _beside(self, found: list[JointAction], others: list[JointAction]) -> Iterator[JointAction]:
        for theirs in others:
            for option in found:
                if self._due.fits(option, theirs):
                    yield together(option, theirs)._replace(weight=option.weight)


class Successors:
    """Applicable action sets of a task.

    Args:
        weight: key increment of an op.
        idle: robots do nothing.
        barred: ids of actions of robots, alone or with the human, that nobody may do.

    Attributes:
        due: what happens whatever is chosen.
        in_time: whether epochs count.
        idle: the human's part of an epoch in which they do nothing, unless waiting is among their actions.
    """

    def __init__(
        self,
        packed: PackedTask,
        weight: Callable[[Operator], int],
        deadline: Deadline,
        *,
        strict: bool,
        idle: bool = False,
        barred: Collection[int] = (),
    ) -> None:
        self._packed = packed
        self._deadline = deadline
        self._strict = strict
        self._own = Lookup(packed.own_index, weight)
        self._joint = Lookup(packed.joint_index, weight, barred) if packed.joint and not idle else None
        self._led = [] if idle else [Lookup(index, weight, barred) for index in packed.robot_indices]
        self.due = Due(packed, weight, strict=strict)
        self._fits = self.due.fits
        self.in_time = packed.in_time
        self.idle = () if packed.prices_waiting else (NOTHING,)
        self._busy: StateCache[list[JointAction]] = StateCache(MOST_KEPT)
        self._changing: StateCache[list[JointAction]] = StateCache(MOST_KEPT)

    def human(self, state: int) -> list[JointAction]:
        """What the human can do alone in a packed state, cheapest first (not: wait)."""
        return self._own.options(state)

    def joint(self, state: int) -> list[JointAction]:
        """Joint actions with the human that are applicable."""
        return self._joint.options(state) if self._joint is not None else []

    def free(self, state: int) -> Sequence[JointAction]:
        """What the human may do where they follow no plan: go on, or wait and whatever they can."""
        going_on = self.due.human(state)
        return (*self.idle, *self.human(state), *self.joint(state)) if going_on is None else going_on

    def name(self, part: JointAction) -> str | None:
        """The name of what the human begins; None where they wait, or go on."""
        acts = part.actions and self._packed.counted(part.actions[0])
        return self._packed.task.actions[part.actions[0]].name if acts else None

    def robots(self, state: int) -> list[JointAction]:
        """Every applicable set of actions of the robots without the human, cheapest first."""
        return self._busy.get(state) or self._sets(state, self._busy)

    def begun(self, state: int) -> Sequence[JointAction]:
        """The same without what goes on, and what bystanders do."""
        if not self.due:
            return self.robots(state)
        for due in self.due.others(state):
            each = (lookup.options(state) for lookup in self._led)
            return self._sets_of([NOTHING], ([o for o in options if self._fits(o, due)] for options in each))
        return ()

    def with_due(self, begun: JointAction, state: int) -> JointAction | None:
        """What robots begin, with what goes on and what bystanders do; None where they are in the way."""
        for due in self.due.others(state):
            parts = (as_option(self._packed.op(action), 0) for action in begun.actions)
            if not due.actions or all(self._fits(part, due) for part in parts):
                return together(due, begun)
        return None

    def with_robots(self, first: JointAction, state: int) -> Iterator[JointAction]:
        """``first`` (the human's part) alone and with each set of robots' actions that fits it."""
        return self.due.with_last(self._combine(first, self.robots(state)), state)

    def with_changers(self, first: JointAction, state: int, fields: int) -> Iterator[JointAction]:
        """The same, of robots' actions only those that set some of the fields."""
        sets = self._changing.get(state) or self._sets(state, self._changing, fields)
        return self.due.with_last(self._combine(first, sets), state)

    def _sets(
        self, state: int, kept: StateCache[list[JointAction]], fields: int | None = None
    ) -> list[JointAction]:
        """Sets of robots' actions, cheapest first; of those only that set some fields, if any are named."""
        each = (lookup.options(state) for lookup in self._led)
        if fields is not None:
            each = ([o for o in options if ~o.keep & fields] for options in each)
        found = self._sets_of(self.due.others(state), each)
        found.sort(key=lambda option: option.weight)
        kept.keep(state, found, len(found))
        return found

    def beside(
        self, first: JointAction, state: int, idle: Idle, promising: Callable[[JointAction], bool]
    ) -> Iterable[JointAction]:
        """The same, cheapest first, as far as it is possible and worth looking at.

        Args:
            first: the human's part.
            idle: for how long robots have been idle.
            promising: whether the part and what one robot does are worth looking at.
        """
        return self.with_robots(first, state)

    def rested(self, idle: Idle, option: JointAction, state: int) -> Idle:
        """For how long robots are idle after an epoch."""
        return ()

    def groups(self, state: int) -> list[list[JointAction]]:
        """Applicable actions by who leads them: the human, alone or jointly, then each robot."""
        return [[*self.human(state), *self.joint(state)], *(lookup.options(state) for lookup in self._led)]

    def in_turn(self, state: int) -> Iterator[tuple[JointAction, JointAction]]:
        """What can happen next where epochs don't count: one action, or a set that needs one epoch.

        The human's part comes first, then the whole.
        """
        groups = self.groups(state)
        for part in groups[0]:
            yield part, part
        for option in chain.from_iterable(groups[1:]):
            yield NOTHING, option
        if not self._strict:  # which keeps apart what could be in a circle
            yield from self._circles([self._entangled(group, groups) for group in groups])

    def _entangled(self, group: list[JointAction], groups: list[list[JointAction]]) -> list[JointAction]:
        """Options that may disable others of the groups, and be disabled by them."""
        asked = changed = 0
        for option in chain.from_iterable(other for other in groups if other is not group):
            asked |= self._asked(option)
            changed |= ~option.keep
        return [o for o in group if ~o.keep & asked and self._asked(o) & changed]

    def _asked(self, option: JointAction) -> int:
        """The fields that a single action asks for."""
        return asked_by(self._packed.op(option.actions[0]))

    def _circles(self, groups: list[list[JointAction]]) -> Iterator[tuple[JointAction, JointAction]]:
        """Sets of one option from each of several groups that can't be done in a sequence."""
        sets = self._sets_of([NOTHING], groups[1:])
        for part in (NOTHING, *groups[0]):
            for option in self._combine(part, sets):
                if len(option.actions) > 1 and not self.sequential(option.actions):
                    yield part, option

    def sequential(self, actions: tuple[int, ...]) -> bool:
        """Whether a compatible set has the same effect one action after another, in some order.

        It does not where actions disable each other in a circle: then it needs one epoch.
        """
        left = [self._packed.task.actions[i] for i in actions]
        while left:
            last = next((a for a in left if not any(b is not a and disables(b, a) for b in left)), None)
            if last is None:
                return False
            left.remove(last)
        return True

    def _sets_of(self, sets: list[JointAction], groups: Iterable[list[JointAction]]) -> list[JointAction]:
        """Some sets, alone and with one option at most from each of several groups that fits."""
        for options in groups:
            for chosen in sets[:]:
                self._deadline.tick()
                sets += [together(chosen, option) for option in options if self._fits(option, chosen)]
        return sets

    def _combine(self, first: JointAction, sets: list[JointAction]) -> Iterator[JointAction]:
        for number, chosen in enumerate(sets):
            if not number & _MANY:
                self._deadline.check()
            if not chosen.actions:
                yield first
            elif self._fits(first, chosen):
                yield together(first, chosen)


def in_time(option: JointAction, idle: Idle) -> bool:
    """Whether robots have been idle for long enough to have walked to their deeds."""
    late = [slot for slot, steps in option.due if idle[slot] < steps]  # thrice as fast as a generator
    return not late
