"""The human's optimal plans for each candidate goal that do, and don't, embed what was observed.

A plan embeds the observations iff they are a subsequence of its action names.  Matching each
observation as early as possible decides that, so a search over (state, number of observations
matched) is exact; a plan that does not embed them never matches the last one.
"""

import math
from collections.abc import Iterator, Sequence
from copy import copy
from dataclasses import dataclass
from fractions import Fraction
from typing import Final, NamedTuple

from search.call.context import SearchContext
from search.call.prepared_task import PreparedTask
from search.engine.astar import AStar
from search.human.plan_graph import cheapest_ways
from search.packed.cost_vector import INFINITE_KEY
from search.packed.operator_index import by_most_asked
from search.packed.operators import forms_of
from search.packed.packings import asked_facts
from search.packed.successor_generator import Lookup
from search.strategies.first_answer import canonical_human_plan
from serendipity.model.options import Options
from serendipity.model.resources.deadline import Deadline
from serendipity.model.task.actions import Condition
from serendipity.model.task.task import HumanPlan, Task

_EXACT: Final = 1 << 20
"""Logarithms are whole numbers of such parts in a search."""

_At = tuple[int, int]
"""A packed state, and how many observations have been matched."""


@dataclass(frozen=True, slots=True)
class Likelihood:
    """Costs of a human who wants one goal, with the observations and without them.

    Attributes:
        with_observed: ``cost(G, O)``: least cost of their plans that embed them; None if none does.
        without_observed: ``cost(G, not O)``: least cost of their other plans; None if there is none.
        plan: the canonical one among the (cost, length)-optimal plans that embed them.
    """

    with_observed: Fraction | None
    without_observed: Fraction | None
    plan: HumanPlan | None


class Reading(NamedTuple):
    """A plan for a goal, and how what was seen is read in it (semantics 8).

    Attributes:
        cost: of the plan.
        wrong: observations that are none of its actions.
        missed: its actions before the last one that was seen which were not.
        plan: action ids.
    """

    cost: Fraction
    wrong: int
    missed: int
    plan: HumanPlan


class Prices(NamedTuple):
    """What a reading weighs: the logarithm of how much less likely each makes it.

    Attributes:
        cost: a unit of the plan's cost (``beta``).
        wrong: an observation that is wrong.
        missed: an action that was missed.
    """

    cost: float
    wrong: float
    missed: float


class Explainer:
    """Explanations of observations by each of several goals; tables are kept from question to question.

    Args:
        prepared: the task; robots idle, its own goal plays no part.
        goals: the candidate goals.
    """

    def __init__(self, prepared: PreparedTask, goals: Sequence[Condition]) -> None:
        self._prepared = [prepared.with_goal(goal, Condition()) for goal in goals]
        self._last: list[tuple[tuple[str, ...], Likelihood] | None] = [None] * len(goals)

    def explain(
        self, observed: Sequence[str], deadline: Deadline | None = None, *, canonical: bool = True
    ) -> list[Likelihood]:
        """One explanation for each goal; those that were found before a limit came are not lost.

        Args:
            observed: names of actions, in the order in which the human did them.
            canonical: whether plans have to be the canonical ones; any others take less time.
        """
        deadline, names = deadline or Deadline(), tuple(observed)
        found = []
        for i, (prepared, last) in enumerate(zip(self._prepared, self._last, strict=True)):
            earlier = None if last is None or names[: len(last[0])] != last[0] else last[1]
            likelihood = _explanation(prepared, names, earlier, deadline, canonical=canonical)
            self._last[i] = names, likelihood
            found.append(likelihood)
        return found

    def from_here(
        self, observed: Sequence[str], state: frozenset[int], deadline: Deadline | None = None
    ) -> list[Likelihood]:
        """Bounds on the costs for each goal, by where all that was done has led (Masters and Sardina 2017).

        What was done and their best plan from there on cost ``cost(G, O)`` at least, and their optimum is at
        most ``cost(G, not O)``.  So no likelihood is above the exact one.
        """
        deadline, found = deadline or Deadline(), []
        for prepared in self._prepared:
            task = prepared.task
            spent = sum((task.actions[task.named[name][0]].cost for name in observed), Fraction(0))
            best, rest = (_optimum(one, deadline).with_observed for one in (prepared, prepared.at(state)))
            found.append(Likelihood(None if rest is None else spent + rest, best, None))
        return found

    def readings(
        self, observed: Sequence[str], prices: Prices, deadline: Deadline | None = None
    ) -> list[Reading | None]:
        """For each goal the likeliest of all plans and readings, as :func:`explain` otherwise."""
        deadline, names = deadline or Deadline(), tuple(observed)
        return [_ObservedSearch(one, names, deadline).reading(prices) for one in self._prepared]

    def at(self, state: frozenset[int]) -> "Explainer":
        """The same from another state."""
        moved = copy(self)
        moved._prepared = [one.at(state) for one in self._prepared]
        moved._last = [None] * len(moved._prepared)
        return moved


def _explanation(
    prepared: PreparedTask,
    observed: tuple[str, ...],
    earlier: Likelihood | None,
    deadline: Deadline,
    *,
    canonical: bool,
) -> Likelihood:
    """The explanation of observations, by the one before the last of them were made.

    Plans that embed all of them embed those before, so they cost no less, and as much where the canonical
    one goes on as observed.  Plans that don't embed all of them cost no more than those that don't embed
    those before, and as much where these are as cheap as any.
    """
    if not observed:
        return _optimum(prepared, deadline)
    goes_on = as_cheap = False
    known, other, plan = None, None, None
    if earlier is not None:
        known, other, plan = earlier.with_observed, earlier.without_observed, earlier.plan
        goes_on = known is None or _embeds(prepared.task, plan or (), observed)
        as_cheap = other is not None and (known is None or other <= known)
        if goes_on and as_cheap:
            return earlier
    search = _ObservedSearch(prepared, observed, deadline)
    if not goes_on:
        known, plan = search.embedding(canonical=canonical)
    return Likelihood(known, other if as_cheap else search.other(other), plan)


def _optimum(prepared: PreparedTask, deadline: Deadline) -> Likelihood:
    """Where nothing was observed the human's optimum, which their own searches know best."""
    plan = canonical_human_plan(prepared, deadline, Options())
    return Likelihood(None if plan is None else prepared.task.cost_of(plan), None, plan)


def _embeds(task: Task, plan: HumanPlan, observed: Sequence[str]) -> bool:
    """Whether a plan has the observations as a subsequence."""
    names = iter(task.actions[i].name for i in plan)
    return all(name in names for name in observed)


class _ObservedSearch:
    """A* over what matters to one goal and to the observations."""

    def __init__(self, prepared: PreparedTask, observed: tuple[str, ...], deadline: Deadline) -> None:
        task = prepared.task
        seen = {i for name in observed for i in task.named[name]} & set(task.human_actions)
        tables = prepared.plain(deadline)
        if not all(map(tables.packed.is_useful, seen)):  # what they ask for is packed otherwise
            tables = prepared.including(asked_facts(task, seen), deadline)
        context = SearchContext(prepared, Options(), deadline, tables=tables)
        packed = context.packed
        own = sorted({op.action for op in packed.own} | seen)
        forms = forms_of((packed.op(i) for i in own), packed.all_ones, deadline)
        self._lookup = Lookup(by_most_asked(forms, packed.fields, deadline), context.weights.alone)
        self._keys = context.keys
        self._names = {i: task.actions[i].name for i in own}
        self._goal = packed.goal
        self._task = task
        self._bound = context.bound
        self._observed = observed
        self._deadline = deadline
        self._start: _At = (packed.init, 0)

    def embedding(self, *, canonical: bool) -> tuple[Fraction | None, HumanPlan | None]:
        """``cost(G, O)``, and a plan that embeds the observations, the canonical one if that is asked for."""
        plan = self._canonical() if canonical else self._plan(self._first())
        return None if plan is None else self._task.cost_of(plan), plan

    def other(self, most: Fraction | None = None) -> Fraction | None:
        """``cost(G, not O)``, known to be at most so much; None: it may be anything."""
        limit = INFINITE_KEY if most is None else self._keys.of_cost(most)
        plan = self._plan(self._first(embed=False, limit=limit))
        return most if plan is None else self._task.cost_of(plan)

    def reading(self, prices: Prices) -> Reading | None:
        """The likeliest reading of the observations, where some may be wrong and actions may be missed."""
        unit = self._keys.of_cost(Fraction(1))
        wrong = None if math.isinf(prices.wrong) else round(prices.wrong * _EXACT) * unit
        missed = round(prices.missed * _EXACT) * unit
        found = self._first(rate=round(prices.cost * _EXACT), wrong=wrong, missed=missed)
        return None if found is None else self._read(*found)

    def _first(
        self,
        *,
        embed: bool = True,
        limit: int = INFINITE_KEY,
        rate: int = 1,
        wrong: int | None = None,
        missed: int = 0,
    ) -> tuple[_At, AStar[_At]] | None:
        """The end of a cheapest plan that embeds the observations (or not), and the search that found it.

        A step without action takes the next observation for wrong, or all that are left.  It is no use to
        leave one unread that an action fits: what fits it later is as good as missed.

        Args:
            limit: what it costs less than.
            rate: times the weights of the actions.
            wrong: price of an observation that is taken for wrong; None: none is.
            missed: price of an action before the last observation that was not observed.
        """
        all_seen = len(self._observed)

        def estimate(at: _At) -> int:
            bound = self._bound(at[0])
            return bound if bound >= INFINITE_KEY else bound * rate

        search = AStar(self._start, estimate, self._deadline, limit=limit, deep_first=True)
        for at, spent in search:
            state, seen = at
            if (seen == all_seen) == embed and self._goal.holds(state):
                return at, search
            if wrong is not None and seen < all_seen:
                search.reach((state, seen + 1), spent + wrong, at)
                search.reach((state, all_seen), spent + wrong * (all_seen - seen), at)
            for action, after, weight in self._steps(at):
                if embed or after[1] < all_seen:
                    price = missed if after[1] == seen < all_seen else 0
                    search.reach(after, spent + weight * rate + price, at, action)
        return None

    def _canonical(self) -> HumanPlan | None:
        """The canonical one of the cheapest plans that embed the observations (semantics 1)."""
        search = AStar(self._start, lambda at: self._bound(at[0]), self._deadline, limit=INFINITE_KEY)

        def is_end(at: _At) -> bool:
            return at[1] == len(self._observed) and self._goal.holds(at[0])

        ends, edges, _ = cheapest_ways(search, self._steps, is_end, self._deadline)
        if not ends:
            return None
        plan, at = [], self._start
        while at in edges:
            action, at = edges[at][0]
            plan.append(action)
        return tuple(plan)

    def _steps(self, at: _At) -> Iterator[tuple[int, _At, int]]:
        """What the human may do: the action, the place after it, its weight."""
        state, seen = at
        expected = self._observed[seen] if seen < len(self._observed) else None
        for option in self._lookup.options(state):
            action = option.actions[0]
            fits = self._names[action] == expected
            yield action, (state & option.keep | option.put, seen + fits), option.weight

    def _plan(self, found: tuple[_At, AStar[_At]] | None) -> HumanPlan | None:
        """The plan that a search has ended with."""
        return None if found is None else self._read(*found).plan

    def _read(self, at: _At, search: AStar[_At]) -> Reading:
        """The reading with which a search has come to a place."""
        plan, wrong, missed, seen, later = [], 0, 0, at[1], False
        for before, action in search.way_back(at):
            if action is None:
                wrong += seen - before[1]
            else:
                plan.append(action)
                missed, later = missed + (later and before[1] == seen), later or before[1] < seen
            seen = before[1]
        plan.reverse()
        return Reading(self._task.cost_of(tuple(plan)), wrong, missed, tuple(plan))
