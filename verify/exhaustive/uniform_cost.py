"""Composite plans without a horizon: uniform-cost search over joint states, with an estimate.

Without a horizon an epoch costs nothing, so that an action set can be taken apart and its
actions executed one after the other, those first that others of the set would disable.
Only sets in which actions disable each other in a circle have to stay together.
"""

from collections.abc import Iterator
from dataclasses import replace

from serendipity.model import LimitReachedError, Step
from serendipity.model.errors import LIMITS, limit_reason
from verify.base.execution import State
from verify.base.fact_bits import BitCondition, BitOperator, BitOperators, FactBits
from verify.base.relevance import Relevant, relevant_part
from verify.base.shortest_paths import PathSearch
from verify.base.subproblem import PricedPlan, Subproblem, least
from verify.base.undecided import during
from verify.exhaustive.circles import circles
from verify.exhaustive.team_problem import cheapest_without_epochs, team_problem
from verify.limits import limits
from verify.packed.problem import TooLargeError
from verify.programs.agents.product import automata
from verify.programs.automata.network import distances, goal_states
from verify.programs.effort import Effort, Minimum


def cheapest(question: Subproblem, effort: Effort) -> Minimum:
    """The least cost of a plan with any number of epochs, within the question's limits.

    Args:
        question: its horizon is not looked at; its rule is ``free``.
        effort: its method says whether estimates of what is left may spare states.

    Raises:
        LimitReachedError: the deadline came before the search began.
    """
    bounded, few = effort.method != "exhaustive", limits().few_joint_states
    with during("preparing the search for joint plans"):
        part = relevant_part(question)
        if part is None:
            return Minimum("none")
        search = JointSearch(question, part)
    if bounded:
        found = search.run(few)
        if search.closed <= few:
            return replace(found, states=search.closed)
    with during("preparing the search for joint plans"):
        try:
            team = team_problem(question, part, bounded=bounded)
        except TooLargeError:
            team = None
    if team is not None:
        return cheapest_without_epochs(question, team, bounded=bounded)
    found = search.run()
    return replace(found, states=search.closed)


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

    def __call__(self, state: State) -> int | None:
        """The bound in a state; None: there is no way to the goals."""
        return self.by_state.get(state & self.facts, 0)


class JointSearch:
    """Uniform-cost search of one question; what a timetable changes can be overridden."""

    def __init__(self, question: Subproblem, part: Relevant) -> None:
        self.question = question
        self.task = question.task
        self.deadline = question.deadline
        self.part = part
        self.bits = FactBits(part.facts)
        self.operators = BitOperators(self._bundles(part), self.deadline)
        conditions = [self.task.goal, *([self.task.robot_goal] if question.robots_goal else [])]
        self.goal = BitCondition(
            self.bits.of(f for c in conditions for f in c.positive),
            self.bits.of(f for c in conditions for f in c.negative),
        )
        left = LeastLeft(question, part)
        self._human = self.bits.of(left.facts)
        self._left = {self.bits.of(state): least for state, least in left.by_state.items()}
        self.closed = 0
        self.bound: int | None = None

    def run(self, most_states: int | None = None) -> Minimum:
        """The cheapest plan within the question's limits, if it takes no more states than these."""
        self.closed = 0
        try:
            return self._search(limits().joint_states if most_states is None else most_states)
        except LIMITS as limit:
            doing = f"searching joint plans, {self.closed:,} states so far"
            return Minimum(
                "undecided", bound=self.bound, reason=str(LimitReachedError(limit_reason(limit), doing))
            )

    def _search(self, most_states: int) -> Minimum:
        most = least(self.question.most, self.question.most_cost)
        below = None if most is None else most + 1
        search = PathSearch(self.start, self._successors, self.estimate, self.deadline, below)
        for state, self.bound in search:
            self.closed += 1
            if self.is_goal(state):
                return self._found(search.path(state), search.distance[state])
            if self.closed > most_states:
                return Minimum("undecided", bound=self.bound, reason=f"more than {most_states} joint states")
        return Minimum("none")

    def _successors(self, state: int) -> Iterator[tuple[int, int, BitOperator]]:
        for bundle in self.applicable(state):
            yield bundle.after(state), bundle.weight, bundle

    @property
    def start(self) -> int:
        """The initial state."""
        return self.bits.of(self.task.init)

    def is_goal(self, state: int) -> bool:
        """Whether the goals hold."""
        return self.goal.holds(state)

    def _found(self, bundles: list[BitOperator], cost: int) -> Minimum:
        epochs = enumerate(bundles, start=1)
        steps = tuple(Step(epoch, i) for epoch, bundle in epochs for i in bundle.label)
        return Minimum("found", PricedPlan(steps, None, cost, cost), cost)

    def applicable(self, state: int) -> Iterator[BitOperator]:
        """What can be done next."""
        return self.operators.applicable(state)

    def estimate(self, state: int) -> int | None:
        """A lower bound on the cost that is left; None: there is no way to the goals."""
        return self._left.get(state & self._human, 0)

    def _bundles(self, part: Relevant) -> Iterator[BitOperator]:
        for i in part.actions:
            yield self.bundle((i,))
        if not self.question.options.strict:
            actions = [(i, self.task.actions[i]) for i in self.deadline.each(part.actions)]
            for circle in circles(actions, self.task, self.deadline):
                yield self.bundle(circle)

    def bundle(self, ids: tuple[int, ...]) -> BitOperator:
        """The actions as one."""
        chosen = [self.task.actions[i] for i in ids]
        return BitOperator(
            self.bits.of(f for action in chosen for f in action.pre),
            self.bits.of(f for action in chosen for f in action.neg),
            self.bits.of(f for action in chosen for f in action.add),
            self.bits.of(f for action in chosen for f in action.delete),
            sum(self.question.prices.team[i] for i in ids),
            ids,
        )
