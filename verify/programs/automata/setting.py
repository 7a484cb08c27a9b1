"""What the pruning and the program of one question work on."""

from collections.abc import Sequence
from dataclasses import dataclass, field

from serendipity.model import Deadline, Task
from verify.base.relevance import Relevant
from verify.programs.agents.product import Automaton
from verify.programs.automata.network import HumanNetwork, Network


@dataclass(slots=True)
class NetworkSetting:
    """Networks, limits and goals of one question.

    Attributes:
        networks: one for each agent, by id; ``human`` is the human's.
        most: limit on the objective in units.
        wanted_true: facts that a goal, or a state to be preserved, wants true.
        wanted_false: facts that a goal wants false.
        finals: end nodes' automaton states that the goals allow, by agent.
        bounds: for the human's automaton states, least weight and actions to a goal state; None: no way.
        last: the human's nodes in which a plan may end; None where pruning has left no other.
        far: more than a plan within the limit weighs, and than there are epochs: as good as no way.
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
    bounds: tuple[list[int | None], list[int | None]]
    last: frozenset[int] | None = None
    far: int = field(init=False)
    outer_pre: dict[int, tuple[int, ...]] = field(default_factory=dict)
    outer_neg: dict[int, tuple[int, ...]] = field(default_factory=dict)

    def __post_init__(self) -> None:
        self.far = max(self.most, self.horizon) + 1
        machines = [network.automaton for network in self.networks]
        self.outer_pre, self.outer_neg = outer_needs(self.task, self.part, machines, self.deadline)


def outer_needs(
    task: Task, part: Relevant, machines: Sequence[Automaton], deadline: Deadline
) -> tuple[dict[int, tuple[int, ...]], dict[int, tuple[int, ...]]]:
    """For each action the facts outside its participants' automata that it needs true, and false."""
    pre: dict[int, tuple[int, ...]] = {}
    neg: dict[int, tuple[int, ...]] = {}
    for i in deadline.each(part.actions):
        inside = [machines[agent].facts for agent in task.actions[i].participants]
        pre[i] = tuple(f for f in part.pre[i] if not any(f in facts for facts in inside))
        neg[i] = tuple(f for f in part.neg[i] if not any(f in facts for facts in inside))
    return pre, neg
