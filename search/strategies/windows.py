"""Searches of all plans of a call, or of those with a short window, in one space."""

from collections.abc import Callable, Iterator
from typing import Final

from search.engine.best_first import Ties, best_first
from search.strategies.call import Allowance, Call

_TIES: Final = 100
"""Nodes for the sake of a better window for the same objective."""


def all_plans(call: Call, part: Allowance) -> Iterator[None]:
    """All plans, until none can be better."""
    return _search(call, part, _ties(call))


def few_nodes(call: Call, part: Allowance) -> Iterator[None]:
    """All plans, for a number of nodes: many calls need no more."""
    left = iter(range(part.limit))
    return _search(call, part, _ties(call), lambda: next(left, None) is None)


def while_bounds_are_exact(call: Call, part: Allowance) -> Iterator[None]:
    """All plans, for as long as none costs more than seemed possible at the start."""
    return _search(call, part, None, _bound_has_risen(call))


def ties(call: Call, part: Allowance) -> Iterator[None]:
    """Better windows and fewer actions for the same objective, as far as they come soon."""
    yield from _search(call, part, _ties(call))


def _search(
    call: Call, part: Allowance, ties: Ties | None, is_enough: Callable[[], bool] | None = None
) -> Iterator[None]:
    """Plans of the call, the best of which is the answer unless it is enough before."""
    space = call.space(part.deadline, call.best.key)
    if not (yield from best_first(space, call.best, call.progress, part.deadline, ties, is_enough)):
        call.finish()


def _ties(call: Call) -> Ties | None:
    """The limit on telling plans of the best objective apart; none where private distances say enough."""
    return Ties(call.keys.objective_shift, _TIES) if call.context.distances_say_little else None


def _bound_has_risen(call: Call) -> Callable[[], bool]:
    """Enough once no plan has as good an objective as seemed possible at first, if the kernel can go on."""
    progress, shift = call.progress, call.keys.objective_shift
    first: int | None = None
    is_settled = False

    def is_enough() -> bool:
        nonlocal first, is_settled
        if is_settled:
            return False
        level = progress.bound >> shift
        first = level if first is None else first
        is_settled = level > first
        return is_settled and call.context.team is not None

    return is_enough
