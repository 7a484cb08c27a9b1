"""Robots that need time and fail by dice, and have no bodies."""

from collections.abc import Sequence
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
        self._begun = {order: self._begun.get(order) or self._begin(order) for order in epoch.orders}
        reports = [deed.go_on(self._epoch) for deed in self._begun.values()]
        over = [o for o, report in zip(self._begun, reports, strict=True) if report.outcome != "running"]
        for order in over:
            del self._begun[order]
        return reports

    def close(self) -> None:
        """See :class:`serendipity.robot.Adapter`."""

    def _begin(self, order: Order) -> "_Deed":
        seconds = self._durations.draw(order.action, self._dice)
        if self._dice.random() < self._slow:
            seconds += self._epoch * self._dice.randint(1, _LONGEST)
        return _Deed(seconds, fails=self._dice.random() < self._fail)


class _Deed:
    """An action that was begun.

    Args:
        seconds: that it takes.
        fails: whether it fails in the end.
    """

    def __init__(self, seconds: float, *, fails: bool) -> None:
        self._seconds = seconds
        self._fails = fails
        self._spent = 0.0

    def go_on(self, seconds: float) -> Report:
        """Spend some more time on it."""
        self._spent = min(self._seconds, self._spent + seconds)
        if self._spent < self._seconds:
            return Report("running", self._spent)
        return Report("failed" if self._fails else "done", self._spent)
