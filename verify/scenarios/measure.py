"""What is minimised over scenarios (semantics 11), as one number: the objective before the cost."""

from collections.abc import Iterable, Sequence
from fractions import Fraction
from math import lcm
from typing import Final

from verify.calls.call import ExaminedCall
from verify.rules.leftovers import Prices
from verify.scenarios.timelines import Figures

PARTS: Final = 10**9
"""Of probability, to which those are rounded that have more."""


class Measure:
    """The mean, the greatest, or the greatest excess over what each scenario allows by itself.

    Args:
        weights: probabilities; they add up to 1.
        floors: objective and cost that each scenario allows by itself.
        prices: of what each leaves changed.
        plain: for a program: no finer parts, and no costs where no two policies differ in them alone.

    Attributes:
        is_mean: whether what scenarios pay adds up; else the greatest counts.
        shares: by scenario, by how much what it pays is multiplied.
        ahead: by scenario, what it has paid at first, so to say.
        floors: by scenario, what it contributes at least.
        epoch: what an epoch of window adds.
        slack: by how much all together may be off where probabilities are rounded.
    """

    def __init__(
        self,
        calls: Sequence[ExaminedCall],
        weights: Sequence[Fraction],
        floors: Sequence[Figures],
        prices: Sequence[Prices] = (),
        *,
        plain: bool = False,
    ) -> None:
        options, own = calls[0].options, calls[0].prices
        each = [[price * own.scale for _, price in one.values()] for one in prices]
        self._fine = lcm(*(price.denominator for one in each for price in one))
        self.is_mean = options.risk == "mean"
        parts = lcm(*(weight.denominator for weight in weights)) if self.is_mean else 1
        rough = plain and parts > PARTS
        parts = min(parts, PARTS) if plain else parts
        self.shares = [round(weight * parts) if self.is_mean else 1 for weight in weights]
        self._own = self._fine * own.scale
        self._scale = parts * self._own
        dearest = max(own.team, default=0) * len(calls[0].task.agents) * (int(calls[0].horizon) + 1)
        most = dearest + max(map(sum, each), default=0)
        self.slack = len(calls) * calls[0].question.largest if rough else 0
        self._ties = int(not plain or (not rough and 0 < own.epoch <= parts * most))
        self._unit = 4 * parts * (int(most * self._fine) + 1) if self._ties else 1
        self.epoch = own.epoch * self._fine * self._unit
        least = [self._number(floor, self._own) for floor in floors]
        self.ahead = [-floor if options.risk == "regret" else 0 for floor in least]
        shares = zip(self.shares, self.ahead, least, strict=True)
        self.floors = [share * (ahead + floor) for share, ahead, floor in shares]

    def pay(self, units: int) -> int:
        """Units of cost, which count for the objective, too."""
        return units * self._fine * (self._unit + self._ties)

    def price(self, amount: Fraction) -> int:
        """An amount of cost likewise."""
        return int(amount * self._own) * (self._unit + self._ties)

    def joined(self, parts: Iterable[int]) -> int:
        """Contributions together."""
        return sum(parts) if self.is_mean else max(parts)

    def room(self, below: int, parts: Sequence[int], k: int) -> int:
        """What number ``k`` has to be below for all together to be below so much."""
        return below - sum(parts) + parts[k] if self.is_mean else below

    def number(self, figures: Figures) -> int:
        """Objective and cost as one number."""
        return self._number(figures, self._scale)

    def bound(self, objective: Fraction) -> int:
        """Whatever has a lower objective is below this, and nothing else."""
        return -(-objective * self._scale).__floor__() * self._unit - self._unit // 2

    def figures(self, value: int) -> Figures:
        """Objective and cost that a number stands for."""
        objective = (value + self._unit // 2) // self._unit
        return Fraction(objective, self._scale), Fraction(value - objective * self._unit, self._scale)

    def _number(self, figures: Figures, scale: int) -> int:
        return int(figures[0] * scale) * self._unit + self._ties * int(figures[1] * scale)
