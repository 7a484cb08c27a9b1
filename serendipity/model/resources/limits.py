"""The limits of a call: its own, and a deadline that other work shares."""

import threading

from serendipity.model.errors import UsageError
from serendipity.model.options import limit_of
from serendipity.model.resources.deadline import Deadline


def limits_from(
    time_limit: float | str | None = None,
    memory_limit: float | str | None = None,
    deadline: Deadline | None = None,
    cancelled: threading.Event | None = None,
) -> Deadline:
    """A deadline for a call that starts now, within one that other work may share.

    Raises:
        UsageError: a limit is not a number of at least 0, or one of the others is of another type.
    """
    if not isinstance(deadline, Deadline | None):
        raise UsageError(f"deadline: expected a Deadline, got {deadline!r:.50}")
    if cancelled is not None and not callable(getattr(cancelled, "is_set", None)):
        raise UsageError(f"cancelled: expected a threading.Event, got {cancelled!r:.50}")
    seconds = None if time_limit is None else limit_of("time_limit", time_limit, "seconds")
    mebibytes = None if memory_limit is None else limit_of("memory_limit", memory_limit, "MiB")
    return (deadline or Deadline()).within(seconds, mebibytes, cancelled)
