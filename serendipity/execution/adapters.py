"""What carries out what robots do in a run, by name, and how unreliable they are."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from random import Random
from typing import Final

from serendipity.model import Task, UsageError, exact
from serendipity.model.arguments import Kind, expect_or_none
from serendipity.model.keywords import require_one_of
from serendipity.model.rates import Rates
from serendipity.robot import Adapter, Durations, Simulated


@dataclass(frozen=True, slots=True)
class Faults(Rates):
    """How unreliable robots are; each is a probability.

    Attributes:
        fail: that an action fails.
        slow: that an action takes one to three epochs longer.
        drop: that a robot drops out for good, in each epoch.

    Raises:
        UsageError: one of them is no probability.
    """

    fail: float = 0.0
    slow: float = 0.0
    drop: float = 0.0

    def dropped(self, robots: Sequence[str], dice: Random) -> list[str]:
        """Those of some robots that drop out now."""
        return [robot for robot in robots if dice.random() < self.drop] if self.drop else []


ADAPTERS: Final = ("simulated", "pybullet")
"""How they are named."""

Maker = Callable[[Task, Random], Adapter]
"""Makes an adapter for a run: from the task, and dice for what is left to chance."""


class AdapterChoice:
    """The adapters of some runs, each made when its run begins.

    Args:
        maker: a name, or what makes one; None: whatever is possible is done within the epoch, unless there
            are durations or faults, which robots that are simulated have.
        faults: of simulated robots, and how often any robot drops out; also as a text.
        durations: of simulated robots; also as a text.
        epoch_seconds: how long an epoch is for them.

    Attributes:
        faults: as given; none by default.

    Raises:
        UsageError: one of them is wrong, or not for this adapter.
    """

    def __init__(
        self,
        maker: str | Maker | None,
        faults: Faults | str | None,
        durations: Durations | str | None,
        epoch_seconds: float | None,
    ) -> None:
        wrong = Faults.parse(faults) if isinstance(faults, str) else faults
        given = Durations.parse(durations) if isinstance(durations, str) else durations
        expect_or_none(Kind("Faults, or a text", lambda value: isinstance(value, Faults)), faults=wrong)
        expect_or_none(Kind("Durations, or a text", lambda v: isinstance(v, Durations)), durations=given)
        if maker is not None and not callable(maker):
            require_one_of("adapter", maker, ADAPTERS)
        seconds = None if epoch_seconds is None else float(exact(epoch_seconds, "epoch_seconds"))
        if seconds is not None and seconds <= 0:
            raise UsageError(f"epoch_seconds: expected more than 0, got {seconds:g}")
        self.faults = wrong or Faults()
        self._maker, self._durations, self._seconds = maker, given, seconds
        self._by_dice = bool(self.faults.fail or self.faults.slow)
        if maker not in (None, "simulated"):
            if given is not None:
                raise UsageError("durations: only simulated robots have them")
            if self._by_dice:
                raise UsageError("faults: only simulated robots fail or are slow by dice")

    @property
    def surely(self) -> bool:
        """Whether robots manage within the epoch whatever is possible: there is no adapter then."""
        return self._maker is None and not (self._by_dice or self._durations or self._seconds)

    def adapter(self, task: Task, dice: Random) -> Adapter | None:
        """The adapter of a run, if there is one."""
        if callable(self._maker):
            return self._maker(task, dice)
        if self._maker == "pybullet":
            from serendipity.robot.physics import Stage

            return Stage(task, epoch=self._seconds)
        if self.surely:
            return None
        fail, slow = self.faults.fail, self.faults.slow
        return Simulated(dice, self._durations, epoch=self._seconds or 1.0, fail=fail, slow=slow)
