"""Operators to ground actions: names, fact ids, costs.

Columns of them are built by C loops (``map``, ``zip``): at 100,000 actions a Python loop
for each would cost seconds.
"""

from collections import defaultdict
from collections.abc import Callable, Iterable, Iterator, Sequence
from fractions import Fraction
from itertools import chain, count
from typing import Final

from serendipity.pddl.blocks import Block, Column, Ids, Record, block_of
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
        self._blocks: list[Block] = []
        self._records: list[Record] = []

    def ground(self, operator: Operator, unit: Unit, participants: Participants) -> None:
        """Make the ground actions of an operator whose static preconditions hold.

        Args:
            operator: the operator.
            unit: the files that it is from; its parameters range over their objects.
            participants: who takes part in the ground actions of given names.

        Raises:
            InputError: a cost is missing or negative, or there are too many cases.
        """
        product = bindings(operator, unit, self.relations)
        if not product.size:
            return
        records: Iterable[Record]
        if product.everything:
            block = self._block(operator, unit, participants, product)
            if not operator.conditional and not operator.choices:
                self._blocks.append(block)
                return
            records = block.records()
        else:  # in files that are ground already, there is nothing else
            records = [self._record(operator, unit, participants, product)]
        if operator.conditional or operator.choices:
            cases = Cases(operator, unit, self.relations, self.facts)
            records = cases.expanded(records, product)
        self._records += records

    def blocks(self) -> list[Block]:
        """All ground actions so far."""
        return [*self._blocks, block_of(self._records)]

    def _block(self, operator: Operator, unit: Unit, participants: Participants, product: Product) -> Block:
        atoms = _Atoms(product, self.facts)
        keys = atoms.of(schema_key(operator), product.everything)
        pre, neg, add, delete = map(atoms.column, self._conditions(operator))
        who = [*participants(keys)]
        return Block(keys, who, pre, neg, add, delete, self._costs(operator, unit, product, keys))

    def _record(self, operator: Operator, unit: Unit, participants: Participants, product: Product) -> Record:
        (values,) = product
        key = ground_key(schema_key(operator), values)
        pre, neg, add, delete = (
            tuple([self.facts[ground_key(atom, values)] for atom in atoms])
            for atoms in self._conditions(operator)
        )
        (who,) = participants([key])
        (cost,) = self._costs(operator, unit, product, [key])
        return Record(key, who, pre, neg, add, delete, cost)

    def _conditions(self, operator: Operator) -> tuple[list[Key], list[Key], list[Key], list[Key]]:
        """The lifted atoms that must be true, must be false, become true, become false."""
        fluent = self.relations.fluent
        needs = [literal for literal in operator.precondition if literal.key[0] in fluent]
        return (
            [literal.key for literal in needs if literal.positive],
            [literal.key for literal in needs if not literal.positive],
            [literal.key for literal in operator.effects if literal.positive],
            [literal.key for literal in operator.effects if not literal.positive],
        )

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
