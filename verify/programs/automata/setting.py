"""What the pruning and the program of one question work on."""

from dataclasses import dataclass, field

from serendipity.model import Deadline, Task
from verify.base.relevance import Relevant
from verify.programs.automata.network import HumanNetwork, Network


@dataclass(slots=True)
class Setting:
    """Networks, limits and goals of one question.

    Attributes:
        task: the task.
        part: its relevant part.
        networks: one for each agent, by id; ``human`` is the human's.
        horizon: number of epochs.
        most: limit on the objective in units.
        wanted_true: facts that a goal, or a state to be preserved, wants true.
        wanted_false: facts that a goal wants false.
        finals: end nodes' automaton states that the goals allow, by agent.
        deadline: polled by the pruning and the program.
        bounds: for the human's automaton states, least weight and actions to a goal state.
        last: the human's nodes in which a plan may end; None where pruning has left no other.
        outer_pre: facts outside the participants' automata that each action needs true.
        outer_neg: the same, false.
    """

    task: Task
    part: Relevant
    networks: list[Network]
    human: HumanNetwork
    horizon: int
    most: int
    wanted_true: frozenset[int]
    wanted_false: frozenset[int]
    finals: list[set[int]]
    deadline: Deadline
    bounds: tuple[list[int], list[int]]
    last: frozenset[int] | None = None
    outer_pre: dict[int, tuple[int, ...]] = field(default_factory=dict)
    outer_neg: dict[int, tuple[int, ...]] = field(default_factory=dict)

    def __post_init__(self) -> None:
        for i in self.deadline.each(self.part.actions):
            inside: set[int] = set()
            for agent in self.task.actions[i].participants:
                inside |= self.networks[agent].automaton.facts
            self.outer_pre[i] = tuple(f for f in self.part.pre[i] if f not in inside)
            self.outer_neg[i] = tuple(f for f in self.part.neg[i] if f not in inside)
