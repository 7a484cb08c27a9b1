"""How an answer gets better: what is new, and objective and lower bound over time."""

from collections.abc import Iterator

from search import Outcome
from serendipity.model.deadline import Deadline


def news(outcomes: Iterator[Outcome]) -> Iterator[Outcome]:
    """The outcomes that say something new, and the last one."""
    said: tuple[object, ...] = ()
    repeated: Outcome | None = None
    for outcome in outcomes:
        says = (outcome.status, outcome.objective, outcome.lower_bound)
        if says == said:
            repeated = outcome
        else:
            said, repeated = says, None
            yield outcome
    if repeated is not None:
        yield repeated


class Gap:
    """Objective and lower bound over time: an entry for each that is better than before.

    Args:
        deadline: of the call.
    """

    def __init__(self, deadline: Deadline) -> None:
        self._deadline = deadline
        self._entries: list[dict[str, float | None]] = []

    def record(self, outcome: Outcome) -> None:
        """Note what is known now."""
        now = {
            "objective": None if outcome.objective is None else float(outcome.objective),
            "lower_bound": None if outcome.lower_bound is None else float(outcome.lower_bound),
        }
        if not self._entries or any(self._entries[-1][name] != value for name, value in now.items()):
            self._entries.append({"seconds": self._deadline.elapsed(), **now})

    def known(self) -> tuple[dict[str, float | None], ...]:
        """The entries so far."""
        return tuple(self._entries)
