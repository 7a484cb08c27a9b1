"""Composite plans without a horizon: uniform-cost search over joint states, with an estimate.

Without a horizon an epoch costs nothing, so that an action set can be taken apart and its
actions executed one after the other, those first that others of the set would disable.
Only sets in which actions disable each other in a circle have to stay together.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import chain
from typing import Final

from serendipity.model import Deadline, GroundAction, LimitReachedError, Step, Task
from serendipity.model.errors import LIMITS, limit_reason
from verify.base.execution import State, fits
from verify.base.fact_bits import FactBits, each_bit
from verify.base.relevance import Relevant, relevant_part
from verify.base.shortest_paths import PathSearch
from verify.base.subproblem import Solution, Subproblem
from verify.base.undecided import during
from verify.programs.automata.network import FAR, distances, goal_states
from verify.programs.automata.product import automata
from verify.programs.effort import Minimum

MOST_STATES: Final = 500_000


@dataclass(frozen=True, slots=True)
class Bundle:
    """Actions that are executed together, and what they need and do, as bits."""

    actions: tuple[int, ...]
    pre: int
    neg: int
    add: int
    delete: int
    cost: int


def cheapest(question: Subproblem) -> Minimum:
    """The least cost of a plan with any number of epochs, within the question's limits.

    Args:
        question: its horizon is not looked at; its rule is ``free``.

    Raises:
        LimitReachedError: the deadline came before the search began.
    """
    with during("preparing the search for joint plans"):
        part = relevant_part(question)
        if part is None:
            return Minimum("none")
        search = JointSearch(question, part)
    return search.run()


class LeastLeft:
    """A lower bound on what is left to pay, in units: distances in the human's automaton.

    Robots' costs are only left out, so it holds whatever they do.

    Attributes:
        facts: of the automaton.
        by_state: the distances.
    """

    def __init__(self, question: Subproblem, part: Relevant) -> None:
        deadline = question.deadline
        groups = [frozenset(variable.facts) for variable in question.task.variables]
        machine = automata(question.task, part, groups, deadline)[question.task.human]
        weights = list(question.prices.team)
        left = distances(machine, weights, goal_states(question, machine), deadline)[0]
        self.facts = machine.facts
        self.by_state = dict(zip(machine.states, left, strict=True))

    def __call__(self, state: State) -> int:
        """The bound in a state."""
        return self.by_state.get(state & self.facts, 0)


class JointSearch:
    """Uniform-cost search of one question; what a timetable changes can be overridden."""

    def __init__(self, question: Subproblem, part: Relevant) -> None:
        self.question = question
        self.task = question.task
        self.deadline = question.deadline
        self.part = part
        self.bits = FactBits(part.facts)
        self.table: dict[int, list[Bundle]] = {}
        for bundle in self.deadline.each(self._bundles(part)):
            self.table.setdefault(bundle.pre & -bundle.pre, []).append(bundle)
        conditions = [self.task.goal, *([self.task.robot_goal] if question.robots_goal else [])]
        self.wanted = self.bits.of(f for c in conditions for f in c.positive)
        self.unwanted = self.bits.of(f for c in conditions for f in c.negative)
        left = LeastLeft(question, part)
        self._human = self.bits.of(left.facts)
        self._left = {self.bits.of(state): least for state, least in left.by_state.items()}
        self.closed = 0
        self.bound: int | None = None

    def run(self) -> Minimum:
        """The cheapest plan within the question's limits."""
        try:
            return self._search()
        except LIMITS as limit:
            doing = f"searching joint plans, {self.closed:,} states so far"
            return Minimum(
                "undecided", bound=self.bound, reason=str(LimitReachedError(limit_reason(limit), doing))
            )

    def _search(self) -> Minimum:
        search = PathSearch(self.start, self._successors, self.estimate, self.deadline, self._most() + 1)
        for state, self.bound in search:
            self.closed += 1
            if self.is_goal(state):
                return self._found(search.path(state), search.distance[state])
            if self.closed > MOST_STATES:
                return Minimum("undecided", bound=self.bound, reason=f"more than {MOST_STATES} joint states")
        return Minimum("none")

    def _successors(self, state: int) -> Iterator[tuple[int, int, Bundle]]:
        for bundle in self.applicable(state):
            yield state & ~bundle.delete | bundle.add, bundle.cost, bundle

    @property
    def start(self) -> int:
        """The initial state."""
        return self.bits.of(self.task.init)

    def is_goal(self, state: int) -> bool:
        """Whether the goals hold."""
        return state & self.wanted == self.wanted and not state & self.unwanted

    def _most(self) -> int:
        limits = [limit for limit in (self.question.most, self.question.most_cost) if limit is not None]
        return min(limits, default=FAR - 1)

    def _found(self, bundles: list[Bundle], cost: int) -> Minimum:
        epochs = enumerate(bundles, start=1)
        steps = tuple(Step(epoch, i) for epoch, bundle in epochs for i in bundle.actions)
        return Minimum("found", Solution(steps, None, cost, cost), cost)

    def applicable(self, state: int) -> Iterator[Bundle]:
        """What can be done next."""
        for bit in chain((0,), each_bit(state)):
            for bundle in self.table.get(bit, ()):
                if state & bundle.pre == bundle.pre and not state & bundle.neg:
                    yield bundle

    def estimate(self, state: int) -> int:
        """A lower bound on the cost that is left."""
        return self._left.get(state & self._human, 0)

    def _bundles(self, part: Relevant) -> Iterator[Bundle]:
        for i in part.actions:
            yield self.bundle((i,))
        if not self.question.options.strict:
            actions = [(i, self.task.actions[i]) for i in self.deadline.each(part.actions)]
            for circle in circles(actions, self.task, self.deadline):
                yield self.bundle(circle)

    def bundle(self, ids: tuple[int, ...]) -> Bundle:
        """The actions as one."""
        chosen = [self.task.actions[i] for i in ids]
        return Bundle(
            ids,
            self.bits.of(f for action in chosen for f in action.pre),
            self.bits.of(f for action in chosen for f in action.neg),
            self.bits.of(f for action in chosen for f in action.add),
            self.bits.of(f for action in chosen for f in action.delete),
            sum(self.question.prices.team[i] for i in ids),
        )


def circles(actions: list[tuple[int, GroundAction]], task: Task, deadline: Deadline) -> list[tuple[int, ...]]:
    """Sets of actions that may share an epoch but in no order follow each other.

    Args:
        actions: candidates with their ids.
        task: the task.
        deadline: polled.
    """
    by_id = dict(actions)
    disables = {i: [j for j, b in deadline.each(actions) if j != i and _disables(a, b)] for i, a in actions}
    found: set[tuple[int, ...]] = set()

    def extend(chosen: tuple[int, ...]) -> None:
        deadline.tick()
        if len(chosen) > 1 and _strongly_connected(chosen, disables):
            found.add(tuple(sorted(chosen)))
        if len(chosen) < len(task.agents):
            beside = [by_id[i] for i in chosen]
            for j in {j for i in chosen for j in disables[i]} - set(chosen):
                if fits(by_id[j], beside, strict=False):
                    extend((*chosen, j))

    for i, _ in actions:
        extend((i,))
    return sorted(found)


def _disables(a: GroundAction, b: GroundAction) -> bool:
    return not set(a.delete).isdisjoint(b.pre) or not set(a.add).isdisjoint(b.neg)


def _strongly_connected(chosen: tuple[int, ...], disables: dict[int, list[int]]) -> bool:
    """Whether each of the actions leads to each other one along ``disables``."""
    members = set(chosen)
    for start in chosen:
        reached, pending = {start}, [start]
        while pending:
            for j in disables[pending.pop()]:
                if j in members and j not in reached:
                    reached.add(j)
                    pending.append(j)
        if reached != members:
            return False
    return True
