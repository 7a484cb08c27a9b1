"""Calls that a limit ends at any look at their deadline."""

from collections.abc import Callable, Iterator
from typing import TypeVar

from serendipity.model import Deadline, LimitReachedError
from serendipity_testing.countdown import Countdown, time_is_up

T = TypeVar("T")


def endings(
    call: Callable[[Deadline], T],
    limit: Callable[[], Exception] = time_is_up,
    *,
    sparser: int = 8,
    once: bool = False,
) -> Iterator[T | LimitReachedError]:
    """What comes of a call if the first look at the deadline is the last, the second one, and so on.

    The last one has as much time as it needs.

    Args:
        call: what is asked.
        limit: makes what the deadline raises then.
        sparser: by what share of them the looks get further and further apart; 0 where each one is wanted.
        once: whether the looks after that one are free, as memory may be again.
    """
    looks = 0
    while True:
        deadline = Countdown(looks, limit, once=once)
        try:
            yield call(deadline)
        except LimitReachedError as error:
            yield error
        if not deadline.ran_out:
            return
        looks = max(looks + 1, looks + looks // sparser) if sparser else looks + 1


def answers(
    call: Callable[[Deadline], T], limit: Callable[[], Exception] = time_is_up, *, sparser: int = 8
) -> list[T]:
    """The same for calls that first have nothing to say, and from some look on always an answer."""
    found = list(endings(call, limit, sparser=sparser))
    silent = [ending for ending in found if isinstance(ending, LimitReachedError)]
    spoken = [ending for ending in found if not isinstance(ending, LimitReachedError)]
    assert found == [*silent, *spoken]
    assert {error.reason for error in silent} <= {"time-limit"}
    return spoken
