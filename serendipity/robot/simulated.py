"""Robots that need time and fail by dice, and have no bodies; and how long they take for what they do."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from random import Random
from typing import Final

from serendipity.model import UsageError, exact
from serendipity.robot.adapter import Epoch, Order, Report

_OTHERS: Final = "*"
_EXPECTED: Final = "expected some of VERB=SECONDS or VERB=LEAST..MOST, as in move=2..4,*=1"

Span = tuple[float, float]
"""The least and the most seconds; what lies between is equally probable."""


@dataclass(frozen=True, slots=True)
class Durations:
    """Seconds by the first word of an action.

    Attributes:
        spans: of those that are named.
        others: of all others.
    """

    spans: Mapping[str, Span] = field(default_factory=dict)
    others: Span = (1.0, 1.0)

    @classmethod
    def parse(cls, text: str) -> "Durations":
        """Durations as a command line names them: ``move=2..4,hand_over=3,*=1``.

        Raises:
            UsageError: it is of another form.
        """
        spans: dict[str, Span] = {}
        for part in text.replace(" ", "").lower().split(","):
            verb, equals, value = part.partition("=")
            if not verb or not equals or verb in spans:
                raise UsageError(f"durations: {_EXPECTED}, got '{text:.60}'")
            least, dots, most = value.partition("..")
            low, high = _seconds(least), _seconds(most if dots else least)
            if low > high:
                raise UsageError(f"durations: {verb}: expected the least first, got '{value}'")
            spans[verb] = low, high
        others = spans.pop(_OTHERS, cls().others)
        return cls(spans, others)

    def draw(self, action: str, dice: Random) -> float:
        """Seconds for an action; a verb is a whole word or, in ground files, the beginning of one."""
        word = action.split()[0]
        while word not in self.spans and "_" in word:
            word = word.rpartition("_")[0]
        low, high = self.spans.get(word, self.others)
        return low if low == high else dice.uniform(low, high)


def _seconds(text: str) -> float:
    seconds = exact(text, "durations")
    if seconds < 0:
        raise UsageError(f"durations: expected seconds, got '{text}'")
    return float(seconds)


_LONGEST: Final = 3
"""Epochs that a slow action takes at most beyond its usual time."""


class Simulated:
    """An adapter without robots.

    Args:
        dice: draw durations and failures.
        durations: of actions; None: a second for each epoch that is planned.
        epoch: how many seconds an epoch is long.
        fail: the probability that an action fails, when its time is over.
        slow: the probability that an action takes one to three epochs longer.

    Raises:
        UsageError: an epoch has no length.
    """

    def __init__(
        self,
        dice: Random,
        durations: Durations | None = None,
        *,
        epoch: float = 1.0,
        fail: float = 0.0,
        slow: float = 0.0,
    ) -> None:
        if epoch <= 0:
            raise UsageError(f"epoch_seconds: expected more than 0, got {epoch:g}")
        self._dice = dice
        self._durations = durations
        self._epoch = epoch
        self._fail = fail
        self._slow = slow
        self._begun: dict[Order, _Deed] = {}

    def execute(self, epoch: Epoch) -> Sequence[Report]:
        """See :class:`serendipity.robot.Adapter`."""
        begun = {order: self._begun.get(order) or self._begin(order) for order in epoch.orders}
        reports = {order: deed.go_on(self._epoch) for order, deed in begun.items()}
        self._begun = {o: deed for o, deed in begun.items() if reports[o].outcome == "running"}
        return list(reports.values())

    def close(self) -> None:
        """See :class:`serendipity.robot.Adapter`."""

    def _begin(self, order: Order) -> "_Deed":
        planned = Durations(others=(order.epochs, order.epochs))
        seconds = (self._durations or planned).draw(order.action, self._dice)
        if self._dice.random() < self._slow:
            seconds += self._epoch * self._dice.randint(1, _LONGEST)
        return _Deed(seconds, fails=self._dice.random() < self._fail)


@dataclass(slots=True)
class _Deed:
    """An action that was begun: how long it takes, whether it fails in the end, and what was spent on it."""

    seconds: float
    fails: bool
    spent: float = 0.0

    def go_on(self, seconds: float) -> Report:
        """Spend some more time on it."""
        self.spent = min(self.seconds, self.spent + seconds)
        if self.spent < self.seconds:
            return Report("running", self.spent)
        return Report("failed" if self.fails else "done", self.spent)
