"""Windows and the steps of composite plans."""

from dataclasses import dataclass

from serendipity.model.errors import UsageError


@dataclass(frozen=True, slots=True, order=True)
class Window:
    """The half-open interval of epochs ``[start, end)`` (xi1, xi2 of the paper; semantics 3.1).

    Raises:
        UsageError: not ``1 <= start < end``.
    """

    start: int
    end: int

    def __post_init__(self) -> None:
        if not 1 <= self.start < self.end:
            raise UsageError(f"window: expected 1 <= start < end, got [{self.start}, {self.end})")

    def __len__(self) -> int:
        return self.end - self.start


@dataclass(frozen=True, slots=True, order=True)
class Step:
    """An action in an epoch of a composite plan; a joint action is one step."""

    epoch: int
    action: int
