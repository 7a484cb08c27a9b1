"""``--time-limit`` and ``--memory-limit``: one deadline from a command's beginning to its end."""

from collections.abc import Iterator
from contextlib import contextmanager
from importlib import import_module
from typing import Annotated, Final

import typer

from serendipity.model import Deadline, LimitReachedError
from serendipity.model.errors import LIMITS, limit_reason
from serendipity.model.resources.limits import limits_from

TimeLimit = Annotated[
    str | None,
    typer.Option("--time-limit", metavar="SECONDS", help="Stop after so many seconds, reading included."),
]
MemoryLimit = Annotated[
    str | None,
    typer.Option("--memory-limit", metavar="MIB", help="Stop when so many MiB of memory are in use."),
]


PLANNING: Final = (
    "search.short_windows.independent.short_windows",
    "search.short_windows.joint.all_together",
    "search.classical.canonical",
    "search.classical.team",
    "search.kernel.signatures",
    "search.human.own_problem",
    "search.abstractions.bound",
    "search.abstractions.reachability",
)
"""What planning loads where it turns out to be long: arrays, and what asks the kernel."""

CHECKING: Final = (
    "serendipity.facade.proofs",
    "verify.packed.cheapest_path",
    "verify.programs.promising.many_moves",
    "verify.policy",
    "highspy",
    "numpy.ma",
    "numpy.random",
    "email.parser",
)
"""What certificates load as claims turn out to be hard: arrays, a solver, and what reads its version."""


def begin(time_limit: str | None, memory_limit: str | None, *modules: str) -> Deadline:
    """The deadline of a command, which starts now: it covers reading, the work, and checking it.

    Args:
        time_limit: seconds, or None.
        memory_limit: MiB, or None.
        modules: those that the command is going to use.  They are loaded first, if time is
            limited: like the start of the interpreter, that takes as long for every task.

    Raises:
        UsageError: a limit is not a number of at least 0.
    """
    if time_limit is not None:
        for name in ("serendipity.facade.loading", *modules):
            import_module(name)
    return limits_from(time_limit, memory_limit)


@contextmanager
def during(doing: str) -> Iterator[None]:
    """Say of a limit that comes inside what it kept from being done.

    Raises:
        LimitReachedError: a limit came.
    """
    try:
        yield
    except LIMITS as limit:
        if isinstance(limit, LimitReachedError) and limit.doing is not None:
            raise
        raise LimitReachedError(limit_reason(limit), doing) from None
