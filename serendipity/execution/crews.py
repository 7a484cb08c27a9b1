"""Who carries out what robots do: adapters by name, one for each run."""

from collections.abc import Callable
from dataclasses import dataclass, field
from random import Random
from typing import Final

from serendipity.execution.faults import Faults
from serendipity.model.arguments import shown
from serendipity.model.errors import UsageError
from serendipity.model.numbers import exact
from serendipity.model.task.task import Task
from serendipity.robot import Adapter, Durations, Simulated

ADAPTERS: Final = ("simulated", "pybullet")
"""How they are named."""

Maker = Callable[[Task, Random], Adapter]
"""Makes an adapter for a run: from the task, and dice for what is left to chance."""


@dataclass(frozen=True, slots=True)
class Crew:
    """What makes the adapter of each run.

    Attributes:
        maker: a name, or what makes one; None: whatever is possible is done within the epoch, unless there
            are durations or faults, which robots that are simulated have.
        faults: of simulated robots, and how often any robot drops out.
        durations: of simulated robots.
        epoch_seconds: how long an epoch is for them.

    Raises:
        UsageError: one of them is wrong, or not for this adapter.
    """

    maker: str | Maker | None = None
    faults: Faults = field(default_factory=Faults)
    durations: Durations | None = None
    epoch_seconds: float | None = None

    def __post_init__(self) -> None:
        if not (self.maker is None or self.maker in ADAPTERS or callable(self.maker)):
            raise UsageError(f"adapter: expected one of {', '.join(ADAPTERS)}, got {shown(self.maker)}")
        if self.epoch_seconds is not None:
            seconds = exact(self.epoch_seconds, "epoch_seconds")
            if seconds <= 0:
                raise UsageError(f"epoch_seconds: expected more than 0, got {float(seconds):g}")
            object.__setattr__(self, "epoch_seconds", float(seconds))
        if self.maker not in (None, "simulated"):
            if self.durations is not None:
                raise UsageError("durations: only simulated robots have them")
            if self.faults.fail or self.faults.slow:
                raise UsageError("faults: only simulated robots fail or are slow by dice")

    def adapter(self, task: Task, dice: Random) -> Adapter | None:
        """The adapter of a run; None: whatever is possible is done within the epoch."""
        if callable(self.maker):
            return self.maker(task, dice)
        if self.maker == "pybullet":
            from serendipity.robot.physics import Stage

            return Stage(task, epoch=self.epoch_seconds)
        fail, slow = self.faults.fail, self.faults.slow
        if self.maker is None and not (fail or slow or self.durations or self.epoch_seconds):
            return None
        return Simulated(dice, self.durations, epoch=self.epoch_seconds or 1.0, fail=fail, slow=slow)
