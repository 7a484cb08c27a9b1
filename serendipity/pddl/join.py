"""Bindings of an operator's variables, by joining over relations that can't grow.

A precondition that no action ever makes true holds only for atoms of the initial
state, so those atoms are joined like tables of a database; variables that no such
precondition binds range over the objects of their type.
"""

from collections.abc import Callable, Iterable, Sequence
from math import prod
from operator import itemgetter
from typing import Any, Final

from serendipity.model import InputError
from serendipity.pddl.lifted import EQUALITY, Key, Literal, Unit
from serendipity.pddl.normal import Operator
from serendipity.pddl.product import Product, Row, Table, united

MAX_ROWS: Final = 5_000_000
"""The most ground actions of one operator, some gigabytes of them."""


def picker(positions: Sequence[int]) -> Callable[[Any], tuple[Any, ...]]:
    """A function from a row to the tuple of its values at some positions."""
    if not positions:
        return lambda _: ()
    if len(positions) == 1:
        only = positions[0]
        return lambda row: (row[only],)
    return itemgetter(*positions)


class Relations:
    """The atoms of the united initial state, by predicate.

    Args:
        init: the atoms.
        fluent: predicates that some action adds or deletes.
        added: predicates that some action adds.
    """

    def __init__(self, init: Iterable[Key], fluent: frozenset[str], added: frozenset[str]) -> None:
        self.init = frozenset(init)
        self.fluent = fluent
        self.added = added
        self._tables: dict[str, list[Key]] = {}
        for key in self.init:
            self._tables.setdefault(key[0], []).append(key)

    def table(self, predicate: str) -> list[Key]:
        """The atoms of a predicate."""
        return self._tables.get(predicate, [])

    def joined(self, literal: Literal) -> bool:
        """Whether a precondition holds only for atoms that hold initially."""
        return literal.positive and literal.key[0] not in self.added and literal.key[0] != EQUALITY

    def filtered(self, literal: Literal) -> bool:
        """Whether a precondition is decided by its arguments alone, once they are bound."""
        return literal.key[0] == EQUALITY or (not literal.positive and literal.key[0] not in self.fluent)

    def holds(self, literal: Literal, key: Key) -> bool:
        """The truth of a static literal or an equality whose ground atom is ``key``."""
        truth = key[1] == key[2] if key[0] == EQUALITY else key in self.init
        return truth == literal.positive

    def decide(self, literal: Literal) -> bool | None:
        """The truth of a ground literal if it is the same in every state, else None."""
        predicate = literal.key[0]
        if predicate in self.fluent:
            return None
        return self.holds(literal, literal.key)


def bindings(operator: Operator, unit: Unit, relations: Relations) -> Product:
    """All bindings under which the preconditions that can't change hold."""
    return _Join(operator, unit, relations).run()


class _Join:
    def __init__(self, operator: Operator, unit: Unit, relations: Relations) -> None:
        self.relations = relations
        self.unit = unit
        self.schema = operator.schema
        self.parameters = operator.parameters
        self.domains = {p.name: dict.fromkeys(unit.objects_of(p.type)) for p in operator.parameters}
        self.joins = [lit for lit in operator.precondition if relations.joined(lit)]
        self.filters = [lit for lit in operator.precondition if relations.filtered(lit)]
        self.bound: set[str] = set()
        self.tables: list[Table] = []

    def run(self) -> Product:
        self._filter()
        while self.joins and self._size():
            self._join(self._next())
            self._filter()
        for parameter in self.parameters:
            if parameter.name not in self.bound:
                values: list[Row] = [(value,) for value in self.domains[parameter.name]]
                if self._size() * len(values) > MAX_ROWS:
                    raise self._too_many()
                self._add(Table((parameter.name,), values))
                self._filter()
        return Product(self.tables)

    def _size(self) -> int:
        return prod(len(table.rows) for table in self.tables)

    def _add(self, table: Table) -> None:
        self.tables.append(table)
        self.bound.update(table.variables)

    def _taken(self, terms: Sequence[str]) -> Table:
        """The tables that some terms are in, taken out and made one."""
        taken: list[Table] = []
        kept: list[Table] = []
        for table in self.tables:
            (kept if set(terms).isdisjoint(table.variables) else taken).append(table)
        self.tables = kept
        return united(taken)

    def _too_many(self) -> InputError:
        schema = self.schema
        message = f"action '{schema.name}': more than {MAX_ROWS} ground actions are not supported"
        return self.unit.domain_error(message, schema.line)

    def _next(self) -> Key:
        """The join that grows the rows least, as far as sizes tell."""

        def growth(literal: Literal) -> tuple[bool, int]:
            terms = literal.key[1:]
            bound = sum(term in self.bound or term[0] != "?" for term in terms)
            size = len(self.relations.table(literal.key[0])) if bound < len(terms) else 0
            return bound == 0 and len(terms) > 0, size

        chosen = min(self.joins, key=growth)
        self.joins.remove(chosen)
        return chosen.key

    def _join(self, pattern: Key) -> None:
        table = self._taken(pattern[1:])
        old: list[int] = []  # positions in the atom that the row or a constant decides
        source: list[int] = []
        fixed: list[tuple[int, str]] = []
        same: list[tuple[int, int]] = []
        new: dict[str, int] = {}
        for i, term in enumerate(pattern[1:], start=1):
            if term[0] != "?":
                fixed.append((i, term))
            elif term in table.variables:
                old.append(i)
                source.append(table.variables.index(term))
            elif term in new:
                same.append((i, new[term]))
            else:
                new[term] = i
        before, after = picker(old), picker(tuple(new.values()))
        checks = [(i, self.domains[term]) for term, i in new.items()]
        index: dict[Row, list[Row]] = {}
        for atom in self.relations.table(pattern[0]):
            if (
                all(atom[i] in domain for i, domain in checks)
                and all(atom[i] == value for i, value in fixed)
                and all(atom[i] == atom[j] for i, j in same)
            ):
                index.setdefault(before(atom), []).append(after(atom))
        look_up = picker(source)
        rows = [row + more for row in table.rows for more in index.get(look_up(row), ())]
        self._add(Table((*table.variables, *new), rows))

    def _filter(self) -> None:
        """Apply the filters whose variables are all bound by now."""
        for literal in list(self.filters):
            terms = literal.key[1:]
            if all(term[0] != "?" or term in self.bound for term in terms):
                self.filters.remove(literal)
                variables, rows = self._taken(terms)
                places = [(variables.index(term) if term in variables else -1, term) for term in terms]
                self._add(Table(variables, [row for row in rows if self._passes(literal, row, places)]))

    def _passes(self, literal: Literal, row: Row, places: list[tuple[int, str]]) -> bool:
        key = (literal.key[0], *(row[i] if i >= 0 else term for i, term in places))
        return self.relations.holds(literal, key)
