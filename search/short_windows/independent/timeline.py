"""One robot beside the human's timetable: what it can have made of the world by each epoch, and at what cost.

The other robots are left out, but for this: what one of them can have provided by then (:mod:`.provision`)
may be asked for as if it had, at the cost of what it does to no other end (:func:`.detours`).  Whatever a
robot does in a plan of all, it does here too, and what it was the last to set has the same value; so the
costs are lower bounds, and exact where robots have nothing to do with each other.
"""

from collections.abc import Callable, Iterator, Sequence
from typing import Final, NamedTuple

import numpy as np

from search.call.context import SearchContext
from search.packed.cost_vector import FAR, NEVER
from search.packed.operators import Operator, asked_by, union
from search.short_windows.independent.provision import Provision, detours, leaves
from search.short_windows.independent.rows import Amounts, Flags, Rows, agree, cheapest, codes, column
from serendipity.model.errors import LimitReachedError

MOST_STATES: Final = 200_000
"""Of a robot after an epoch."""

AT_ONCE: Final = 500_000
"""Found before they are sorted: nobody looks at the clock meanwhile."""


class TooManyStatesError(LimitReachedError):
    """A robot can bring the world into more states than are looked at."""

    def __init__(self) -> None:
        super().__init__("too-many-states")


class Layer(NamedTuple):
    """States after some epochs.

    Attributes:
        rows: the states, in the fields that matter to the robot.
        amounts: what the robot has paid by then, at least.
        fresh: which of them what the robot can do next may be new for.
    """

    rows: Rows
    amounts: Amounts
    fresh: Flags


class _Literal(NamedTuple):
    """A condition of an operator's, by field and value, and when others can have seen to it."""

    field: int
    value: int
    epoch: int


class _Act(NamedTuple):
    """One of the robot's operators, or of the human's.

    Attributes:
        needs: what it asks for.
        forbids: what it must not find.
    """

    op: Operator
    amount: int
    needs: list[_Literal]
    forbids: list[_Literal]


class RobotLayers:
    """A robot's states, epoch by epoch.

    Attributes:
        changes: the fields that the robot sets.
    """

    def __init__(
        self,
        context: SearchContext,
        robot: int,
        steps: Sequence[Operator],
        others: Provision,
        amount: Callable[[Operator], int],
    ) -> None:
        self._packed = packed = context.packed
        self._others = others
        self._strict = context.options.strict
        self._relevant = context.relevant
        self._deadline = deadline = context.deadline
        self._words = max(1, -(-packed.all_ones.bit_length() // 64))
        ops = [op for op in packed.others if op.agents == robot]
        self.changes = packed.changed_by(ops)
        self._settable: dict[int, dict[int, int]] = {}
        for (field, value), epoch in others.items():
            self._settable.setdefault(field, {})[value] = epoch
        self._acts = [self._act(op, amount(op)) for op in deadline.each(ops)]
        self._steps = [self._act(op, 0, self.changes) for op in steps]
        """What the human asks for of what the robot sets."""
        self._local = union(map(packed.mentioned, ops))
        self._asked = self._local & ~self.changes | union(map(asked_by, ops))
        self._detours = {
            field: detours(packed, field, robot, amount, deadline)
            for field in leaves(packed)
            if field in self._settable
        }
        self._every = self._acts, self._local
        """What the robot can do and the fields that matter, before any of them was forgotten."""
        self._changing = {n.epoch for act in self._acts for n in (*act.needs, *act.forbids)}
        start = column(packed.init & self._local, self._words)
        self._last = Layer(start, np.zeros(1, dtype=np.int64), np.ones(1, dtype=np.bool_))
        self._layers = [self._last]
        self._free: Layer | None = None

    def _act(self, op: Operator, amount: int, fields: int = -1) -> _Act:
        """An operator, with what it asks for of some fields."""
        needs = [
            _Literal(field, value, self._others.get((field, value), NEVER))
            for field, value in self._packed.assigned(op.need_mask & fields, op.need)
        ]
        forbidden = (pair for pair in op.forbidden if pair[0] & fields)
        forbids = [_Literal(field, value, self._rid_of(field, value)) for field, value in forbidden]
        return _Act(op, amount, needs, forbids)

    def _rid_of(self, field: int, value: int) -> int:
        """After how many epochs others can have set a field to another value."""
        epochs = (e for other, e in self._settable.get(field, {}).items() if other != value)
        return min(epochs, default=NEVER)

    @property
    def epochs(self) -> int:
        """How many epochs of the human's plan have been followed."""
        return len(self._layers) - 1

    @property
    def is_exact(self) -> bool:
        """Whether no field has been forgotten."""
        return self._local == self._every[1]

    def ends(self) -> Layer:
        """States after one more epoch in which the human waits."""
        if self._free is None:
            self._free = self._in_room(lambda: self._moved(self._last, None))
        return self._free

    def _in_room(self, make: Callable[[], Layer]) -> Layer:
        """A layer, for which as much is forgotten as it takes."""
        while True:
            try:
                return make()
            except TooManyStatesError:
                self._forget()

    def _forget(self) -> None:
        """Look no longer at a field of the robot's own: from now on it has whatever value is asked for.

        Of those without which at most half of the states are left it is the one that the fewest ask for.

        Raises:
            TooManyStatesError: there is no such field.
        """
        rows, best = self._last.rows, None
        for field in self._packed.split(self.changes & self._local & ~self._relevant):
            without = rows & column(~field & self._local, self._words)
            kept = cheapest(without, self._last.amounts, self._deadline)
            askers = sum(bool(field & act.op.need_mask) for act in self._acts)
            if 2 * len(kept) <= rows.shape[1] and (best is None or askers < best[0]):
                best = askers, field
        if best is None:
            raise TooManyStatesError
        forgotten = best[1]
        self._local &= ~forgotten
        self._asked &= ~forgotten
        self._acts = [
            act._replace(
                needs=[literal for literal in act.needs if literal.field != forgotten],
                forbids=[literal for literal in act.forbids if literal.field != forgotten],
            )
            for act in self._acts
        ]
        fresh = np.ones(rows.shape[1], dtype=np.bool_)
        self._free = None
        self._last = self._distinct(rows & column(self._local, self._words), self._last.amounts, fresh)

    def follow(self, most: int) -> None:
        """One more epoch of the human's plan.

        Args:
            most: states that cost as much are left out.

        Raises:
            LimitReachedError: there are too many states, or the deadline came.
        """
        self._last = self._in_room(lambda: self._followed(self._steps[self.epochs], most))
        self._layers.append(self._last)
        self._free = None

    def _followed(self, planned: _Act, most: int) -> Layer:
        epoch, layer, step = len(self._layers), self._last, planned.op
        fits = self._able(planned, layer.rows, epoch)
        in_the_way = any(not self._beside(act, step) for act in self._acts)
        if in_the_way or not fits.all():
            layer = self._moved(Layer(layer.rows[:, fits], layer.amounts[fits], layer.fresh[fits]), step)
        else:
            layer = self.ends()
        rows = self._after(layer.rows, step)
        fresh = layer.fresh | (in_the_way or epoch in self._changing or self._stirs(step))
        kept = layer.amounts < most
        return self._distinct(rows[:, kept], layer.amounts[kept], fresh[kept])

    def _stirs(self, step: Operator) -> bool:
        """Whether a step of the human's changes what the robot can do, or undoes what it has done."""
        changed = self._packed.all_ones & ~step.keep
        if changed & self._asked:
            return True
        return any((act.op.put ^ step.put) & changed & ~act.op.keep for act in self._acts)

    def _beside(self, act: _Act, step: Operator) -> bool:
        return self._packed.compatible(step.action, act.op.action, self._strict)

    def _after(self, rows: Rows, op: Operator) -> Rows:
        """States after an operator, in the fields that matter."""
        keep, put = op.keep & self._local, op.put & self._local
        return rows & column(keep, self._words) | column(put, self._words)

    def _moved(self, layer: Layer, step: Operator | None) -> Layer:
        """States after the robot's part of the next epoch; ``step``: what the human does in it."""
        amounts = layer.amounts[layer.fresh]
        rows = layer.rows[:, layer.fresh]
        found = [layer._replace(fresh=np.zeros_like(layer.fresh))]
        size = 0
        for act in self._acts:
            self._deadline.check()
            if step is not None and not self._beside(act, step):
                continue
            able = self._able(act, rows, len(self._layers))
            if able.any():
                spent = amounts[able] + self._paid(act, rows[:, able], len(self._layers))
                can = spent < FAR
                after, spent = self._after(rows[:, able][:, can], act.op), spent[can]
                found.append(Layer(after, spent, np.ones_like(spent, dtype=np.bool_)))
                size += len(spent)
                if size > AT_ONCE:
                    found, size = [self._merged(found)], 0
        return self._merged(found)

    def _merged(self, layers: Sequence[Layer]) -> Layer:
        """Each state of some layers once."""
        self._deadline.require(5 * sum(layer.rows.nbytes + layer.amounts.nbytes for layer in layers))
        merged = self._distinct(*(np.concatenate(some, axis=-1) for some in zip(*layers, strict=True)))
        if len(merged.amounts) > MOST_STATES:
            raise TooManyStatesError
        return merged

    def _distinct(self, rows: Rows, amounts: Amounts, fresh: Flags) -> Layer:
        kept = cheapest(rows, amounts, self._deadline, fresh)
        return Layer(rows[:, kept], amounts[kept], fresh[kept])

    def _paid(self, act: _Act, rows: Rows, epoch: int) -> Amounts:
        """What an act costs after states, with what others pay for what it takes from them."""
        paid = np.full(rows.shape[1], act.amount, dtype=np.int64)
        for field, value, soonest in act.needs:
            if soonest < epoch and field in self._detours:
                there = value >> (field & -field).bit_length() - 1
                paid = np.minimum(paid + self._detours[field][codes(rows, field), there], FAR)
        return paid

    def _able(self, act: _Act, rows: Rows, epoch: int) -> Flags:
        """After which states something can be done in an epoch, unless others see to what is missing."""
        mask = value = 0
        for literal in act.needs:
            if literal.epoch >= epoch:
                mask |= literal.field
                value |= literal.value
        able = agree(rows, mask, value)
        for literal in act.forbids:
            if literal.epoch >= epoch:
                able &= ~agree(rows, literal.field, literal.value)
        return able

    # -- the way back

    def way(self, epochs: int, mask: int, end: int, amount: int) -> list[Operator | None]:
        """What the robot does epoch by epoch, at a cost, to a state at the end of :meth:`ends`.

        Args:
            epochs: how many of the human's plan had been followed then; no field had been forgotten.
            mask: the fields that are asked about.
            end: their values.
            amount: what it has paid.
        """
        found: list[Operator | None] = []
        now, (self._acts, self._local) = (self._acts, self._local), self._every
        try:
            for epoch in range(epochs + 1, 0, -1):
                op, mask, end, amount = self._before(epoch, mask, end, amount, last=not found)
                found.append(op)
        finally:
            self._acts, self._local = now
        found.reverse()
        return found

    def _before(
        self, epoch: int, mask: int, end: int, amount: int, *, last: bool
    ) -> tuple[Operator | None, int, int, int]:
        """A last action, or None, and the state and the cost before it."""
        layer = self._layers[epoch - 1]
        step, fits = None, np.ones(len(layer.amounts), dtype=np.bool_)
        if not last:
            step, fits = self._steps[epoch - 1].op, self._able(self._steps[epoch - 1], layer.rows, epoch)
        for op, before, rows in self._ways(layer, epoch, amount, fits, step):
            after = rows if op is None else self._after(rows, op)
            if step is not None:
                after = self._after(after, step)
            right = agree(after, mask, end).nonzero()[0]
            if len(right):
                state = int.from_bytes(rows[:, right[0]].tobytes(), "little")
                return op, self._local, state, before
        raise AssertionError("every state but the first has one before it")

    def _ways(
        self, layer: Layer, epoch: int, amount: int, fits: Flags, step: Operator | None
    ) -> Iterator[tuple[Operator | None, int, Rows]]:
        """Per last action what had been paid before it, and from which states it is possible."""
        yield None, amount, layer.rows[:, fits & (layer.amounts == amount)]
        for act in self._acts:
            self._deadline.check()
            if step is None or self._beside(act, step):
                known = np.flatnonzero(fits & (layer.amounts + act.amount <= amount))
                known = known[self._able(act, layer.rows[:, known], epoch)]
                paid = self._paid(act, layer.rows[:, known], epoch)
                known = known[layer.amounts[known] + paid == amount]
                for before in np.unique(layer.amounts[known]):
                    yield act.op, int(before), layer.rows[:, known[layer.amounts[known] == before]]
