"""Operators to ground records: names, fact ids, costs.

Columns of records are built by C loops (``map``, ``zip``, ``itemgetter``): at
100,000 records a Python loop for each would cost seconds.
"""

from collections.abc import Callable, Iterable, Iterator, Sequence
from fractions import Fraction
from itertools import chain, repeat
from typing import Final, NamedTuple

from serendipity.model import InputError
from serendipity.pddl.join import Relations, Row, bindings, picker
from serendipity.pddl.lifted import Expression, Formula, FunctionValue, Key, Literal, Operation, Unit
from serendipity.pddl.normal import (
    MAX_CASES,
    Clause,
    Operator,
    TooManyCasesError,
    clauses,
    conjunction,
    substitute,
)
from serendipity.pddl.resolve import calculate

ONE: Final = Fraction(1)
NOTHING: Final = Fraction(0)

Participants = Callable[[Sequence[Key]], Iterable[tuple[int, ...]]]
"""From ground names ``(name, arguments...)`` to the ids of the agents that take part."""


class Record(NamedTuple):
    """A ground action whose ids are those of a :class:`FactTable`, unsorted."""

    key: Key
    participants: tuple[int, ...]
    pre: tuple[int, ...]
    neg: tuple[int, ...]
    add: tuple[int, ...]
    delete: tuple[int, ...]
    cost: Fraction


class FactTable(dict[Key, int]):
    """Ids of ground atoms, given in the order of first use."""

    def __missing__(self, key: Key) -> int:
        number = len(self)
        self[key] = number
        return number


class Instantiator:
    """Grounds operators over one united initial state."""

    def __init__(self, relations: Relations, values: dict[Key, Fraction]) -> None:
        self.relations = relations
        self.values = values
        self.facts = FactTable()

    def records(self, operator: Operator, unit: Unit, participants: Participants) -> Iterable[Record]:
        """The ground actions of an operator whose static preconditions hold.

        Args:
            operator: the operator.
            unit: the files that it is from; its parameters range over their objects.
            participants: who takes part in the ground actions of given names.

        Raises:
            InputError: a cost is missing or negative, or there are too many cases.
        """
        position, rows = bindings(operator, unit, self.relations)
        if not rows:
            return ()
        columns = _Columns(operator, position, rows, self.facts)
        keys = columns.keys(schema_key(operator))
        fluents = [lit for lit in operator.precondition if lit.key[0] in self.relations.fluent]
        records = map(
            Record,
            keys,
            participants(keys),
            columns.ids([lit.key for lit in fluents if lit.positive]),
            columns.ids([lit.key for lit in fluents if not lit.positive]),
            columns.ids([lit.key for lit in operator.effects if lit.positive]),
            columns.ids([lit.key for lit in operator.effects if not lit.positive]),
            self._costs(operator, unit, columns, keys),
        )
        if not operator.conditional and not operator.choices:
            return records
        return _Cases(operator, unit, columns, self).expanded(records)

    def _costs(
        self, operator: Operator, unit: Unit, columns: "_Columns", keys: Sequence[Key]
    ) -> Iterable[Fraction]:
        increases = operator.schema.increases
        if not unit.priced:
            return repeat(ONE)
        constant = [value for value in increases if isinstance(value, Fraction)]
        if len(constant) == len(increases):
            return repeat(constant[0] if len(constant) == 1 else sum(constant, NOTHING))
        return self._computed_costs(operator, unit, columns, keys)

    def _computed_costs(
        self, operator: Operator, unit: Unit, columns: "_Columns", keys: Sequence[Key]
    ) -> Iterator[Fraction]:
        for i, key in enumerate(keys):
            try:
                cost = sum((self._value(e, columns, i) for e in operator.schema.increases), NOTHING)
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

    def _value(self, expression: Expression, columns: "_Columns", row: int) -> Fraction:
        match expression:
            case FunctionValue(key):
                return self.values[columns.key(key, row)]
            case Operation(operator, left, right):
                return calculate(operator, self._value(left, columns, row), self._value(right, columns, row))
        return expression


class _Columns:
    """Ground atoms of lifted ones, for all rows at once.

    Each row is extended by the operator's constants, predicates among them, so that a
    ground atom is a mere selection from its row.
    """

    def __init__(
        self, operator: Operator, position: dict[str, int], rows: list[Row], facts: FactTable
    ) -> None:
        self.variables = position
        self.position = dict(position)
        self.facts = facts
        for key in _lifted_keys(operator):
            for term in (f"{_HEAD}{key[0]}", *key[1:]):
                self.position.setdefault(term, len(self.position))
        tail = tuple(term.removeprefix(_HEAD) for term in list(self.position)[len(position) :])
        self.rows = [row + tail for row in rows] if position else [tail]

    def key(self, lifted: Key, row: int) -> Key:
        """The ground atom of one row."""
        values = self.rows[row]
        return (lifted[0], *(values[self.position[term]] for term in lifted[1:]))

    def values(self, row: int) -> dict[str, str]:
        """The values of the variables in one row."""
        return dict(zip(self.variables, self.rows[row], strict=False))

    def keys(self, lifted: Key) -> list[Key]:
        """The ground atoms of all rows."""
        head, *terms = lifted
        pick = picker([self.position[f"{_HEAD}{head}"], *(self.position[term] for term in terms)])
        return [pick(row) for row in self.rows]

    def ids(self, lifted: Sequence[Key]) -> Iterable[tuple[int, ...]]:
        """The fact ids of some atoms, as one tuple for each row."""
        if not lifted:
            return repeat(())
        return zip(*[map(self.facts.__getitem__, self.keys(key)) for key in lifted], strict=True)


_HEAD: Final = " "
"""Tells a predicate from an object of the same name among an operator's constants."""


def _lifted_keys(operator: Operator) -> Iterator[Key]:
    """Every atom and function term of an operator, and the name of its actions."""
    yield schema_key(operator)
    for literal in chain(operator.precondition, operator.effects):
        yield literal.key
    for _, literal in operator.conditional:
        yield literal.key
    pending = list(operator.schema.increases)
    while pending:
        match pending.pop():
            case FunctionValue(key):
                yield key
            case Operation(_, left, right):
                pending += (left, right)


def schema_key(operator: Operator) -> Key:
    """The lifted name of an operator's actions: name, declared parameters."""
    return (operator.schema.name, *(p.name for p in operator.schema.parameters))


class _Cases:
    """Ground actions with disjunctive conditions or conditional effects.

    One record for each disjunct of the condition, and for each combination of truths
    of the effects' conditions.
    """

    def __init__(self, operator: Operator, unit: Unit, columns: _Columns, instantiator: Instantiator) -> None:
        self.operator = operator
        self.unit = unit
        self.columns = columns
        self.relations = instantiator.relations
        self.facts = instantiator.facts

    def expanded(self, records: Iterable[Record]) -> Iterator[Record]:
        for row, record in enumerate(records):
            try:
                yield from self._cases(record, row)
            except TooManyCasesError:
                raise self._error(record, "conditions") from None

    def _cases(self, record: Record, row: int) -> list[Record]:
        choices = conjunction(self._clauses(choice, row) for choice in self.operator.choices)
        cases = [case for choice in choices if (case := self._with(record, choice)) is not None]
        effects: dict[Clause, list[Literal]] = {}
        for condition, literal in self.operator.conditional:
            ground = Literal(self.columns.key(literal.key, row), literal.positive)
            for clause in self._clauses(condition, row):
                effects.setdefault(clause, []).append(ground)
        for clause, literals in effects.items():
            cases = [new for case in cases for new in self._split(case, clause, literals)]
            if len(cases) > MAX_CASES:
                raise self._error(record, "conditional effects")
        return cases

    def _clauses(self, formula: Formula, row: int) -> list[Clause]:
        return clauses(substitute(formula, self.columns.values(row)), self.unit, self.relations.decide)

    def _with(self, record: Record, clause: Clause) -> Record | None:
        case: Record | None = record
        for literal in sorted(clause):
            case = None if case is None else _assume(case, self.facts[literal.key], literal.positive)
        return case

    def _split(self, case: Record, clause: Clause, then: Iterable[Literal]) -> Iterator[Record]:
        """The condition false at its first literal, at its second, ..., or true."""
        for literal in sorted(clause):
            fact = self.facts[literal.key]
            otherwise = _assume(case, fact, not literal.positive)
            if otherwise is not None:
                yield otherwise
            known = _assume(case, fact, literal.positive)
            if known is None:
                return
            case = known
        add = tuple([self.facts[literal.key] for literal in then if literal.positive])
        delete = tuple([self.facts[literal.key] for literal in then if not literal.positive])
        yield case._replace(add=case.add + add, delete=case.delete + delete)

    def _error(self, record: Record, what: str) -> InputError:
        message = (
            f"action '{' '.join(record.key)}': more than {MAX_CASES} cases of its {what} are not supported"
        )
        return self.unit.domain_error(message, self.operator.schema.line)


def _assume(record: Record, fact: int, truth: bool) -> Record | None:
    """The record with one more precondition, or None where it contradicts the others."""
    if fact in (record.neg if truth else record.pre):
        return None
    if fact in (record.pre if truth else record.neg):
        return record
    return record._replace(pre=(*record.pre, fact)) if truth else record._replace(neg=(*record.neg, fact))
