"""The price of what help leaves changed in each of several scenarios (semantics 11, 12).

In the mean prices add up.  Where the greatest cost or regret counts, they matter only where it is; there each
scenario begins with what it has to pay for in any case.
"""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from fractions import Fraction
from functools import partial
from typing import Final, NamedTuple

from search.modes.scenarios import Candidate, solve_scenarios
from serendipity.facade.call import Request
from serendipity.facade.kept import Kept, Literal, happening_costs, left_by
from serendipity.facade.leftovers import LeftoverPrices, paying, priced
from serendipity.model import Deadline, Options, Task
from serendipity.model.answers.answer import Answer, ServedGoal

Literals = frozenset[tuple[int, Literal]]
"""Priced literals, each of the scenario of a number."""


Figures = tuple[Fraction, Fraction]
"""Objective and cost."""

_NOTHING: Final = Fraction(0)

_FREE: Final[Figures] = (_NOTHING, _NOTHING)

_SHARE: Final = 0.5
"""The share of the time for what regret compares with."""


class PricedScenarios(NamedTuple):
    """Scenarios of a call, and what help has to keep in each.

    Attributes:
        last: ``T``.
    """

    task: Task
    options: Options
    candidates: Sequence[Candidate]
    rules: Sequence[Kept]
    last: int


class OverScenarios:
    """A call over scenarios whose answers pay for what they leave; ``idle`` is the answer of idle robots."""

    adds_up = True

    def __init__(self, asked: PricedScenarios, idle: Answer) -> None:
        self._task, self._options, candidates, self._rules, self._last = asked
        self._shares, self._idle = [one.weight for one in candidates], idle
        self._prices = [LeftoverPrices(self._task, rule) for rule in self._rules]

    def least(self, kept: Literals, paid: Literals) -> Fraction:
        """See :class:`.Question`."""
        each = enumerate(zip(self._shares, self._prices, strict=True))
        found = (share * prices.least(_of(k, kept), _of(k, paid)) for k, (share, prices) in each)
        return sum(found, Fraction(0))

    def open(self, found: Answer, kept: Literals, paid: Literals) -> list[tuple[int, Literal]]:
        """See :class:`.Question`."""
        return [
            (k, literal)
            for k, (goal, prices) in enumerate(zip(found.goals or (), self._prices, strict=True))
            for literal in prices.open(self._left(k, goal), _of(k, kept), _of(k, paid))
        ]

    def with_price(self, answer: Answer) -> Answer:
        """See :class:`.Question`; what is left counts by how likely that is."""
        goals, listed = [], dict[int, Fraction]()
        for k, goal in enumerate(answer.goals or ()):
            found = self._left(k, goal)
            price = sum((price for _, price in found), Fraction(0))
            goals.append(replace(goal, cost=(goal.cost or Fraction(0)) + price))
            for (fact, _), price in found:
                listed[fact] = listed.get(fact, Fraction(0)) + price * self._shares[k]
        return paying(answer._replace(goals=tuple(goals)), listed.items())

    def total(self, answer: Answer) -> Fraction:
        """See :class:`.Question`; idle robots leave the human alone, which counts as an epoch of window."""
        least = answer.objective or Fraction(0)
        if answer.opportunity:
            return least
        return least - (answer.saving_alone or Fraction(0)) + self._options.window_weight

    def settled(self, answer: Answer) -> Answer:
        """See :class:`.Question`."""
        least = (answer.baseline or Fraction(0)) - (answer.saving_alone or 0)
        if answer.cost is not None and answer.cost >= least:
            idle = self._idle
            answer = answer._replace(
                steps=idle.steps, goals=idle.goals, cost=idle.cost, objective=idle.objective, left=()
            )
            answer = answer._replace(opportunity=False, saving=Fraction(0))
        return answer._replace(status="optimal", lower_bound=answer.objective)

    def _left(self, k: int, goal: ServedGoal) -> list[tuple[Literal, Fraction]]:
        return left_by(self._task, self._rules[k], goal.steps or (), self._last)


class AtWorst(OverScenarios):
    """The same where the greatest counts.

    Args:
        solve: answers about these scenarios with what each has to keep and begins with.
        floors: what each scenario's costs are compared with.
    """

    adds_up = False

    def __init__(
        self,
        asked: PricedScenarios,
        idle: Answer,
        solve: Callable[[Literals, Sequence[Figures]], Iterator[Answer]],
        floors: Sequence[Figures],
    ) -> None:
        super().__init__(asked, idle)
        self._solve, self._floors = solve, floors
        self._is_asked_by_itself = False
        self._most = tuple(max(floor[i] for floor in floors) for i in (0, 1))
        plans = (self._task.cost_of(one.plan) for one in asked.candidates)
        self._alone = self._worth([(cost + self._options.window_weight, cost) for cost in plans])[1]
        self._idle = idle._replace(cost=self._alone, objective=self._alone)

    def keep(self, kept: Literals, paid: Literals) -> Iterator[Answer]:
        """Answers whose figures count what is paid for in any case."""
        ahead = []
        for k, (prices, floor) in enumerate(zip(self._prices, self._floors, strict=True)):
            least = prices.least(_of(k, kept), _of(k, paid))
            ahead.append((least + self._most[0] - floor[0], least + self._most[1] - floor[1]))
        for found in self._solve(kept, ahead):
            objective, cost = found.objective or _NOTHING, found.cost or _NOTHING
            if (found.lower_bound or _NOTHING) < objective:  # of one scenario, whose limit nobody told
                found = found._replace(status="feasible")
            yield found._replace(objective=objective - self._most[0], cost=cost - self._most[1])

    def least(self, kept: Literals, paid: Literals) -> Fraction:
        """Nothing besides, see :meth:`keep`."""
        return _NOTHING

    def open(self, found: Answer, kept: Literals, paid: Literals) -> list[tuple[int, Literal]]:
        """See :class:`.Question`; none where what is left makes nothing worse."""
        priced = self.with_price(found)
        same = (priced.objective, priced.cost) == (found.objective, found.cost)
        return [] if same else super().open(found, kept, paid)

    def with_price(self, answer: Answer) -> Answer:
        """See :class:`.Question`."""
        told, window = super().with_price(answer), self._options.window_weight
        each = []
        for k, one in enumerate(told.goals or ()):
            price = sum((price for _, price in self._left(k, one)), _NOTHING)
            cost = happening_costs(self._task, one.steps or (), self._last, self._options.discount) + price
            each.append((cost + window * (1 if one.window is None else len(one.window)), cost))
        objective, cost = self._worth(each)
        saving = self._alone - cost
        return told._replace(
            objective=objective, cost=cost, baseline=self._alone, saving=saving, opportunity=True
        )

    def total(self, answer: Answer) -> Fraction:
        """See :class:`.Question`."""
        return answer.objective or _NOTHING

    def floor(self) -> tuple[Figures, bool]:
        """The least of it, whether that helps or not, and whether it is proved."""
        self._is_asked_by_itself = True
        *_, found = priced(self._options, self, self.keep)
        if found.status != "optimal":
            return (found.lower_bound or _NOTHING, _NOTHING), False
        return (found.objective or _NOTHING, found.cost or _NOTHING), True

    def settled(self, answer: Answer) -> Answer:
        """See :class:`.Question`."""
        found = answer._replace(status="optimal", lower_bound=answer.objective)
        return found if self._is_asked_by_itself else super().settled(answer)

    def _worth(self, each: Sequence[Figures]) -> Figures:
        pairs = zip(each, self._floors, strict=True)
        return max((a - floor, b - least) for (a, b), (floor, least) in pairs)


def at_worst(
    call: Request,
    candidates: Sequence[Candidate],
    rules: Sequence[Kept],
    last: int,
    keeping: Callable[[Literals], Sequence[Candidate]],
) -> Iterator[Answer]:
    """Answers that pay for what they leave, by the greatest cost or regret.

    Args:
        last: ``T``.
        keeping: the scenarios, with some literals that each has to keep.
    """
    options, every = call.options.but(risk="worst", horizon=last), range(len(candidates))

    def solved(
        numbers: Sequence[int], deadline: Deadline, kept: Literals, ahead: Sequence[Figures]
    ) -> Iterator[Answer]:
        given = keeping(frozenset((numbers[k], literal) for k, literal in kept))
        begun = [replace(given[k], ahead=pair) for k, pair in zip(numbers, ahead, strict=True)]
        return solve_scenarios(call.prepared, options, begun, deadline)

    def asked(numbers: Sequence[int], deadline: Deadline, floors: Sequence[Figures]) -> AtWorst:
        own = [candidates[k] for k in numbers]
        idle = next(solve_scenarios(call.prepared, options, own, deadline))
        solve = partial(solved, numbers, deadline)
        scenarios = PricedScenarios(call.task, options, own, [rules[k] for k in numbers], last)
        return AtWorst(scenarios, idle, solve, floors)

    floors, proved = [_FREE] * len(candidates), True
    for k in every if call.options.risk == "regret" else ():
        deadline = call.deadline.part(_SHARE / len(candidates))
        floors[k], known = asked([k], deadline, [_FREE]).floor()
        proved = proved and known
    question = asked(every, call.deadline, floors)
    for answer in priced(options, question, question.keep):
        yield answer if proved else answer._replace(status="feasible", lower_bound=_NOTHING)


def _of(number: int, literals: Literals) -> frozenset[Literal]:
    return frozenset(literal for k, literal in literals if k == number)
