"""A lower bound on the human's cost alone: exact distances in a projection.

The projection keeps the variables that robots alone never change (their position,
whether they hold something), as long as it stays small.  Dropping the other facts only
makes actions applicable more often, so the bound is admissible.
"""

from serendipity.model import Deadline, Task
from verify.base.bit_distances import BitDistances
from verify.base.fact_bits import BitCondition, BitOperator
from verify.base.operators import OwnActions
from verify.limits import limits


class ProjectedCosts:
    """Weights of cheapest plans in the projection, for the states that are reached from those asked for."""

    def __init__(self, task: Task, own: OwnActions, deadline: Deadline) -> None:
        self._kept = own.bits.of(_private_facts(task, own, deadline))
        goal = BitCondition(own.goal.pre & self._kept, own.goal.neg & self._kept)
        moves = _moves(own, self._kept, deadline)
        self._distances = BitDistances(moves, goal, limits().projected_states, deadline)

    def bound(self, state: int) -> int | None:
        """Least weight of a plan from ``state`` in the projection; None: there is no plan at all."""
        known, least = self._distances.tabled(state & self._kept)
        return least if known else 0


def _private_facts(task: Task, own: OwnActions, deadline: Deadline) -> frozenset[int]:
    """Relevant facts of the variables that robots alone never change, few enough to enumerate."""
    shared: set[int] = set()
    for action in deadline.each(task.actions):
        if task.human not in action.participants:
            shared.update(action.add, action.delete)
    kept: set[int] = set()
    size = 1
    for variable in sorted(task.variables, key=lambda v: -len(v.facts)):
        facts = own.facts.intersection(variable.facts)
        values = len(facts) + 1
        if facts and shared.isdisjoint(variable.facts) and size * values <= limits().projected_states:
            kept |= facts
            size *= values
    return frozenset(kept)


def _moves(own: OwnActions, kept: int, deadline: Deadline) -> list[BitOperator]:
    """The distinct projected actions that change anything, each at its least weight."""
    moves: dict[tuple[int, int, int, int], int] = {}
    for pre, neg, add, delete, weight, _ in deadline.each(own.operators):
        if (add | delete) & kept:
            move = pre & kept, neg & kept, add & kept, delete & kept
            moves[move] = min(weight, moves.get(move, weight))
    return [BitOperator(*move, weight) for move, weight in moves.items()]
