"""A bound where the prime's optimal costs are out of reach: the joint optimum without deletes.

A fact costs what the dearest of what it takes costs (h_max, Bonet and Geffner 2001).
"""

from collections.abc import Mapping

from search.engine.and_or import AndOrGraph, Rule
from search.modes.assistance.game.game import Game
from search.packed.cost_vector import INFINITE_KEY
from serendipity.model.resources.deadline import Deadline


def joint_lower_bound(game: Game, deadline: Deadline) -> int:
    """A value that no policy undercuts from the initial state; :class:`LimitReachedError` at the deadline."""
    task = game.task
    shifts: dict[tuple[int, ...], int] = {(task.human,): game.unit_bits, (task.robots[0],): 0}
    rules, values = [], []
    for action in deadline.each(task.actions):
        shift = shifts.get(action.participants)
        if shift is not None:
            rules.append(Rule(action.pre, action.add))
            values.append(int(action.cost * game.scale) << shift)

    def value(k: int, costs: Mapping[int, int]) -> int:
        return max((costs[fact] for fact in rules[k].tails), default=0) + values[k]

    costs, _ = AndOrGraph(rules, deadline).settle(task.init, value, INFINITE_KEY)
    return max((costs.get(fact, INFINITE_KEY) for fact in task.goal.positive), default=0)
