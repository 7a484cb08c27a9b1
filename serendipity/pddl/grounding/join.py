"""Bindings of a lifted action's variables, by joining over relations that can't grow.

A precondition that no action ever makes true holds only for atoms of the initial
state, so those atoms are joined like tables of a database; variables that no such
precondition binds range over the objects of their type.
"""

from collections.abc import Callable, Iterable, Sequence
from math import prod
from operator import itemgetter
from typing import Any, Final

from serendipity.pddl.grounding.normal import Disjuncts, Lifted
from serendipity.pddl.grounding.product import Bindings, Product, Row, combined
from serendipity.pddl.grounding.quantifiers import literals, substitute, variables
from serendipity.pddl.parsing.lifted import EQUALITY, Formula, Key, Literal, Unit
from serendipity.pddl.work import Work, about

_MANY: Final = 100_000
"""Rows of a table that memory is asked for before they are made."""

_BYTES: Final = (72, 8)
"""Of a row, and of each value in it, measured."""


def picker(positions: Sequence[int]) -> Callable[[Any], tuple[Any, ...]]:
    """A function from a row to the tuple of its values at some positions."""
    if not positions:
        return lambda _: ()
    if len(positions) == 1:
        only = positions[0]
        return lambda row: (row[only],)
    return itemgetter(*positions)


class Relations:
    """Atoms of the united initial state by predicate, of which actions change the ``fluent`` ones."""

    def __init__(self, init: Iterable[Key], fluent: frozenset[str], added: frozenset[str]) -> None:
        self.init = dict.fromkeys(init)  # in this order, so that what is made of it is in one order, too
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

    def static(self, formula: Formula) -> bool:
        """Whether a condition is decided by its arguments alone."""
        return self.fluent.isdisjoint([literal.key[0] for literal in literals(formula)])

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


def bindings(
    lifted: Lifted,
    unit: Unit,
    relations: Relations,
    work: Work,
    actors: frozenset[str] | None = None,
) -> Product:
    """All bindings under which the preconditions that can't change hold.

    Args:
        actors: what the first parameter may be; None means all that its type allows.
    """
    join = _Join(lifted, unit, relations, work)
    if actors is not None:
        join.restrict(lifted.parameters[0].name, actors)
    return join.run()


class _Join:
    def __init__(self, lifted: Lifted, unit: Unit, relations: Relations, work: Work) -> None:
        self.relations = relations
        self.work = work
        self.unit = unit
        self.schema = lifted.schema
        self.domains = {p.name: dict.fromkeys(unit.objects_of(p.type)) for p in lifted.parameters}
        self.joins = [lit for lit in lifted.needs if relations.joined(lit)]
        self.filters: list[Formula] = [lit for lit in lifted.needs if relations.filtered(lit)]
        if lifted.choices:
            self.filters += [choice for choice in lifted.choices if relations.static(choice)]
        self.bound: set[str] = set()
        self.tables: list[Bindings] = []

    def restrict(self, name: str, values: frozenset[str]) -> None:
        """Let a variable be these values at most."""
        self.domains[name] = {value: None for value in self.domains[name] if value in values}

    def run(self) -> Product:
        self._filter()
        while self.joins and self._size():
            self._join(self._next())
            self._filter()
        for name, domain in self.domains.items():
            if name not in self.bound:
                self._add(Bindings((name,), [(value,) for value in domain]))
                self._filter()
        return Product(self.tables)

    def _size(self) -> int:
        return prod(len(table.rows) for table in self.tables)

    def _add(self, table: Bindings) -> None:
        self.tables.append(table)
        self.bound.update(table.variables)

    def _taken(self, terms: Iterable[str]) -> tuple[tuple[str, ...], Iterable[Row]]:
        """The tables that some terms are in, taken out and combined."""
        wanted = frozenset(terms)
        taken = [table for table in self.tables if not wanted.isdisjoint(table.variables)]
        self.tables = [table for table in self.tables if wanted.isdisjoint(table.variables)]
        width = sum(len(table.variables) for table in taken)
        if len(taken) > 1:
            self._require(prod(len(table.rows) for table in taken), width)
        names, rows = combined(taken)
        return names, self.work.deadline.each(rows)

    def _require(self, rows: int, width: int) -> None:
        if rows > _MANY:
            fixed, each = _BYTES
            what = f"reading {self.unit.place(self.schema)} comes to {about(rows)} bindings"
            self.work.require(rows * (fixed + each * width), what)

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
        names, rows = self._taken(pattern[1:])
        table = Bindings(names, list(rows))
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
        for atom in self.work.deadline.each(self.relations.table(pattern[0])):
            if (
                all(atom[i] in domain for i, domain in checks)
                and all(atom[i] == value for i, value in fixed)
                and all(atom[i] == atom[j] for i, j in same)
            ):
                index.setdefault(before(atom), []).append(after(atom))
        self._add(self._looked_up(table, picker(source), index, tuple(new)))

    def _looked_up(
        self,
        table: Bindings,
        look_up: Callable[[Row], Row],
        index: dict[Row, list[Row]],
        new: tuple[str, ...],
    ) -> Bindings:
        """The rows of a table, each with all that an index has for it."""
        polled = self.work.deadline.each
        if len(table.rows) * max(map(len, index.values()), default=0) > _MANY:
            number = sum(len(index.get(look_up(row), ())) for row in polled(table.rows))
            self._require(number, len(table.variables) + len(new))
        rows = (row + more for row in polled(table.rows) for more in index.get(look_up(row), ()))
        return Bindings((*table.variables, *new), list(polled(rows)))

    def _filter(self) -> None:
        """Apply the filters whose variables are all bound by now."""
        for formula in list(self.filters):
            terms = variables(formula)
            if terms <= self.bound:
                self.filters.remove(formula)
                names, rows = self._taken(terms)
                passes = self._test(formula, names)
                self._add(Bindings(names, [row for row in rows if passes(row)]))

    def _test(self, formula: Formula, names: tuple[str, ...]) -> Callable[[Row], bool]:
        """Whether a static condition holds for the values of some variables."""
        if not isinstance(formula, Literal):
            disjuncts = Disjuncts(self.unit, self.relations.decide, self.work).of
            return lambda row: bool(disjuncts(substitute(formula, dict(zip(names, row, strict=True)))))
        predicate, *terms = formula.key
        places = [(names.index(term) if term in names else -1, term) for term in terms]
        holds = self.relations.holds
        return lambda row: holds(formula, (predicate, *[row[i] if i >= 0 else term for i, term in places]))
