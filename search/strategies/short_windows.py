"""Windows of one epoch, where longer ones can't be better."""

from collections.abc import Iterator

from search.strategies.call import Call, Part


def robots_apart(call: Call, part: Part) -> Iterator[None]:
    """What each robot can bring about by itself, put together, by the epoch of the window."""
    yield from _apart(call, part, by_numbers=False)


def robots_by_numbers(call: Call, part: Part) -> Iterator[None]:
    """The same by how many of the things that are alike they have seen to."""
    yield from _apart(call, part, by_numbers=True)


def _apart(call: Call, part: Part, *, by_numbers: bool) -> Iterator[None]:
    from search.short_windows.independent.short_windows import (
        short_windows,  # only here: most calls come by without
    )

    plan, epochs = call.plan, call.epochs
    assert plan is not None and epochs is not None, "there is a window"
    short = short_windows(call.under(part.deadline), plan, epochs, call.best, by_numbers=by_numbers)
    if short is None:
        return
    try:
        for _ in short.answers():
            yield
    finally:
        call.raise_bound(min(short.bound, call.longer, call.best.key))


def beside_timetable(call: Call, part: Part) -> Iterator[None]:
    """All states beside the human's timetable, epoch by epoch; it goes on from where a limit came."""
    from search.short_windows.joint.all_together import AllTogether  # only here, as above

    if call.timetable is None:
        plan, epochs = call.plan, call.epochs
        assert plan is not None and epochs is not None, "there is a window"
        call.timetable = AllTogether(call.context, plan, epochs, call.best, call.progress, call.longer)
    yield from call.timetable.windows(part.limit, part.deadline)
