"""How often robots fail, take longer or drop out."""

from collections.abc import Sequence
from dataclasses import dataclass, fields
from random import Random

from serendipity.model.errors import UsageError
from serendipity.model.numbers import exact


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

    def dropped(self, robots: Sequence[str], dice: Random) -> list[str]:
        """Those of some robots that drop out now."""
        return [robot for robot in robots if dice.random() < self.drop] if self.drop else []


def probability(value: float | str, what: str) -> float:
    """A probability.

    Raises:
        UsageError: it is no number from 0 to 1.
    """
    found = exact(value, what)
    if not 0 <= found <= 1:
        raise UsageError(f"{what}: expected a probability from 0 to 1, got {float(found):g}")
    return float(found)
