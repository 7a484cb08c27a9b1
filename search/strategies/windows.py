"""Searches of all plans of a call, or of those with a short window, in one space."""

from collections.abc import Iterator
from typing import Final

from search.engine.best_first import Ties, best_first
from search.strategies.call import Allowance, Call

_TIES: Final = 100
"""Nodes for the sake of a better window for the same objective."""


def all_plans(call: Call, part: Allowance) -> Iterator[None]:
    """All plans, until none can be better."""
    # How far plans of the best objective are told apart; all the way where private distances say enough.
    ties = Ties(call.keys.objective_shift, _TIES) if call.context.distances_say_little else None
    space = call.space(part.deadline, call.best.key)
    if not (yield from best_first(space, call.best, call.progress, part.deadline, ties, part.limit)):
        call.finish()


def few_nodes(call: Call, part: Allowance) -> Iterator[None]:
    """All plans, for a number of nodes: many calls need no more."""
    return all_plans(call, part)


def ties(call: Call, part: Allowance) -> Iterator[None]:
    """Better windows and fewer actions for the same objective, as far as they come soon."""
    return all_plans(call, part)
