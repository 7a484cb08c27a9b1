"""What the bounds on moves work on: automata, the needs of their actions, prices and limits."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace

from serendipity.model import Deadline, Task
from verify.programs.agents.product import Automaton, Move


@dataclass(frozen=True, slots=True)
class Windows:
    """Windows that are short: what they say of the human's automaton.

    Attributes:
        longest: epochs of the longest one.
        paid: by the number of epochs before a window, the states in which it may open, and what the human
            has paid by then.
        planned: the human's moves before windows, as states and actions, and how many are done before each.
        last: by state, the last epoch of a window in which the human may be there; missing ones are in none.
    """

    longest: int
    paid: Sequence[Mapping[int, int]]
    planned: Mapping[tuple[int, int], int]
    last: Mapping[int, int]

    def open(self, epoch: int) -> tuple[int, Mapping[int, int]]:
        """How many epochs there are before a window that is open in an epoch, at least; where it may open."""
        before = max(0, epoch - self.longest)
        return before, self.paid[before] if before < len(self.paid) else {}


@dataclass(slots=True)
class TeamMoves:
    """The automata of all agents, with the moves that are still on some plan.

    Attributes:
        machines: an automaton for each agent, by id.
        pre: for each action the facts that it needs outside its participants' automata.
        neg: the same for facts that have to be false.
        price: what each action adds to the objective, by id.
        most: what all actions together may add.
        wanted_true: facts that a goal wants true at the end.
        wanted_false: those that it wants false.
        finals: by agent the automaton states in which a plan may end.
        watched: agents who go on to the end: what is true in their automata counts there.
        windows: where windows may be, if they are short.
        moves: by agent and state, the moves that are left.
        far: more than a plan within the limit costs, and than there are epochs: as good as no way.
        needed: the facts that some action needs outside its participants' automata.
    """

    task: Task
    machines: Sequence[Automaton]
    pre: Mapping[int, tuple[int, ...]]
    neg: Mapping[int, tuple[int, ...]]
    price: Sequence[int]
    horizon: int
    most: int
    wanted_true: frozenset[int]
    wanted_false: frozenset[int]
    finals: Sequence[set[int]]
    watched: frozenset[int]
    deadline: Deadline
    windows: Windows | None = None
    moves: list[list[list[Move]]] = field(default_factory=list)
    needed: frozenset[int] = frozenset()
    far: int = field(init=False)

    def __post_init__(self) -> None:
        self.far = max(self.most, self.horizon) + 1
        self.moves = [machine.moves for machine in self.machines]
        needs = (*self.pre.values(), *self.neg.values())
        self.needed = frozenset(f for facts in self.deadline.each(needs) for f in facts)

    @property
    def robots(self) -> list[int]:
        """Ids of all agents but the human."""
        return [k for k in range(len(self.machines)) if k != self.task.human]

    def divided(self, by: int) -> "TeamMoves":
        """The same with prices that are divided by a number, and rounded down."""
        windows = self.windows
        if windows is not None:
            paid = [{state: cost // by for state, cost in states.items()} for states in windows.paid]
            windows = replace(windows, paid=paid)
        price = [price // by for price in self.price]
        return replace(self, price=price, most=self.most // by, windows=windows)

    def count(self) -> int:
        """How many moves are left."""
        return sum(len(moves) for agent in self.moves for moves in self.deadline.each(agent))
