"""Networks: an agent's automaton unrolled over the epochs, one unit of flow each.

An arc is a tuple ``(source, target, action, weight, needs)``: node numbers, the action's id
(:data:`WAIT` for none), what it adds to the objective, and the facts outside the automaton
that must be true before the epoch besides the action's own precondition.
"""

from collections.abc import Iterable, Iterator, Set
from dataclasses import dataclass, field
from typing import Final

from serendipity.model import Deadline
from verify.base.control import ALL, OWN, SUFFIX, Control, HumanControl
from verify.base.execution import awake, idling
from verify.base.relevance import Relevant
from verify.base.shortest_paths import dijkstra
from verify.base.subproblem import Subproblem
from verify.programs.agents.product import Automaton

WAIT: Final = -1
NOTHING: Final[frozenset[int]] = frozenset()

Arc = tuple[int, int, int, int, frozenset[int]]
ACTION: Final = 2
"""Where an arc has its action; arcs are tuples, since named ones take five times as long to make."""


@dataclass(slots=True)
class Network:
    """One agent's network.

    Attributes:
        state_of: automaton state of each node.
        layers: the arcs of each epoch; ``layers[t - 1]`` are those of epoch t.
        open_end: whether the flow goes on to the last epoch; else it may stop anywhere,
            which stands for an agent that does nothing any more.
        due: facts that do not last (semantics 10): where one is true nobody waits.
    """

    automaton: Automaton
    state_of: list[int] = field(default_factory=lambda: [0])
    layers: list[list[Arc]] = field(default_factory=list)
    open_end: bool = True
    start: int = 0
    due: Set[int] = NOTHING

    @property
    def agent(self) -> int:
        """The agent's id."""
        return self.automaton.agent

    def true_facts(self, node: int) -> frozenset[int]:
        """The automaton's facts that are true in a node."""
        return self.automaton.states[self.state_of[node]]

    def may_wait(self, node: int) -> bool:
        """Whether the agent may do nothing from a node on."""
        return not self.due or self.due.isdisjoint(self.true_facts(node))

    def outgoing(self, node: int, epoch: int) -> Iterator[Arc]:
        """All arcs of an epoch from a node, before anything is pruned."""
        raise NotImplementedError

    def ends(self, node: int) -> list[frozenset[int]]:
        """Sets of facts one of which must hold for the plan to end in ``node``."""
        del node
        return [NOTHING]


class RobotNetwork(Network):
    """A robot may do any of its actions, or wait, in every epoch."""

    def __init__(self, automaton: Automaton, weights: list[int], due: Set[int], *, open_end: bool) -> None:
        super().__init__(automaton, list(range(len(automaton.states))), open_end=open_end, due=due)
        self.weights = weights

    def outgoing(self, node: int, epoch: int) -> Iterator[Arc]:
        """See :class:`Network`."""
        del epoch
        if self.may_wait(node):
            yield (node, node, WAIT, 0, NOTHING)
        for action, target in self.automaton.moves[node]:
            yield (node, target, action, self.weights[action], NOTHING)


class HumanNetwork(Network):
    """The human's automaton times their control automaton."""

    def __init__(
        self,
        automaton: Automaton,
        weights: list[int],
        control: HumanControl,
        question: Subproblem,
        part: Relevant,
    ) -> None:
        super().__init__(automaton, [0], due=question.task.due_for.keys())
        self.weights = weights
        self.control = control
        self.facts = part.facts
        self.controls: list[Control] = [control.start]
        self.numbers: dict[tuple[int, Control], int] = {(0, control.start): 0}
        task = question.task
        own = question.deadline.each(part.actions)
        self.own = {i for i in own if task.actions[i].participants == (task.human,)}
        self.waiting = idling(task)
        self.awake = awake(task)

    def node(self, state: int, control: Control) -> int:
        """The number of a node, new or old."""
        number = self.numbers.setdefault((state, control), len(self.state_of))
        if number == len(self.state_of):
            self.state_of.append(state)
            self.controls.append(control)
        return number

    def outgoing(self, node: int, epoch: int) -> Iterator[Arc]:
        """See :class:`Network`."""
        state, control = self.state_of[node], self.controls[node]
        moves = self.automaton.moves[state]
        for leg in self.control.legs(control, epoch):
            needs = self.outer(leg.needs, state)
            if needs is None:
                continue
            may_wait = self.may_wait(node)
            if leg.wait and may_wait and (leg.free or self.awake.isdisjoint(self.true_facts(node))):
                yield (node, self.node(state, leg.after), WAIT, leg.weight, needs)
            for action, target in moves:
                if action in self.waiting and not may_wait:
                    continue
                if leg.actions == ALL or (
                    action in self.own if leg.actions == OWN else action in leg.actions
                ):
                    weight = leg.weight + self.weights[action]
                    yield (node, self.node(target, leg.after), action, weight, needs)

    def outer(self, needs: frozenset[int], state: int) -> frozenset[int] | None:
        """What is needed of facts outside the automaton; None if those inside rule it out."""
        if not needs:
            return NOTHING
        inside = needs & self.automaton.facts
        if not inside <= self.automaton.states[state]:
            return None
        return (needs & self.facts) - inside

    def ends(self, node: int) -> list[frozenset[int]]:
        """See :class:`Network`."""
        state = self.state_of[node]
        wanted = (self.outer(needs, state) for needs in self.control.accepts(self.controls[node]))
        return [needs for needs in wanted if needs is not None]

    def in_suffix(self, node: int) -> bool:
        """Whether the epoch that led to ``node`` belongs to the suffix: no robot may act."""
        return self.controls[node][0] == SUFFIX


def actions_of(arcs: Iterable[Arc], deadline: Deadline) -> set[int]:
    """The actions that arcs stand for, :data:`WAIT` among them."""
    return {action for _, _, action, _, _ in deadline.each(arcs)}


def distances(
    automaton: Automaton, weights: list[int], goals: set[int], deadline: Deadline
) -> tuple[list[int | None], list[int | None]]:
    """Least weight and fewest actions from each automaton state to a goal state; None: there is no way."""
    backward: list[list[tuple[int, int]]] = [[] for _ in automaton.states]
    for state, moves in enumerate(deadline.each(automaton.moves)):
        for action, target in moves:
            backward[target].append((state, weights[action]))
    ends = dict.fromkeys(goals, 0)
    least = dijkstra(ends.items(), backward.__getitem__, deadline)
    fewest = dijkstra(ends.items(), lambda state: ((source, 1) for source, _ in backward[state]), deadline)
    states = range(len(backward))
    return [least.get(state) for state in states], [fewest.get(state) for state in states]


def goal_states(question: Subproblem, automaton: Automaton) -> set[int]:
    """Automaton states in which no literal of the goals is false."""
    true = automaton.facts.intersection(question.goal.positive)
    false = automaton.facts.intersection(question.goal.negative)
    return {k for k, state in enumerate(automaton.states) if true <= state and false.isdisjoint(state)}
