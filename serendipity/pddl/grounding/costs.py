"""Costs of ground actions.

A cost may be missing for arguments that no action ever has, for values are given only where they
make sense (distances between neighbours, say).  So what is wrong with a cost is told only of
actions that can be executed.
"""

from collections.abc import Iterable
from dataclasses import dataclass
from fractions import Fraction
from typing import Final

from serendipity.model import InputError
from serendipity.pddl.grounding.product import Product
from serendipity.pddl.grounding.quantifiers import ground_key
from serendipity.pddl.parsing.lifted import Expression, FunctionValue, Key, Operation, Schema, Unit
from serendipity.pddl.parsing.scope import calculate, cost_fault
from serendipity.pddl.parsing.tree import quoted

ONE: Final = Fraction(1)
NOTHING: Final = Fraction(0)


@dataclass(frozen=True, slots=True)
class BadCost:
    """A fault in the cost of an action."""

    problem: str
    unit: Unit
    line: int

    def error(self, key: Key) -> InputError:
        """The error of the action of that name."""
        return self.unit.domain_error(f"action {quoted(' '.join(key))}: {self.problem}", self.line)


Cost = Fraction | BadCost


class Costs:
    """The costs of ground actions.

    Args:
        values: of function terms.
    """

    def __init__(self, values: dict[Key, Fraction]) -> None:
        self._values = values
        self._bad: dict[tuple[str, str, int], BadCost] = {}

    def of(self, schema: Schema, unit: Unit, product: Product) -> list[Cost]:
        """The costs of the actions of a schema, for some bindings."""
        if not unit.priced:
            return [ONE] * product.size
        increases = schema.increases
        if len(increases) == 1 and isinstance(increases[0], Fraction):
            return [increases[0]] * product.size  # such values were checked where they were read
        if all(isinstance(value, Fraction) for value in increases):
            return [self._sum(increases, {})] * product.size
        return [self._cost(schema, unit, values) for values in product]

    def _cost(self, schema: Schema, unit: Unit, values: dict[str, str]) -> Cost:
        try:
            cost = self._sum(schema.increases, values)
        except ZeroDivisionError:
            problem = "division by zero in its cost"
        except KeyError as missing:
            problem = f"no initial value of {quoted(' '.join(missing.args[0]))} for its cost"
        else:
            fault = cost_fault(cost)
            if fault is None:
                return cost
            problem = fault
        # One object for each problem: there may be very many actions that have it.
        return self._bad.setdefault(
            (problem, unit.domain_file, schema.line), BadCost(problem, unit, schema.line)
        )

    def _sum(self, increases: Iterable[Expression], values: dict[str, str]) -> Fraction:
        return sum([self._value(expression, values) for expression in increases], NOTHING)

    def _value(self, expression: Expression, values: dict[str, str]) -> Fraction:
        match expression:
            case FunctionValue(key):
                return self._values[ground_key(key, values)]
            case Operation(operator, parts):
                return calculate(operator, [self._value(part, values) for part in parts])
        return expression
