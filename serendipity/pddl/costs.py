"""What ground actions cost.

A cost may be missing for arguments that no action ever has, for values are given only where they
make sense (distances between neighbours, say).  So what is wrong with a cost is told only of
actions that can be executed.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import Final

from serendipity.model import InputError
from serendipity.pddl.lifted import Expression, FunctionValue, Key, Operation, Schema, Unit
from serendipity.pddl.product import Product
from serendipity.pddl.quantifiers import ground_key
from serendipity.pddl.scope import calculate
from serendipity.pddl.tree import quoted

ONE: Final = Fraction(1)
NOTHING: Final = Fraction(0)


@dataclass(frozen=True, slots=True)
class BadCost:
    """What is wrong with the cost of an action."""

    problem: str
    unit: Unit
    line: int

    def error(self, key: Key) -> InputError:
        """The error of the action of that name."""
        return self.unit.domain_error(f"action {quoted(' '.join(key))}: {self.problem}", self.line)


Cost = Fraction | BadCost


class Costs:
    """The costs of the actions of one schema.

    Args:
        schema: the action.
        unit: its files.
        values: of function terms.
    """

    def __init__(self, schema: Schema, unit: Unit, values: dict[Key, Fraction]) -> None:
        self._unit = unit
        self._line = schema.line
        self._values = values
        self._bad: dict[str, BadCost] = {}
        self._constant: Fraction | None = ONE if not unit.priced else _sum(schema.increases)
        self._increases = schema.increases

    def of(self, product: Product) -> list[Cost]:
        """The costs for some bindings."""
        if self._constant is not None:
            return [self._constant] * product.size
        return [self._one(values) for values in product]

    def _one(self, values: dict[str, str]) -> Cost:
        try:
            cost = sum([self._value(e, values) for e in self._increases], NOTHING)
        except ZeroDivisionError:
            return self._told("division by zero in its cost")
        except KeyError as missing:
            return self._told(f"no initial value of {quoted(' '.join(missing.args[0]))} for its cost")
        if cost < 0:
            return self._told(f"expected a cost of at least 0, got {float(cost):g}")
        return cost

    def _told(self, problem: str) -> BadCost:
        """One object for each problem: there may be very many actions that have it."""
        return self._bad.setdefault(problem, BadCost(problem, self._unit, self._line))

    def _value(self, expression: Expression, values: dict[str, str]) -> Fraction:
        match expression:
            case FunctionValue(key):
                return self._values[ground_key(key, values)]
            case Operation(operator, left, right):
                return calculate(operator, self._value(left, values), self._value(right, values))
        return expression


def _sum(increases: Sequence[Expression]) -> Fraction | None:
    """The sum of constant costs; None if one depends on arguments."""
    constant = [value for value in increases if isinstance(value, Fraction)]
    if len(constant) < len(increases):
        return None
    return constant[0] if len(constant) == 1 else sum(constant, NOTHING)
