"""What may happen in an epoch of one scenario: rules 1 to 3 of semantics 3.1, beside what robots do."""

from collections.abc import Callable, Iterator, Sequence
from functools import cache
from typing import Final, NamedTuple

from serendipity.model import HumanPlan
from verify.base.execution import executed, fits, is_last, met, sets_beside, unchosen
from verify.base.fact_bits import BitCondition, BitOperator, BitOperators, FactBits
from verify.base.relevance import relevant_part
from verify.base.subproblem import FREE
from verify.calls.call import ExaminedCall
from verify.exhaustive.without_epochs import LeastLeft
from verify.packed.bits import numbers_in
from verify.rules.leftovers import Prices
from verify.scenarios.measure import Measure
from verify.scenarios.suffixes import suffix_of

FOLLOWS, INSIDE, OVER = range(3)
"""Phases of a scenario: before its window, or without one; in it; after it."""

INFINITE: Final = 1 << 20_000
"""Of what can't be: more than anything costs."""

Seen = tuple[str, tuple[int, ...]] | None
"""What robots see the human do: an action by name and participants, in whichever variant; None: they wait."""


class PossibleScenario(NamedTuple):
    """A scenario that robots hold possible, as far as it has come.

    Attributes:
        scenario: its number.
        state: as bits.
        phase: of its window.
        epochs: of its window, where their number matters; else 0.
        rest: what the human does after the window, epoch by epoch.
        ahead: what it has paid more than that of its group which has paid least, where the greatest counts.
    """

    scenario: int
    state: int
    phase: int = FOLLOWS
    epochs: int = 0
    rest: HumanPlan = ()
    ahead: int = 0


class Way(NamedTuple):
    """What a scenario does in an epoch: what is seen of it, what it pays, and where it is then."""

    seen: Seen
    paid: int
    after: PossibleScenario


_WAITS: Final = BitOperator(0, 0, 0, 0, 0)


class JointMoves:
    """What everybody can do in a state, which does not depend on the scenario.

    Args:
        call: of any of the scenarios.
        pay: units of cost as the search counts them.
        original: by action of the task the one of the task that scenarios share; empty: they are the same.
    """

    def __init__(self, call: ExaminedCall, pay: Callable[[int], int], original: Sequence[int] = ()) -> None:
        self._task, self._call, self._original = call.task, call, original
        self.bits = FactBits(range(len(call.task.facts)))
        team, deadline = call.prices.team, call.effort.deadline
        actions = enumerate(deadline.each(call.task.actions))
        self._operators = [self.bits.operator(action, pay(team[i]), i) for i, action in actions]
        self._unchosen = unchosen(call.task)
        chosen = [op for op in self._operators if op.label not in self._unchosen]
        theirs = {i for i, a in enumerate(call.task.actions) if call.task.human not in a.participants}
        self._own = BitOperators((op for op in chosen if op.label in theirs), deadline)
        self._parts = BitOperators((op for op in chosen if op.label not in theirs), deadline)
        self._going_on = self.bits.of(call.task.due_for)
        self._nothing = self._as_one(()), self._as_one(())
        self.robots, self.human, self._fits = cache(self._robots), cache(self._human), cache(self._beside)
        self._due = cache(self._happening)

    def part(self, action: int | None) -> BitOperator:
        """What a plan has the human choose; nothing where they wait, or go on with what they have begun."""
        return _WAITS if action is None or action in self._unchosen else self._operators[action]

    def together(self, state: int, part: BitOperator, robots: BitOperator) -> tuple[int, int] | None:
        """What an epoch costs and the state after it, with all that is due; None if it is impossible."""
        due = self._due(state)
        if due is None:
            return None
        others, tick = due
        if part.label is not None and not self._fits(part.label, (*others.label, *robots.label)):
            return None
        kept = state & ~(part.delete | robots.delete | others.delete)
        after = tick.after(kept | part.add | robots.add | others.add)
        return part.weight + robots.weight + others.weight, after

    def _happening(self, state: int) -> tuple[BitOperator, BitOperator] | None:
        """What happens anyway (semantics 10), the clock's tick apart; None if that is impossible."""
        if not state & self._going_on:
            return self._nothing
        facts, actions = frozenset(numbers_in(state)), self._task.actions
        ids = met(self._task, facts, ())
        if executed(facts, [actions[i] for i in ids], strict=self._call.options.strict) is None:
            return None
        others, tick = (tuple(i for i in ids if is_last(actions[i]) is last) for last in (False, True))
        return self._as_one(others), self._as_one(tick)

    def _robots(self, state: int) -> dict[tuple[int, ...], BitOperator]:
        """All that robots can begin by themselves, by shared actions, labelled by the task's."""
        due = self._due(state)
        if due is None:
            return {}
        candidates = sorted(op.label for op in self._own.applicable(state))
        going_on, strict = due[0].label, self._call.options.strict
        sets = sets_beside(self._task, going_on, candidates, self._call.effort.deadline, strict=strict)
        begun = (chosen[len(going_on) :] for chosen in sets)
        return {self._shared(chosen): self._as_one(chosen) for chosen in begun}

    def _shared(self, chosen: tuple[int, ...]) -> tuple[int, ...]:
        return tuple(self._original[i] for i in chosen) if self._original else chosen

    def _as_one(self, chosen: tuple[int, ...]) -> BitOperator:
        add = delete = paid = 0
        for i in chosen:
            operator = self._operators[i]
            add, delete, paid = add | operator.add, delete | operator.delete, paid + operator.weight
        return BitOperator(0, 0, add, delete, paid, chosen)

    def _human(self, state: int) -> tuple[BitOperator, ...]:
        """All that the human can begin, joint actions included, waiting first."""
        return _WAITS, *self._parts.applicable(state)

    def _beside(self, part: int, others: tuple[int, ...]) -> bool:
        """Whether the human's part can share an epoch with what others do."""
        actions, strict = self._task.actions, self._call.options.strict
        return fits(actions[part], (actions[i] for i in others), strict=strict)

    def seen(self, part: BitOperator) -> Seen:
        """What robots see of the human's part."""
        if part.label is None:
            return None
        action = self._task.actions[part.label]
        return action.name, action.participants


class Course:
    """The epochs of one scenario, and what it pays for what is left changed."""

    def __init__(self, call: ExaminedCall, moves: JointMoves, measure: Measure, prices: Prices) -> None:
        self._moves, self._epoch = moves, measure.epoch
        pay = self._pay = measure.pay
        self._prices = [(1 << fact, true, measure.price(price)) for fact, (true, price) in prices.items()]
        self._plan = [moves.part(i) for i in call.human_plan or ()]
        self._horizon = int(call.horizon)
        self._most = call.options.max_window
        self._counts = self._most is not None or call.options.preservation == "state"
        of, task = moves.bits.of, call.task
        self._at_rest = of(task.at_rest)
        theirs = task.robot_goal
        self._goal = BitCondition(
            of((*task.goal.positive, *theirs.positive)) | self._at_rest,
            of((*task.goal.negative, *theirs.negative)),
        )
        question = call.question.but(rule=FREE)
        part = relevant_part(question)
        assert part is not None, "only goals that the human reaches are considered"
        left = LeastLeft(question, part)
        suffix, asked = suffix_of(task, call.options, call.human_plan or (), call.plans)
        self._asked, self._matters = of(asked), of(left.facts)
        self._suffix = cache(lambda state, *at: suffix(frozenset(numbers_in(state)), *at))
        self._rest = cache(lambda rest: pay(sum(call.prices.team[i] for i in rest)))
        self._bound = cache(lambda state: left(frozenset(numbers_in(state))))

    def least(self, at: PossibleScenario, epoch: int) -> int:
        """No less is left to pay after an epoch; after the last one exactly that."""
        left = self._left(at.state) if epoch == self._horizon else 0
        if at.phase == OVER:
            return self._rest(at.rest) + left
        wait = self._epoch if at.phase == FOLLOWS else 0
        if epoch == self._horizon:
            return wait + left if at.phase == FOLLOWS and self._goal.holds(at.state) else INFINITE
        rest = self._bound(at.state & self._matters)
        return INFINITE if rest is None else self._pay(rest) + wait

    def _left(self, state: int) -> int:
        """The price of what a last state leaves changed."""
        return sum(price for bit, true, price in self._prices if bool(state & bit) is not true)

    def ways(self, at: PossibleScenario, epoch: int, robots: BitOperator) -> Iterator[Way]:
        """What may happen in an epoch in which robots do so much by themselves."""
        moves = self._moves
        if at.phase == OVER:
            following = moves.part(at.rest[0] if at.rest else None)
            yield from self._ways(at._replace(rest=at.rest[1:]), following, robots)
            return
        if at.phase == FOLLOWS:
            planned = self._plan[epoch - 1] if epoch <= len(self._plan) else moves.part(None)
            if planned.applicable(at.state):
                yield from self._ways(at, planned, robots)
            if epoch > len(self._plan):
                return
        for part in moves.human(at.state):
            for way in self._ways(at, part, robots):
                yield from self._inside(way, epoch)

    def _inside(self, way: Way, epoch: int) -> Iterator[Way]:
        """Rules 2 and 3: the window ends with the epoch, robots at rest, or goes on."""
        paid, at = way.paid + self._epoch, way.after
        epochs = at.epochs + 1 if self._counts else 0
        start = epoch + 1 - epochs if self._counts else 1
        if at.state & self._at_rest == self._at_rest:
            rest = self._suffix(at.state & self._asked, start, self._horizon - epoch)
            if rest is not None:
                yield Way(way.seen, paid, PossibleScenario(at.scenario, at.state, OVER, 0, rest, at.ahead))
        if epoch < self._horizon and (self._most is None or epochs < self._most):
            yield Way(way.seen, paid, PossibleScenario(at.scenario, at.state, INSIDE, epochs, (), at.ahead))

    def _ways(self, at: PossibleScenario, part: BitOperator, robots: BitOperator) -> Iterator[Way]:
        together = self._moves.together(at.state, part, robots)
        if together is not None:
            after = PossibleScenario(at.scenario, together[1], at.phase, at.epochs, at.rest, at.ahead)
            yield Way(self._moves.seen(part), together[0], after)
