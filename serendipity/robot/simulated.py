"""Robots that need time and fail by dice, and have no bodies."""

from collections.abc import Sequence
from dataclasses import dataclass
from random import Random
from typing import Final

from serendipity.model.errors import UsageError
from serendipity.robot.adapter import Epoch, Order, Report
from serendipity.robot.durations import Durations

_LONGEST: Final = 3
"""Epochs that a slow action takes at most beyond its usual time."""


class Simulated:
    """An adapter without robots.

    Args:
        dice: draw durations and failures.
        durations: of actions.
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
        self._durations = durations or Durations()
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
        seconds = self._durations.draw(order.action, self._dice)
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
