"""Both together, without turns: a bound on every policy."""

from search.call.prepared_task import PreparedTask
from search.modes.assistance.bounds.bound import ValueBound
from search.modes.assistance.game.game import Game
from search.modes.assistance.game.solution import Costs
from search.packed.cost_vector import INFINITE_KEY
from serendipity.model.resources.deadline import Deadline


def joint_optimum(prepared: PreparedTask) -> Costs | None:
    """The joint optimum, or a relaxation of it; None where not even both together reach the goal."""
    game = Game(prepared, Deadline())
    value = ValueBound(game)(game.init)
    return None if value >= INFINITE_KEY else game.pair(value)
