"""Robots one by one, in the share of a call's time that this is worth."""

from collections.abc import Iterator
from typing import Final

from search.call.context import SearchContext
from search.engine.best_first import Incumbent, Progress
from serendipity.model.errors import LimitReachedError
from serendipity.model.task.task import HumanPlan

FIRST: Final = 500
"""Nodes that are searched before."""

_SHARE: Final = 0.5
"""What of the time that is left it may take."""

_SHARE_OF_NUMBERS: Final = 0.7
"""The same where things are alike: what does not end by then has far too many states otherwise."""


def one_by_one(
    context: SearchContext,
    plan: HumanPlan,
    horizon: int,
    best: Incumbent,
    progress: Progress,
    longer: int,
    *,
    by_numbers: bool = False,
) -> Iterator[Incumbent]:
    """Yield the incumbent whenever a window of one epoch has made it better; then raise the bound.

    Args:
        context: of the call, in a mode with windows.
        plan: ``pi_H``.
        horizon: ``T``.
        best: the incumbent, which is made better.
        progress: what is known so far, which is brought up to date.
        longer: no plan with a longer window has a smaller key.
        by_numbers: only where robots see to things that are alike, by how many of them; this is soon done.

    Raises:
        LimitReachedError: the deadline of the call came, not only that of its part for this.
    """
    from search.short_windows.independent.short_windows import (
        short_windows,
    )  # only here: it loads what most calls come by without

    short = None
    share = _SHARE_OF_NUMBERS if by_numbers else _SHARE
    try:
        short = short_windows(
            context.under(context.deadline.part(share)), plan, horizon, best, by_numbers=by_numbers
        )
        if short is not None:
            for _ in short.answers():
                yield best
    except LimitReachedError:
        context.deadline.check()
    if short is not None:
        progress.bound = max(progress.bound, min(short.bound, longer, best.key))
