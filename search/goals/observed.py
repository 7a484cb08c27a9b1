"""The human's optimal plans for each candidate goal that do, and don't, embed what was observed.

A plan embeds the observations iff they are a subsequence of its action names.  Matching each
observation as early as possible decides that, so a search over (state, number of observations
matched) is exact; a plan that does not embed them never matches the last one.
"""

from collections.abc import Sequence
from copy import copy
from dataclasses import dataclass
from fractions import Fraction

from search.algorithms.astar import AStar
from search.context import SearchContext
from search.packed.cost_vector import INFINITE_KEY
from search.packed.operator_index import by_most_asked
from search.packed.operators import forms_of
from search.packed.successor_generator import Lookup
from search.prepared_task import PreparedTask
from serendipity.model.options import Options
from serendipity.model.resources.deadline import Deadline
from serendipity.model.task.actions import Condition
from serendipity.model.task.task import HumanPlan, Task

_At = tuple[int, int]
"""A packed state, and how many observations have been matched."""


@dataclass(frozen=True, slots=True)
class Likelihood:
    """What the observations cost a human who wants one goal.

    Attributes:
        with_observed: ``cost(G, O)``: least cost of their plans that embed them; None if none does.
        without_observed: ``cost(G, not O)``: least cost of their other plans; None if there is none.
        plan: the canonical one among the (cost, length)-optimal plans that embed them.
    """

    with_observed: Fraction | None
    without_observed: Fraction | None
    plan: HumanPlan | None


class Explainer:
    """What explains observations, for each of several goals; tables are kept from question to question.

    Args:
        task: the task; robots idle, its own goal plays no part.
        goals: the candidate goals.
    """

    def __init__(self, task: Task, goals: Sequence[Condition]) -> None:
        nothing = Condition()
        self._prepared = [PreparedTask(task.with_goal(goal, nothing)) for goal in goals]

    def explain(self, observed: Sequence[str], deadline: Deadline | None = None) -> list[Likelihood]:
        """One explanation for each goal.

        Args:
            observed: names of actions, in the order in which the human did them.
            deadline: deadline and cancellation.
        """
        deadline = deadline or Deadline()
        return [_Search(one, tuple(observed), deadline).explanation() for one in self._prepared]

    def at(self, state: frozenset[int]) -> "Explainer":
        """The same from another state."""
        moved = copy(self)
        moved._prepared = [one.at(state) for one in self._prepared]
        return moved


def explanations(
    task: Task, goals: Sequence[Condition], observed: Sequence[str], deadline: Deadline | None = None
) -> list[Likelihood]:
    """One explanation for each goal; see :class:`Explainer`."""
    return Explainer(task, goals).explain(observed, deadline)


class _Search:
    """A* over what matters to one goal and to the observations."""

    def __init__(self, prepared: PreparedTask, observed: tuple[str, ...], deadline: Deadline) -> None:
        task = prepared.task
        seen = {i for name in observed for i in task.named[name]} & set(task.human_actions)
        asked = {f for i in seen for f in (*task.actions[i].pre, *task.actions[i].neg)}
        tables = prepared.plain(deadline)
        if not all(map(tables.packed.is_useful, seen)):  # what they ask for is packed otherwise
            tables = prepared.including(frozenset(asked), deadline)
        context = SearchContext(prepared, Options(), deadline, tables=tables)
        packed = context.packed
        own = sorted({op.action for op in packed.own} | seen)
        forms = forms_of((packed.op(i) for i in own), packed.all_ones, deadline)
        self._lookup = Lookup(by_most_asked(forms, packed.fields, deadline), context.weights.alone)
        self._keys = context.keys
        self._names = {i: task.actions[i].name for i in own}
        self._goal = packed.goal
        self._bound = context.bound
        self._observed = observed
        self._deadline = deadline
        self._start: _At = (packed.init, 0)

    def explanation(self) -> Likelihood:
        """Both costs, and the canonical plan that embeds the observations."""
        embedding, plan = self._best(embed=True)
        other, _ = self._best(embed=False)
        return Likelihood(
            None if plan is None else self._keys.cost(embedding),
            None if other == INFINITE_KEY else self._keys.cost(other),
            plan,
        )

    def _best(self, *, embed: bool) -> tuple[int, HumanPlan | None]:
        """The least key of a plan that embeds the observations (or does not), and the canonical one.

        Every place whose bound does not exceed the optimum is expanded, so that all optimal
        plans are among the steps recorded.
        """
        all_seen = len(self._observed)
        if not embed and not all_seen:
            return INFINITE_KEY, None
        search = AStar(self._start, self._missing, self._deadline, limit=INFINITE_KEY)
        into: dict[_At, list[tuple[int, _At, int]]] = {}
        ends = []
        for at, key in search:
            if (at[1] == all_seen) == embed and self._goal.holds(at[0]):
                search.limit = min(search.limit, key + 1)
                ends.append(at)
            for option in self._lookup.options(at[0]):
                after = (at[0] & option.keep | option.put, self._matched(at[1], option.actions[0]))
                if not embed and after[1] == all_seen:
                    continue
                reached = key + option.weight
                into.setdefault(after, []).append((option.actions[0], at, reached))
                search.reach(after, reached)
        if not ends:
            return INFINITE_KEY, None
        optimum = search.limit - 1
        best = [at for at in ends if search.spent[at] == optimum]
        return optimum, self._canonical(best, into, search.spent)

    def _missing(self, at: _At) -> int:
        """Lower bound of the key that is missing, whatever has been observed."""
        return self._bound(at[0])

    def _matched(self, count: int, action: int) -> int:
        expected = self._observed[count] if count < len(self._observed) else None
        return count + (self._names[action] == expected)

    def _canonical(
        self,
        ends: list[_At],
        into: dict[_At, list[tuple[int, _At, int]]],
        distance: dict[_At, int],
    ) -> HumanPlan:
        """The canonical plan: at each step the smallest action of an optimal plan (semantics 1)."""
        onward: dict[_At, list[tuple[int, _At]]] = {}
        pending, seen = list(ends), set(ends)
        while pending:
            self._deadline.tick()
            after = pending.pop()
            for action, at, reached in into.get(after, ()):
                if reached != distance[after]:
                    continue
                onward.setdefault(at, []).append((action, after))
                if at not in seen:
                    seen.add(at)
                    pending.append(at)
        plan, at = [], self._start
        while at in onward:
            action, at = min(onward[at])
            plan.append(action)
        return tuple(plan)
