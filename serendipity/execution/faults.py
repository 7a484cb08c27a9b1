"""Robots that fail, take longer or drop out, by dice."""

from collections.abc import Sequence
from dataclasses import dataclass, fields
from random import Random
from typing import Final

from serendipity.execution.world import Outcome
from serendipity.model.errors import UsageError
from serendipity.model.numbers import exact

_LONGEST: Final = 3
"""Epochs that a slow action takes at most beyond its first."""


@dataclass(frozen=True, slots=True)
class Faults:
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

    def __post_init__(self) -> None:
        for field in fields(self):
            object.__setattr__(self, field.name, probability(getattr(self, field.name), field.name))

    @classmethod
    def parse(cls, text: str) -> "Faults":
        """Faults as a command line names them: ``fail=0.1,slow=0.1,drop=0.01``.

        Raises:
            UsageError: it is of another form.
        """
        names = [field.name for field in fields(cls)]
        found: dict[str, float] = {}
        for part in text.replace(" ", "").split(","):
            name, equals, value = part.partition("=")
            if not equals or name not in names or name in found:
                raise UsageError(f"faults: expected some of fail=P,slow=P,drop=P, got '{text}'")
            found[name] = probability(value, name)
        return cls(**found)

    def __bool__(self) -> bool:
        return any((self.fail, self.slow, self.drop))


class Unreliable:
    """An actuator with faults.

    Args:
        faults: how often.
        dice: draws.
    """

    def __init__(self, faults: Faults, dice: Random) -> None:
        self._faults = faults
        self._dice = dice
        self._left: dict[tuple[str, str], int] = {}

    def __call__(self, epoch: int, robots: str, action: str) -> Outcome:
        """See :data:`serendipity.execution.Actuator`."""
        begun = self._left.pop((robots, action), None)
        if begun is None:
            if self._dice.random() < self._faults.fail:
                return "failed"
            begun = self._dice.randint(1, _LONGEST) if self._dice.random() < self._faults.slow else 0
        if begun:
            self._left[robots, action] = begun - 1
            return "running"
        return "done"

    def dropped(self, robots: Sequence[str]) -> list[str]:
        """Those of some robots that drop out now."""
        return [robot for robot in robots if self._dice.random() < self._faults.drop]


def probability(value: float | str, what: str) -> float:
    """A probability.

    Raises:
        UsageError: it is no number from 0 to 1.
    """
    found = exact(value, what)
    if not 0 <= found <= 1:
        raise UsageError(f"{what}: expected a probability from 0 to 1, got {float(found):g}")
    return float(found)
