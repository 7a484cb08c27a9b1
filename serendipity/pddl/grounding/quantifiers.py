"""Quantifiers: which of them say something, how much they stand for, and their instances."""

from collections.abc import Iterator
from itertools import product
from math import prod

from serendipity.pddl.parsing import lifted


def simplified(formula: lifted.Formula, unit: lifted.Unit) -> lifted.Formula:
    """The same condition, each quantifier as far inside as it can be, over what it needs only."""
    match formula:
        case lifted.And(parts):
            return lifted.And(tuple([simplified(part, unit) for part in parts]))
        case lifted.Or(parts):
            return lifted.Or(tuple([simplified(part, unit) for part in parts]))
        case lifted.Quantified(universal, parameters, body):
            return _quantified(universal, parameters, simplified(body, unit), unit)
    return formula


def _quantified(
    universal: bool, parameters: tuple[lifted.Parameter, ...], body: lifted.Formula, unit: lifted.Unit
) -> lifted.Formula:
    if _void(parameters, unit):
        return lifted.And() if universal else lifted.Or()
    if universal and isinstance(body, lifted.And):
        return lifted.And(tuple([_quantified(universal, parameters, part, unit) for part in body.parts]))
    if not universal and isinstance(body, lifted.Or):
        return lifted.Or(tuple([_quantified(universal, parameters, part, unit) for part in body.parts]))
    used = variables(body)
    own = tuple([p for p in parameters if p.name in used])
    return lifted.Quantified(universal, own, body) if own else body


def simplified_effect(effect: lifted.Effect, unit: lifted.Unit) -> lifted.Effect | None:
    """The same effect with a simplified condition, over what it changes only; None if it has no instance."""
    if _void(effect.parameters, unit):
        return None
    changed = tuple([p for p in effect.parameters if p.name in effect.literal.key])
    if effect.condition is None:
        return lifted.Effect(effect.literal, changed)
    others = tuple([p for p in effect.parameters if p not in changed])
    condition = _quantified(False, others, simplified(effect.condition, unit), unit)
    return lifted.Effect(effect.literal, changed, condition)


def _void(parameters: tuple[lifted.Parameter, ...], unit: lifted.Unit) -> bool:
    """Whether there is nothing that one of the parameters could be."""
    return not all(unit.objects_of(p.type) for p in parameters)


def variables(formula: lifted.Formula) -> frozenset[str]:
    """The free variables of a condition."""
    match formula:
        case lifted.Literal(key):
            return frozenset([term for term in key[1:] if term[0] == "?"])
        case lifted.And(parts) | lifted.Or(parts):
            return frozenset().union(*[variables(part) for part in parts])
        case lifted.Quantified(_, parameters, body):
            return variables(body) - {p.name for p in parameters}


def literals(formula: lifted.Formula) -> Iterator[lifted.Literal]:
    """The literals of a condition, as they are written."""
    match formula:
        case lifted.Literal():
            yield formula
        case lifted.And(parts) | lifted.Or(parts):
            for part in parts:
                yield from literals(part)
        case lifted.Quantified(_, _, body):
            yield from literals(body)


def instances(formula: lifted.Formula, unit: lifted.Unit) -> int:
    """The number of literals of a condition without quantifiers."""
    match formula:
        case lifted.Literal():
            return 1
        case lifted.And(parts) | lifted.Or(parts):
            return sum([instances(part, unit) for part in parts])
        case lifted.Quantified(_, parameters, body):
            return how_many(parameters, unit) * instances(body, unit)


def how_many(parameters: tuple[lifted.Parameter, ...], unit: lifted.Unit) -> int:
    """The number of assignments of objects to parameters."""
    return prod([len(unit.objects_of(p.type)) for p in parameters])


def assignments(parameters: tuple[lifted.Parameter, ...], unit: lifted.Unit) -> Iterator[dict[str, str]]:
    """Every assignment of objects to parameters."""
    names = [p.name for p in parameters]
    for objects in product(*[unit.objects_of(p.type) for p in parameters]):
        yield dict(zip(names, objects, strict=True))


def negated(formula: lifted.Formula) -> lifted.Formula:
    """The opposite of a condition, in negation normal form as well."""
    match formula:
        case lifted.Literal(key, positive):
            return lifted.Literal(key, not positive)
        case lifted.And(parts):
            return lifted.Or(tuple([negated(part) for part in parts]))
        case lifted.Or(parts):
            return lifted.And(tuple([negated(part) for part in parts]))
        case lifted.Quantified(universal, parameters, body):
            return lifted.Quantified(not universal, parameters, negated(body))


def substitute(formula: lifted.Formula, values: dict[str, str]) -> lifted.Formula:
    """The formula with variables replaced; an inner quantifier shadows."""
    if not values:
        return formula
    match formula:
        case lifted.Literal(key, positive):
            return lifted.Literal(ground_key(key, values), positive)
        case lifted.And(parts):
            return lifted.And(tuple([substitute(part, values) for part in parts]))
        case lifted.Or(parts):
            return lifted.Or(tuple([substitute(part, values) for part in parts]))
        case lifted.Quantified(universal, parameters, body):
            own = {p.name for p in parameters}
            outer = {name: value for name, value in values.items() if name not in own}
            return lifted.Quantified(universal, parameters, substitute(body, outer))


def ground_key(key: lifted.Key, values: dict[str, str]) -> lifted.Key:
    """The atom with variables replaced."""
    if not values:
        return key
    return (key[0], *[values.get(term, term) for term in key[1:]])
