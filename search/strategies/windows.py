"""Searches of all plans of a call, or of those with a short window, in one space."""

from collections.abc import Iterator
from contextlib import suppress
from typing import Final

from search.engine.best_first import Ties, best_first
from search.engine.until import EnoughError, Until, few, risen
from search.strategies.call import Allowance, Call

_TIES: Final = 1_000
"""Nodes for the sake of a better window for the same objective."""


def all_plans(call: Call, part: Allowance) -> Iterator[None]:
    """All plans, until none can be better."""
    yield from ties(call, part)
    call.finish()


def few_nodes(call: Call, part: Allowance) -> Iterator[None]:
    """The same for a number of nodes: many calls need no more."""
    space = Until(call.space(part.deadline, call.best.key), few(part.limit))
    with suppress(EnoughError):
        for _ in best_first(space, call.best, call.progress, part.deadline, _ties(call)):
            yield
        call.finish()


def while_bounds_are_exact(call: Call, part: Allowance) -> Iterator[None]:
    """The same for as long as no plan costs more than seemed possible at the start."""
    enough = risen(call.progress, call.keys.objective_shift, lambda: call.context.team is not None)
    space = Until(call.space(part.deadline, call.best.key), enough)
    with suppress(EnoughError):
        for _ in best_first(space, call.best, call.progress, part.deadline):
            yield
        call.finish()


def ties(call: Call, part: Allowance) -> Iterator[None]:
    """Better windows and fewer actions for the same objective, as far as they come soon."""
    space = call.space(part.deadline, call.best.key)
    for _ in best_first(space, call.best, call.progress, part.deadline, _ties(call)):
        yield


def _ties(call: Call) -> Ties | None:
    """How far plans of the best objective are told apart: all the way, where private distances say enough."""
    return Ties(call.keys.objective_shift, _TIES) if call.context.distances_say_little else None
