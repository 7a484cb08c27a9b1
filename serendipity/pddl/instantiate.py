"""Operators to ground actions: names, fact ids, costs.

Columns of them are built by C loops (``map``, ``zip``): at 100,000 actions a Python loop
for each would cost seconds.
"""

from collections import defaultdict
from collections.abc import Callable, Iterable, Iterator, Sequence
from fractions import Fraction
from itertools import chain, count
from typing import Final

from serendipity.pddl.blocks import Block, Column, Ids, block_of
from serendipity.pddl.cases import Cases
from serendipity.pddl.join import Relations, bindings
from serendipity.pddl.lifted import Expression, FunctionValue, Key, Operation, Unit
from serendipity.pddl.normal import Operator, ground_key
from serendipity.pddl.product import Product
from serendipity.pddl.resolve import calculate

ONE: Final = Fraction(1)
NOTHING: Final = Fraction(0)

Participants = Callable[[Sequence[Key]], Iterable[tuple[int, ...]]]
"""From ground names ``(name, arguments...)`` to the ids of the agents that take part."""


class Instantiator:
    """Grounds operators over one united initial state.

    Attributes:
        facts: ids of the ground atoms so far, in the order of first use.
    """

    def __init__(self, relations: Relations, values: dict[Key, Fraction]) -> None:
        self.relations = relations
        self.values = values
        self.facts: defaultdict[Key, int] = defaultdict(count().__next__)

    def block(self, operator: Operator, unit: Unit, participants: Participants) -> Block | None:
        """The ground actions of an operator whose static preconditions hold; None if there are none.

        Args:
            operator: the operator.
            unit: the files that it is from; its parameters range over their objects.
            participants: who takes part in the ground actions of given names.

        Raises:
            InputError: a cost is missing or negative, or there are too many cases.
        """
        product = bindings(operator, unit, self.relations)
        if not product.size:
            return None
        atoms = _Atoms(product, self.facts)
        keys = atoms.of(schema_key(operator), product.everything)
        fluents = [lit for lit in operator.precondition if lit.key[0] in self.relations.fluent]
        block = Block(
            keys,
            list(participants(keys)),
            atoms.column([lit.key for lit in fluents if lit.positive]),
            atoms.column([lit.key for lit in fluents if not lit.positive]),
            atoms.column([lit.key for lit in operator.effects if lit.positive]),
            atoms.column([lit.key for lit in operator.effects if not lit.positive]),
            self._costs(operator, unit, product, keys),
        )
        if not operator.conditional and not operator.choices:
            return block
        cases = Cases(operator, unit, self.relations, self.facts)
        return block_of([*cases.expanded(block.records(), product)])

    def _costs(self, operator: Operator, unit: Unit, product: Product, keys: Sequence[Key]) -> list[Fraction]:
        increases = operator.schema.increases
        if not unit.priced:
            return [ONE] * len(keys)
        constant = [value for value in increases if isinstance(value, Fraction)]
        if len(constant) == len(increases):
            return [constant[0] if len(constant) == 1 else sum(constant, NOTHING)] * len(keys)
        return list(self._computed_costs(operator, unit, product, keys))

    def _computed_costs(
        self, operator: Operator, unit: Unit, product: Product, keys: Sequence[Key]
    ) -> Iterator[Fraction]:
        for key, values in zip(keys, product, strict=True):
            try:
                cost = sum((self._value(e, values) for e in operator.schema.increases), NOTHING)
            except ZeroDivisionError:
                message = f"action '{' '.join(key)}': division by zero in its cost"
                raise unit.domain_error(message, operator.schema.line) from None
            except KeyError as missing:
                function = " ".join(missing.args[0])
                message = f"action '{' '.join(key)}': no initial value of '{function}' for its cost"
                raise unit.domain_error(message, operator.schema.line) from None
            if cost < 0:
                message = f"action '{' '.join(key)}': expected a cost of at least 0, got {float(cost):g}"
                raise unit.domain_error(message, operator.schema.line)
            yield cost

    def _value(self, expression: Expression, values: dict[str, str]) -> Fraction:
        match expression:
            case FunctionValue(key):
                return self.values[ground_key(key, values)]
            case Operation(operator, left, right):
                return calculate(operator, self._value(left, values), self._value(right, values))
        return expression


class _Atoms:
    """Ground atoms of lifted ones, for all bindings at once."""

    def __init__(self, product: Product, facts: dict[Key, int]) -> None:
        self.product = product
        self.facts = facts
        self._ids: dict[Key, list[int]] = {}

    def of(self, lifted: Key, part: tuple[int, ...]) -> list[Key]:
        """The ground atoms of one atom, for each binding of the part that it depends on."""
        head, *terms = lifted
        columns = [self.product.column(term, part) for term in (head, *terms)]
        return list(zip(*columns, strict=True))

    def column(self, lifted: Sequence[Key]) -> Column:
        """The fact ids of some atoms."""
        part = self.product.part(chain.from_iterable(lifted))
        spread = [self._spread(key, part) for key in lifted]
        table: list[Ids] = [*zip(*spread, strict=True)] if lifted else [()]
        return Column(table, self.product.index(part, self.product.everything))

    def _spread(self, key: Key, whole: tuple[int, ...]) -> Iterator[int]:
        part = self.product.part(key)
        ids = self._ids.get(key)
        if ids is None:
            ids = self._ids[key] = [*map(self.facts.__getitem__, self.of(key, part))]
        return map(ids.__getitem__, self.product.index(part, whole))


def schema_key(operator: Operator) -> Key:
    """The lifted name of an operator's actions: name, declared parameters."""
    return (operator.schema.name, *(p.name for p in operator.schema.parameters))
