"""Costs and durations of ground actions.

A cost may be missing for arguments that no action ever has, for values are given only where they
make sense (distances between neighbours, say).  So what is wrong with a cost is told only of
actions that can be executed.
"""

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from fractions import Fraction
from typing import Final

from serendipity.model import InputError
from serendipity.pddl.grounding.product import Product
from serendipity.pddl.grounding.quantifiers import ground_key
from serendipity.pddl.parsing import lifted
from serendipity.pddl.parsing.scope import calculate, cost_fault
from serendipity.pddl.parsing.tree import quoted

ONE: Final = Fraction(1)
NOTHING: Final = Fraction(0)


@dataclass(frozen=True, slots=True)
class BadCost:
    """A fault in the cost or duration of an action."""

    problem: str
    unit: lifted.Unit
    line: int

    def error(self, key: lifted.Key) -> InputError:
        """The error of the action of that name."""
        return self.unit.domain_error(f"action {quoted(' '.join(key))}: {self.problem}", self.line)


Cost = Fraction | BadCost


class Costs:
    """The costs and durations of ground actions."""

    def __init__(self, values: dict[lifted.Key, Fraction]) -> None:
        self._values = values
        self._bad: dict[tuple[str, str, int], BadCost] = {}

    def of(self, schema: lifted.Schema, unit: lifted.Unit, product: Product) -> list[Cost]:
        """The costs of the actions of a schema, for some bindings."""
        if not unit.priced:
            return [ONE] * product.size if schema.course is None else self.durations(schema, unit, product)
        increases = schema.increases
        if len(increases) == 1 and isinstance(increases[0], Fraction):
            return [increases[0]] * product.size  # such values were checked where they were read
        if all(isinstance(value, Fraction) for value in increases):
            return [self._sum(increases, {})] * product.size
        return [self._cost(schema, unit, values) for values in product]

    def durations(self, schema: lifted.Schema, unit: lifted.Unit, product: Product) -> list[Cost]:
        """The least durations of the actions of a durative schema, for some bindings."""
        course = schema.course
        assert course is not None, "only durative actions have durations"
        if all(isinstance(value, Fraction) for value in (*course.least, *course.most)):
            return [self._duration(schema, course, unit, {})] * product.size
        return [self._duration(schema, course, unit, values) for values in product]

    def _cost(self, schema: lifted.Schema, unit: lifted.Unit, values: dict[str, str]) -> Cost:
        return self._checked("cost", lambda: self._sum(schema.increases, values), cost_fault, schema, unit)

    def _duration(
        self, schema: lifted.Schema, course: lifted.DurativeParts, unit: lifted.Unit, values: dict[str, str]
    ) -> Cost:
        def fault(duration: Fraction) -> str | None:
            most = min([self._value(value, values) for value in course.most], default=duration)
            if most < duration:
                return f"expected a duration of at least {float(duration):g}, and of at most {float(most):g}"
            if duration <= 0:
                return f"expected a duration above 0, got {float(duration):g}"
            return None if cost_fault(duration) is None else "expected a duration of fewer digits"

        return self._checked(
            "duration", lambda: max(self._value(value, values) for value in course.least), fault, schema, unit
        )

    def _checked(
        self,
        what: str,
        calculated: Callable[[], Fraction],
        fault_of: Callable[[Fraction], str | None],
        schema: lifted.Schema,
        unit: lifted.Unit,
    ) -> Cost:
        """A value, or what is wrong with it."""
        try:
            value = calculated()
            fault = fault_of(value)
        except ZeroDivisionError:
            problem = f"division by zero in its {what}"
        except KeyError as missing:
            problem = f"no initial value of {quoted(' '.join(missing.args[0]))} for its {what}"
        else:
            if fault is None:
                return value
            problem = fault
        # One object for each problem: there may be very many actions that have it.
        return self._bad.setdefault(
            (problem, unit.domain_file, schema.line), BadCost(problem, unit, schema.line)
        )

    def _sum(self, increases: Iterable[lifted.Expression], values: dict[str, str]) -> Fraction:
        return sum([self._value(expression, values) for expression in increases], NOTHING)

    def _value(self, expression: lifted.Expression, values: dict[str, str]) -> Fraction:
        match expression:
            case lifted.FunctionValue(key):
                return self._values[ground_key(key, values)]
            case lifted.Operation(operator, parts):
                return calculate(operator, [self._value(part, values) for part in parts])
        return expression
