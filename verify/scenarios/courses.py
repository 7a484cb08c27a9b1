"""What may happen in an epoch of one scenario: rules 1 to 3 of semantics 3.1, beside what robots do."""

from collections.abc import Callable, Iterator
from functools import cache
from typing import Final, NamedTuple

from verify.base.execution import State, fits, sets_beside
from verify.base.fact_bits import BitCondition, BitOperator, BitOperators, FactBits, each_bit
from verify.base.relevance import relevant_part
from verify.base.subproblem import FREE
from verify.calls.call import ExaminedCall
from verify.exhaustive.without_epochs import LeastLeft
from verify.scenarios.suffixes import suffix_of

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
        epochs: of its window, where their number matters, and after it the index of its suffix; else 0.
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
        self._counts = self._most is not None or call.options.preservation == "state"
        goal, of = call.task.goal, moves.bits.of
        self._goal = BitCondition(of(goal.positive), of(goal.negative))
        question = call.question.but(rule=FREE)
        part = relevant_part(question)
        assert part is not None, "only goals that the human reaches are considered"
        left, suffix = (
            LeastLeft(question, part),
            suffix_of(call.task, call.options, call.human_plan or (), call.plans),
        )
        self._asked, self._matters = of(suffix.facts), of(left.facts)
        self._begin = cache(lambda state, *at: suffix.begin(_facts(state), *at))
        self._step = cache(lambda state, *at: suffix.step(_facts(state), *at))
        self._rest = cache(lambda state, *at: call.prices.units(suffix.cost(_facts(state), *at)))
        self._bound = cache(lambda state: left(_facts(state)))

    def least(self, at: Member, epoch: int) -> int:
        """No less is left to pay after an epoch; after the last one exactly that."""
        if at.phase == OVER:
            return self._pay(self._rest(at.state & self._asked, at.epochs, self._horizon - epoch))
        wait = self._epoch if at.phase == FOLLOWS else 0
        if epoch == self._horizon:
            return wait if at.phase == FOLLOWS and self._goal.holds(at.state) else INFINITE
        left = self._bound(at.state & self._matters)
        return INFINITE if left is None else self._pay(left) + wait

    def ways(self, at: Member, epoch: int, robots: BitOperator) -> Iterator[Way]:
        """What may happen in an epoch in which robots do so much by themselves."""
        moves = self._moves
        if at.phase == OVER:
            step, index = self._step(at.state & self._asked, at.epochs, self._horizon - epoch + 1)
            part = _WAITS if step is None else moves.operators[step]
            yield self._way(at._replace(epochs=index), part, robots)
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
        seen, spent, after = self._way(at, part, robots)
        paid, state = spent + self._epoch, after.state
        epochs = at.epochs + 1 if self._counts else 0
        start = epoch + 1 - epochs if self._counts else 1
        index = self._begin(state & self._asked, start, self._horizon - epoch)
        if index is not None:
            yield Way(seen, paid, Member(at.scenario, state, OVER, index, at.ahead))
        if epoch < self._horizon and (self._most is None or epochs < self._most):
            yield Way(seen, paid, Member(at.scenario, state, INSIDE, epochs, at.ahead))

    def _way(self, at: Member, part: BitOperator, robots: BitOperator) -> Way:
        state = at.state & ~(part.delete | robots.delete) | part.add | robots.add
        after = Member(at.scenario, state, at.phase, at.epochs, at.ahead)
        return Way(self._moves.seen(part), part.weight + robots.weight, after)


def _facts(state: int) -> State:
    return frozenset(bit.bit_length() - 1 for bit in each_bit(state))
