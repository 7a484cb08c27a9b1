"""Searches of all plans of a call in one space, and of those with a window of one epoch."""

from collections.abc import Iterator
from typing import TYPE_CHECKING, Final

from search.engine.best_first import Ties, best_first
from search.strategies.call import Allowance, Call
from serendipity.model.resources.deadline import Deadline

if TYPE_CHECKING:  # loaded by the calls that it serves
    from search.short_windows.question import ShortWindowQuestion

_TIES: Final = 100
"""Nodes for the sake of a better window for the same objective."""


def all_plans(call: Call, part: Allowance) -> Iterator[None]:
    """All plans, until none can be better, or for a number of nodes."""
    # How far plans of the best objective are told apart; all the way where private distances say enough.
    ties = Ties(call.keys.objective_shift, _TIES) if call.context.distances_say_little else None
    space = call.space(part.deadline, call.best.key)
    if not (yield from best_first(space, call.best, call.progress, part.deadline, ties, part.limit)):
        call.finish()


def robots_apart(call: Call, part: Allowance) -> Iterator[None]:
    """Outcomes of each robot by itself, put together, by the epoch of the window."""
    # Only here, as below: most calls come by without.
    from search.short_windows.independent.short_windows import short_windows

    short = short_windows(_question(call, part.deadline))
    if short is None:
        return
    try:
        for _ in short.answers():
            yield
    finally:
        call.raise_bound(min(short.bound, call.longer, call.best.key))


def beside_timetable(call: Call, part: Allowance) -> Iterator[None]:
    """All states beside the human's timetable, epoch by epoch; it goes on from where a limit came."""
    from search.short_windows.joint.all_together import AllTogether

    if call.timetable is None:
        question = _question(call, call.context.deadline)
        call.timetable = AllTogether(question, call.progress, call.longer)
    yield from call.timetable.windows(part.limit, part.deadline)


def _question(call: Call, deadline: Deadline) -> "ShortWindowQuestion":
    from search.short_windows.question import ShortWindowQuestion

    plan, epochs = call.plan, call.epochs
    assert plan is not None and epochs is not None, "there is a window"
    return ShortWindowQuestion(call.under(deadline), plan, epochs, call.best)
