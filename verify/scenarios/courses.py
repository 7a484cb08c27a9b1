"""What may happen in an epoch of one scenario: rules 1 to 3 of semantics 3.1, beside what robots do."""

from collections.abc import Callable, Iterator
from fractions import Fraction
from functools import cache
from typing import Final, NamedTuple

from verify.base.execution import State, fits, sets_beside
from verify.base.fact_bits import BitOperator, BitOperators, FactBits, each_bit
from verify.base.optimal_plans import Worth
from verify.base.relevance import relevant_part
from verify.base.subproblem import FREE
from verify.calls.call import ExaminedCall
from verify.exhaustive.without_epochs import LeastLeft

FOLLOWS, INSIDE, OVER = range(3)
"""Phases of a scenario: before its window, or without one; in it; after it."""

INFINITE: Final = 1 << 20_000
"""Of what can't be: more than anything costs."""

Seen = tuple[str, tuple[int, ...]] | None
"""What robots see the human do: an action by name and participants, in whichever variant; None: they wait."""


class Member(NamedTuple):
    """A scenario that robots hold possible, as far as it has come.

    Attributes:
        scenario: its number.
        state: as bits.
        phase: of its window.
        epochs: of its window, where their number is limited; else 0.
        ahead: what it has paid more than that of its group which has paid least, where the greatest counts.
    """

    scenario: int
    state: int
    phase: int = FOLLOWS
    epochs: int = 0
    ahead: int = 0


class Way(NamedTuple):
    """What a scenario does in an epoch: what is seen of it, what it pays, and where it is then."""

    seen: Seen
    paid: int
    after: Member


_WAITS: Final = BitOperator(0, 0, 0, 0, 0)
_DONE: Final = (Fraction(0), 0)


class Moves:
    """What everybody can do in a state, which does not depend on the scenario.

    Args:
        call: of any of the scenarios.
        pay: units of cost as the search counts them.
    """

    def __init__(self, call: ExaminedCall, pay: Callable[[int], int]) -> None:
        self._task, self._call = call.task, call
        self.bits = FactBits(range(len(call.task.facts)))
        of, team, deadline = self.bits.of, call.prices.team, call.effort.deadline
        self.operators = [
            BitOperator(of(a.pre), of(a.neg), of(a.add), of(a.delete), pay(team[i]), i)
            for i, a in enumerate(deadline.each(call.task.actions))
        ]
        theirs = {i for i, a in enumerate(call.task.actions) if call.task.human not in a.participants}
        self._own = BitOperators((op for op in self.operators if op.label in theirs), deadline)
        self._parts = BitOperators((op for op in self.operators if op.label not in theirs), deadline)
        self.robots, self.human, self.fits = cache(self._robots), cache(self._human), cache(self._fits)

    def _robots(self, state: int) -> tuple[BitOperator, ...]:
        """All that robots can do by themselves, as operators labelled by all actions, nothing first."""
        candidates = sorted(op.label for op in self._own.applicable(state))
        strict = self._call.options.strict
        sets = sets_beside(self._task, (), candidates, self._call.effort.deadline, strict=strict)
        return tuple(self._as_one(chosen) for chosen in sets)

    def _as_one(self, chosen: tuple[int, ...]) -> BitOperator:
        add = delete = paid = 0
        for i in chosen:
            operator = self.operators[i]
            add, delete, paid = add | operator.add, delete | operator.delete, paid + operator.weight
        return BitOperator(0, 0, add, delete, paid, chosen)

    def _human(self, state: int) -> tuple[BitOperator, ...]:
        """All that the human can do, joint actions included, waiting first."""
        return _WAITS, *self._parts.applicable(state)

    def _fits(self, part: int | None, robots: tuple[int, ...]) -> bool:
        """Whether the human's part can share an epoch with what robots do."""
        actions, strict = self._task.actions, self._call.options.strict
        return part is None or fits(actions[part], (actions[i] for i in robots), strict=strict)

    def seen(self, part: BitOperator) -> Seen:
        """What robots see of the human's part."""
        if part.label is None:
            return None
        action = self._task.actions[part.label]
        return action.name, action.participants


class Course:
    """The epochs of one scenario.

    Args:
        call: the scenario as a call of its own.
        moves: what everybody can do.
        pay: units of cost as the search counts them.
        epoch: an epoch of window likewise.
    """

    def __init__(self, call: ExaminedCall, moves: Moves, pay: Callable[[int], int], epoch: int) -> None:
        self._call, self._moves, self._pay, self._epoch = call, moves, pay, epoch
        self._plan = [moves.operators[i] for i in call.human_plan or ()]
        self._horizon = int(call.horizon)
        self._most = call.options.max_window
        question = call.question.but(rule=FREE)
        part = relevant_part(question)
        assert part is not None, "only goals that the human reaches are considered"
        self._left, of = LeastLeft(question, part), moves.bits.of
        self._asked, self._matters = of(call.plans.alone.own.facts), of(self._left.facts)
        self._worth, self._step = cache(self._worth_of), cache(self._step_of)
        self._bound = cache(self._bound_of)

    def least(self, at: Member, epoch: int) -> int:
        """No less is left to pay after an epoch; after the last one exactly that."""
        if at.phase == OVER:
            worth = self._worth(at.state & self._asked)
            return INFINITE if worth is None else self._pay(self._call.prices.units(worth[0]))
        wait = self._epoch if at.phase == FOLLOWS else 0
        if epoch == self._horizon:
            return wait if at.phase == FOLLOWS and self._worth(at.state & self._asked) == _DONE else INFINITE
        return self._bound(at.state & self._matters) + wait

    def ways(self, at: Member, epoch: int, robots: BitOperator) -> Iterator[Way]:
        """What may happen in an epoch in which robots do so much by themselves."""
        moves = self._moves
        if at.phase == OVER:
            yield self._way(at, self._step(at.state & self._asked), robots)
            return
        if at.phase == FOLLOWS:
            planned = self._plan[epoch - 1] if epoch <= len(self._plan) else _WAITS
            if planned.applicable(at.state) and moves.fits(planned.label, robots.label):
                yield self._way(at, planned, robots)
            if epoch > len(self._plan):
                return
        for part in moves.human(at.state):
            if moves.fits(part.label, robots.label):
                yield from self._inside(at, part, robots, epoch)

    def _inside(self, at: Member, part: BitOperator, robots: BitOperator, epoch: int) -> Iterator[Way]:
        """Rules 2 and 3: the window ends with the epoch, or goes on."""
        way = self._way(at, part, robots)
        way = way._replace(paid=way.paid + self._epoch)
        worth = self._worth(way.after.state & self._asked)
        if worth is not None and worth[1] <= self._horizon - epoch:
            yield way._replace(after=way.after._replace(phase=OVER, epochs=0))
        epochs = 0 if self._most is None else at.epochs + 1
        if epoch < self._horizon and (self._most is None or epochs < self._most):
            yield way._replace(after=way.after._replace(phase=INSIDE, epochs=epochs))

    def _way(self, at: Member, part: BitOperator, robots: BitOperator) -> Way:
        state = at.state & ~(part.delete | robots.delete) | part.add | robots.add
        paid = part.weight + robots.weight
        return Way(self._moves.seen(part), paid, at._replace(state=state))

    def _worth_of(self, state: int) -> Worth | None:
        return self._call.plans.worth(_facts(state))

    def _step_of(self, state: int) -> BitOperator:
        """The next action of the canonical suffix."""
        step = next(self._call.plans.steps(_facts(state)), None)
        return _WAITS if step is None else self._moves.operators[step[0]]

    def _bound_of(self, state: int) -> int:
        left = self._left(_facts(state))
        return INFINITE if left is None else self._pay(left)


def _facts(state: int) -> State:
    return frozenset(bit.bit_length() - 1 for bit in each_bit(state))
