"""Numbers that costs and durations depend on."""

from fractions import Fraction
from typing import Final

from unified_planning.model import FNode

from serendipity.pddl.parsing import lifted
from serendipity_up.conditions import Reader

_OPERATORS: Final = (("is_plus", "+"), ("is_minus", "-"), ("is_times", "*"), ("is_div", "/"))


def number_of(reader: Reader, node: FNode, what: str) -> lifted.Expression:
    """A number, or what it is calculated from, which errors call ``what``."""
    if node.is_constant():
        return Fraction(node.constant_value())
    if node.is_fluent_exp():
        terms = (reader.term(argument, {}) for argument in node.args)
        return lifted.FunctionValue((node.fluent().name, *(word for term in terms for word in term.words)))
    for test, operator in _OPERATORS:
        if getattr(node, test)():
            return lifted.Operation(operator, tuple(number_of(reader, part, what) for part in node.args))
    raise reader.error(f"'{node}' is not supported as {what}")
