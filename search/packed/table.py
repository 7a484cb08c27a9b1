"""Tables that serve every call on a task, each built when a call first asks for it."""

from collections.abc import Callable
from typing import Generic, TypeVar

from serendipity.model.resources.deadline import Deadline

T = TypeVar("T")


class KeptTable(Generic[T]):
    """A table that is built under the deadline of who asks first; where that comes, nothing is half made.

    Args:
        build: builds it; holds nothing that holds the table, as nobody collects circles in a call.

    Attributes:
        known: what was built, alone in a tuple; None before.
    """

    __slots__ = ("_build", "known")

    def __init__(self, build: Callable[[Deadline], T]) -> None:
        self._build = build
        self.known: tuple[T] | None = None

    def __call__(self, deadline: Deadline) -> T:
        """What is built."""
        if self.known is None:
            self.known = (self._build(deadline),)
        return self.known[0]
