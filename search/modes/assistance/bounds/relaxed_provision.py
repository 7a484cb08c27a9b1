"""A lower bound on what the prime still pays: the supporter provides whatever they need, in time.

Their *private* fields are those that only they change, *provided* ones those that only the
supporter changes.  Projected onto the private fields, each of their actions is a
transition; conditions on other fields are dropped.  A dropped condition on a provided
field that does not hold now is charged to the supporter, at the price of the cheapest
action that makes it true, where it is certain that it is charged once at most: where
every action that asks for it sets, for the first time, one and the same fact that
nothing ever unsets.  No plan of both together, with turns or without, is cheaper.
"""

from collections.abc import Iterable
from dataclasses import dataclass
from functools import partial
from typing import NamedTuple

from search.engine.astar import AStar
from search.modes.assistance.game.game import Game
from search.packed.cost_vector import INFINITE_KEY
from search.packed.operator_index import OperatorIndex, most_asked
from search.packed.operators import Operator
from search.packed.packed_task import PackedGoal

Pair = tuple[int, int]
"""A field and a value of it."""


class ChargedStep(NamedTuple):
    """One of the prime's actions, projected; ``charges`` are due where their bit is unset."""

    condition: PackedGoal
    keep: int
    put: int
    cost: int
    charges: tuple[tuple[int, int, Pair], ...]
    """Supporter's cost, the bit that is set for the first time, what is asked for."""


_Known = dict[int, tuple[int, ChargedStep | None, int]]
"""By projected state its exact value, the first step of a cheapest way, the state after it."""


@dataclass(frozen=True, slots=True)
class _Context:
    """What is provided now: the steps under it, and what is known of states under it."""

    steps: OperatorIndex[ChargedStep]
    per_goal: dict[int, int]
    """Least value of a step that sets a bit of the goal."""
    known: _Known


class RelaxedProvision:
    """The bound; consistent over the moves of both."""

    def __init__(self, game: Game) -> None:
        self._game = game
        packed = game.packed
        by_prime = packed.changed_by(packed.own)
        by_supporter = packed.changed_by(game.supporter_ops)
        self._private = by_prime & ~by_supporter
        self._provided = by_supporter & ~by_prime
        self._monotone = _monotone(packed.own, self._private, packed.fields)
        private = [field for field in packed.fields if field & self._private]
        self._field = most_asked(private, ((op.need_mask, 1) for op in packed.own))
        self._setters = self._find_setters()
        self._charged = self._find_charged()
        self._goal = game.goal.within(self._private)
        self._countable = self._find_countable()
        self._contexts: dict[int, _Context] = {}

    def __call__(self, state: int) -> int:
        """A value that no policy undercuts from ``state``."""
        if self._game.goal.need < 0:
            return INFINITE_KEY
        return self._search(self._context(state), state & self._private)

    def wanted(self, state: int) -> frozenset[int]:
        """Actions of the supporter that provide what a cheapest way is charged for."""
        context = self._context(state)
        at = state & self._private
        if self._search(context, at) >= INFINITE_KEY:
            return frozenset()
        wanted: set[int] = set()
        while True:
            _, step, after = context.known[at]
            if step is None:
                return frozenset(wanted)
            for _, bit, pair in step.charges:
                if not at & bit:
                    wanted.update(op.action for op in self._setters[pair])
            at = after

    def _find_setters(self) -> dict[Pair, list[Operator]]:
        setters: dict[Pair, list[Operator]] = {}
        for op in self._game.deadline.each(self._game.supporter_ops):
            for pair in self._game.packed.assigned(self._provided & ~op.keep, op.put):
                setters.setdefault(pair, []).append(op)
        return setters

    def _asked(self, op: Operator) -> Iterable[Pair]:
        return self._game.packed.assigned(op.need_mask & self._provided, op.need)

    def _find_charged(self) -> dict[Pair, tuple[int, int]]:
        """For each condition that is charged its price and the bit that is set with it."""
        packed, together = self._game.packed, dict[Pair, int]()
        for op in self._game.deadline.each(packed.own):
            for pair in self._asked(op):
                first_set = op.put & self._monotone
                together[pair] = together.get(pair, first_set) & first_set
        bits = {pair: bit & -bit for pair, bit in together.items() if bit and pair in self._setters}
        charged = {}
        for pair, bit in bits.items():
            prices = []
            for op in self._game.deadline.each(self._setters[pair]):
                also = sum(set_too in bits for set_too in packed.assigned(packed.all_ones & ~op.keep, op.put))
                prices.append(self._game.cost(op) // also)
            charged[pair] = (min(prices), bit)
        return charged

    def _find_countable(self) -> int:
        """Bits of the goal that each cost a step of their own; none if a step can set two."""
        bits = self._goal.need & self._goal.need_mask & self._monotone
        if any((op.put & bits).bit_count() > 1 for op in self._game.packed.own):
            return 0
        return bits

    def _context(self, state: int) -> _Context:
        provided = state & self._provided
        if provided not in self._contexts:
            self._contexts[provided] = self._make_context(provided)
        return self._contexts[provided]

    def _make_context(self, provided: int) -> _Context:
        steps: OperatorIndex[ChargedStep] = OperatorIndex(self._field)
        least: dict[int, Pair] = {}
        for op in self._game.deadline.each(self._game.packed.own):
            step = self._step(op, provided)
            if step is None:
                continue
            steps.add(op.need_mask, op.need, step)
            bit = op.put & self._countable
            if bit:
                charge = sum(price for price, set_with, _ in step.charges if set_with == bit)
                cost, price = least.get(bit, (step.cost, charge))
                least[bit] = (min(cost, step.cost), min(price, charge))
        per_goal = {bit: (cost << self._game.unit_bits) + price for bit, (cost, price) in least.items()}
        return _Context(steps, per_goal, {})

    def _step(self, op: Operator, provided: int) -> ChargedStep | None:
        """An op under what is provided; None if it can never be applied."""
        private = self._private
        charges = []
        for pair in self._asked(op):
            field, value = pair
            if provided & field == value:
                continue
            if pair not in self._setters:
                return None
            if pair in self._charged:
                price, bit = self._charged[pair]
                charges.append((price, bit, pair))
        condition = PackedGoal(op.need_mask, op.need, op.forbidden).within(private)
        return ChargedStep(condition, op.keep, op.put & private, self._game.cost(op), tuple(charges))

    def _least(self, context: _Context, at: int) -> int:
        """What is known, or else that every bit of the goal that is missing costs a step."""
        if at in context.known:
            return context.known[at][0]
        missing = self._game.packed.split(self._countable & ~at)
        return min(sum(context.per_goal.get(bit, INFINITE_KEY) for bit in missing), INFINITE_KEY)

    def _search(self, context: _Context, start: int) -> int:
        """A* over the private fields; it ends at goals and at states whose value is known."""
        known = context.known
        if start in known:
            return known[start][0]
        deadline = self._game.deadline
        search = AStar(start, partial(self._least, context), deadline, limit=INFINITE_KEY, deep_first=True)
        for at, spent in search:
            if at not in known and self._goal.holds(at):
                known[at] = (0, None, at)
            if at in known:
                return self._remember(known, search, at)
            for value, after, step in self._steps_from(context, at):
                search.reach(after, spent + value, at, (step, value))
        known[start] = (INFINITE_KEY, None, start)
        return INFINITE_KEY

    @staticmethod
    def _remember(known: _Known, search: AStar[int], end: int) -> int:
        """Note the values of all states along a cheapest way, from its end on; that of its start."""
        value, at = known[end][0], end
        for before, (step, weight) in search.way_back(end):
            value += weight
            known[before] = (value, step, at)
            at = before
        return value

    def _steps_from(self, context: _Context, at: int) -> Iterable[tuple[int, int, ChargedStep]]:
        """What the prime can do: its value with what is charged, the state after it, the step."""
        for step in context.steps.candidates(at):
            after = at & step.keep | step.put
            if after != at and step.condition.holds(at):
                charge = sum(price for price, bit, _ in step.charges if not at & bit)
                yield (step.cost << self._game.unit_bits) + charge, after, step


def _monotone(ops: Iterable[Operator], private: int, fields: list[int]) -> int:
    """The private single-bit fields that no action unsets."""
    bits = sum(field for field in fields if field & private and field.bit_count() == 1)
    for op in ops:
        bits &= op.keep | op.put
    return bits
