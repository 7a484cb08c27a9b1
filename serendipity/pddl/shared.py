"""Checks between the agents' files: what two of them say about the same thing."""

from collections.abc import Iterable, Sequence
from itertools import combinations

from serendipity.model import InputError
from serendipity.pddl.parsing.lifted import Key, Unit
from serendipity.pddl.parsing.tree import quoted
from serendipity.pddl.parsing.types import ANYTHING, Type, Types, type_text
from serendipity.pddl.work import Work

_LISTED = 3


def check_objects(units: Sequence[Unit]) -> None:
    """Check that an object has comparable types, and a predicate one arity, everywhere."""
    objects: dict[str, tuple[Type, Unit]] = {}
    predicates: dict[str, tuple[int, Unit]] = {}
    for unit in units:
        for name, kind in unit.problem.objects.items():
            before, other = objects.setdefault(name, (kind, unit))
            if not (_fits(unit.domain.types, before, kind) or _fits(other.domain.types, before, kind)):
                here = f"object {quoted(name)} is of type '{type_text(kind)}' here"
                there = f"of type '{type_text(before)}' in {other.problem_file}"
                raise InputError(f"{here}, {there}", unit.problem_file)
        for name, signature in unit.domain.predicates.items():
            arity, other = predicates.setdefault(name, (len(signature), unit))
            if arity != len(signature):
                there = f"{arity} in {other.domain_file}"
                message = f"predicate {quoted(name)} takes {len(signature)} arguments here, {there}"
                raise InputError(message, unit.domain_file)


def check_initial(units: Sequence[Unit]) -> None:
    """Check that no file says that something is false which another says is true."""
    for unit in units:
        for key, line in unit.problem.denied.items():
            other = next((other for other in units if key in other.problem.init), None)
            if other is not None:
                message = f"{quoted(' '.join(key))} is false here, true in {other.problem_file}"
                raise unit.problem_error(message, line)


def empty_lists(units: Iterable[Unit]) -> list[str]:
    """Warnings for types behind no object, as generators write where there is none of a type."""
    places = {
        f"{file}:{line}": None
        for unit in units
        for file, read in ((unit.domain_file, unit.domain), (unit.problem_file, unit.problem))
        for line in read.empty_lists
    }
    return [f"{place}: no object before '- TYPE': read as an empty list" for place in places]


def other_domains(units: Iterable[Unit]) -> list[str]:
    """Warnings for problems that say they belong to another domain than they came with."""
    return [
        f"{unit.problem_file} is for domain {quoted(str(unit.problem.domain_name))}, "
        f"but {unit.domain_file} defines {quoted(unit.domain.name)}"
        for unit in units
        if unit.problem.domain_name not in (None, unit.domain.name)
    ]


def _fits(types: Types, a: Type, b: Type) -> bool:
    if a == b or ANYTHING in (a, b):
        return True
    return all(name in types for name in (*a, *b)) and types.comparable(a, b)


def missing_facts(units: Sequence[Unit], work: Work) -> list[str]:
    """Warnings for facts that two domains share but only one initial state holds.

    Shared means: both domains have the predicate, and both problems the arguments.
    Predicates that no action changes are left out, and so is a file whose initial
    state is empty (a team's, say, that only brings joint actions).
    """
    changed = {e.literal.key[0] for unit in units for s in unit.domain.schemas for e in s.all_effects}
    found: dict[tuple[str, str, str], list[Key]] = {}
    for a, b in combinations([unit for unit in units if unit.problem.init], 2):
        for holder, other in ((a, b), (b, a)):
            for key in work.deadline.each(holder.problem.init):
                if key[0] in changed and key not in other.problem.init and _could_hold(other, key):
                    place = (key[0], holder.problem_file, other.problem_file)
                    found.setdefault(place, []).append(key)
    return [_warning(keys, *place[1:]) for place, keys in sorted(found.items())]


def _could_hold(unit: Unit, key: Key) -> bool:
    return key[0] in unit.domain.predicates and all(term in unit.problem.objects for term in key[1:])


def _warning(keys: Iterable[Key], holder: str, other: str) -> str:
    names = sorted(" ".join(key) for key in keys)
    listed = ", ".join(map(quoted, names[:_LISTED]))
    more = f" and {len(names) - _LISTED} more like it" if len(names) > _LISTED else ""
    verb = "holds" if len(names) == 1 else "hold"
    return f"{listed}{more} {verb} initially in {holder} but not in {other}, whose domain knows the predicate"
