"""How often each operator occurs in a plan, whatever the order: an integer program without epochs.

Operator counting (Pommerening, Röger, Helmert and Bonet 2014).  Two kinds of rows hold for every plan:

- balance: a field of exclusive facts takes a value as often as it gives it up, but for what is true at first
  and in the end.  So operators that may set a value occur at least as often as those that give it up, and
  once more where the goal asks for the value and it is not there at first;
- landmarks: a set of operators without which the goal is out of reach, even if nothing is ever deleted.  One
  of them occurs.  They are found one after the other, for operators that have satisfied all rows so far.

If the least weight of such numbers is no less than what is asked about, there is no plan for less.  Numbers
that satisfy all rows need not be a plan: then nothing is known but a bound.
"""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np

from serendipity.model import Deadline
from verify.packed.operators import OperatorTable
from verify.programs.effort import Effort
from verify.solvers.mip import Model

_AT_ONCE: Final = 30
"""Landmarks of a round at most."""


@dataclass(frozen=True, slots=True)
class CountsBound:
    """What numbers of operators say of plans.

    Attributes:
        least: no plan weighs less.
        landmarks: how many rows there were of them.
    """

    least: int
    landmarks: int


def least_weight(
    table: OperatorTable, start: frozenset[int], goal: Sequence[int], below: int, effort: Effort
) -> CountsBound:
    """A lower bound on the weight of all plans, as far as it is of use: up to a weight, and in time.

    Args:
        table: the operators, each with a weight above 0.
        start: facts that are true at first.
        goal: facts that have to be true in the end.
        below: a bound of this much is enough.
        effort: the solver and the deadline; its calls are noted there.

    Raises:
        LimitReachedError: the deadline came first.
    """
    deadline = effort.deadline
    landmarks = MissedLandmarks(table, start, goal, deadline)
    model = _balanced(table, start, goal, below, deadline)
    counts: Sequence[int] = [0] * len(table.operators)
    least = found = 0
    while least < below and (missed := landmarks.missed(counts)):
        for operators in missed:
            model.add(dict.fromkeys(operators, 1), ">=", 1)
        found += len(missed)
        outcome = effort.solve(model)
        if outcome.status == "infeasible":
            return CountsBound(below, found)
        if outcome.bound is not None:
            least = max(least, -int(-(outcome.bound - 1e-6) // 1))
        if outcome.status != "optimal" or outcome.values is None:
            deadline.check()
            break
        counts = outcome.values
    return CountsBound(min(least, below), found)


def _balanced(
    table: OperatorTable, start: frozenset[int], goal: Sequence[int], below: int, deadline: Deadline
) -> Model:
    """The program without landmarks; no operator occurs so often that it alone weighs too much."""
    model = Model(deadline)
    for number, operator in enumerate(table.operators):
        most = 0 if table.impossible[number] else max(0, below - 1) // operator.weight
        model.objective[model.column(0, most)] = operator.weight
    model.add(dict(model.objective), "<=", below - 1)
    rows: dict[tuple[int, int], dict[int, int]] = {}
    for number in deadline.each(range(len(table.operators))):
        conditions, effects = table.conditions[number], table.effects[number]
        for field, value in effects.items():
            rows.setdefault((field, value), {})[number] = 1
            if field in conditions:
                rows.setdefault((field, conditions[field]), {})[number] = -1
    asked = [table.layout.place[fact] for fact in goal if fact in table.layout.place]
    for at in asked:
        rows.setdefault((at.field, at.value), {})
    wanted = {(at.field, at.value) for at in asked}
    for (field, value), terms in deadline.each(rows.items()):
        there = _value(table.layout.fields[field].facts, start) == value
        model.add(terms, ">=", int((field, value) in wanted) - int(there))
    return model


def _value(facts: Sequence[int], state: frozenset[int]) -> int:
    """What a field of some facts is in a state."""
    return next((value for value, fact in enumerate(facts, start=1) if fact in state), 0)


class MissedLandmarks:
    """Sets of operators of which every plan has one, if nothing is ever deleted.

    Args:
        table: the operators.
        start: facts that are true at first.
        goal: facts that have to be true in the end.
        deadline: polled.
    """

    def __init__(
        self, table: OperatorTable, start: Iterable[int], goal: Iterable[int], deadline: Deadline
    ) -> None:
        known = table.layout.place
        possible = [number for number in range(len(table.operators)) if not table.impossible[number]]
        self._deadline = deadline
        self._start = frozenset(fact for fact in start if fact in known)
        self._goal = frozenset(fact for fact in goal if fact in known)
        self._size = len(table.operators)
        self._needs = [frozenset(f for f in each.pre if f in known) for each in table.operators]
        self._adds = [tuple(f for f in each.add if f in known) for each in table.operators]
        self._needing: dict[int, list[int]] = {}
        for number in possible:
            for fact in self._needs[number]:
                self._needing.setdefault(fact, []).append(number)
        self._order = np.random.default_rng(0).permutation(np.array(possible, np.int64)).tolist()

    def missed(self, counts: Sequence[int]) -> list[list[int]]:
        """Landmarks without any operator that occurs, each of others; none where the goal is in reach.

        Args:
            counts: how often each operator occurs.
        """
        allowed = [count > 0 for count in counts]
        found: list[list[int]] = []
        while len(found) < _AT_ONCE:
            reached = _Reached(self._start, [len(need) for need in self._needs], allowed.copy())
            self._spread(reached, self._start)
            for number in self._order:
                if allowed[number] and not reached.missing[number]:
                    self._add(reached, number)
            if self._goal <= reached.true:
                break
            landmark = self._others(reached)
            found.append(landmark)
            if not landmark:
                break
            for number in landmark:
                allowed[number] = True
        return found

    def _others(self, reached: "_Reached") -> list[int]:
        """The operators that are left when as many as can be are allowed, short of reaching the goal."""
        left: list[int] = []
        enough: set[int] = set()  # facts of which each alone would bring the goal into reach
        for number in self._order:
            if reached.allowed[number]:
                continue
            self._deadline.tick()
            new = frozenset(self._adds[number]) - reached.true
            if reached.missing[number] or not new:
                reached.allowed[number] = True
                continue
            if not new.isdisjoint(enough):
                left.append(number)
                continue
            trial = _Reached(reached.true, reached.missing.copy(), reached.allowed)
            trial.allowed[number] = True
            self._add(trial, number)
            if self._goal <= trial.true:
                reached.allowed[number] = False
                left.append(number)
                if len(new) == 1:
                    enough |= new
            else:
                reached.true, reached.missing = trial.true, trial.missing
        return left

    def _add(self, reached: "_Reached", number: int) -> None:
        """An operator is executed, and all that can be then."""
        new = frozenset(self._adds[number]) - reached.true
        reached.true |= new
        self._spread(reached, new)

    def _spread(self, reached: "_Reached", facts: Iterable[int]) -> None:
        """Facts have become true."""
        pending = list(facts)
        while pending:
            for number in self._needing.get(pending.pop(), ()):
                reached.missing[number] -= 1
                if not reached.missing[number] and reached.allowed[number]:
                    new = [fact for fact in self._adds[number] if fact not in reached.true]
                    reached.true |= frozenset(new)
                    pending += new


@dataclass(slots=True)
class _Reached:
    """What is in reach of some operators.

    Attributes:
        true: the facts.
        missing: of each operator, how many of its needs are not.
        allowed: which operators may be executed.
    """

    true: frozenset[int]
    missing: list[int]
    allowed: list[bool]


__all__ = ["CountsBound", "MissedLandmarks", "least_weight"]
