"""``--time-limit`` and ``--memory-limit``: one deadline from a command's beginning to its end."""

from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from importlib import import_module
from typing import Annotated, Final

from serendipity.cli.choices import option
from serendipity.cli.groups import OptionGroup
from serendipity.cli.options.planning import given
from serendipity.model import Deadline, LimitReachedError
from serendipity.model.errors import LIMITS, limit_reason
from serendipity.model.resources.limits import limits_from

PLANNING: Final = ("search:preload",)
"""What planning loads where it turns out to be long: arrays, and what asks the kernel."""

CHECKING: Final = ("serendipity.facade.proofs", "verify:preload")
"""What certificates load as claims turn out to be hard."""


class Limits(OptionGroup):
    """The limits of a command, as texts."""

    time_limit: Annotated[
        str | None, option("--time-limit SECONDS", "Stop after so many seconds, reading included.")
    ] = None
    memory_limit: Annotated[
        str | None, option("--memory-limit MIB", "Stop when so many MiB of memory are in use.")
    ] = None

    @property
    def given(self) -> dict[str, str]:
        """Those that the user gave, for answers that name them among their options."""
        return given(time_limit=self.time_limit, memory_limit=self.memory_limit)

    def begin(self, *modules: str) -> Deadline:
        """The deadline of a command, which starts now: it covers reading, the work, and checking it.

        Args:
            modules: those that the command is going to use, or ``module:function`` for a function that
                loads them.  They are loaded first, if time is limited: like the start of the interpreter,
                that takes as long for every task.
        """
        if self.time_limit is not None:
            load(("serendipity.facade.loading", *modules))
        return limits_from(self.time_limit, self.memory_limit)


def load(modules: Iterable[str]) -> None:
    """Load modules, or what a ``module:function`` loads."""
    for name in modules:
        module, _, function = name.partition(":")
        loaded = import_module(module)
        if function:
            getattr(loaded, function)()


@contextmanager
def during(doing: str) -> Iterator[None]:
    """Say of a LimitReachedError that comes inside what it kept from being done."""
    try:
        yield
    except LIMITS as limit:
        if isinstance(limit, LimitReachedError) and limit.doing is not None:
            raise
        raise LimitReachedError(limit_reason(limit), doing) from None
