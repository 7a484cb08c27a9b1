"""Lifted tasks of several agents to PDDL of a single one, for planners that know no agents.

Nothing is grounded, so that such a planner finds its variables by itself: an action keeps its
parameters, its agent the first of them.  Who may act is a static fact; what it costs is a
function of the agent and of what else the cost depends on.
"""

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from fractions import Fraction
from math import lcm
from typing import NamedTuple

from serendipity.model import InputError
from serendipity.pddl.grounding.costs import Costs
from serendipity.pddl.grounding.product import Bindings, Product
from serendipity.pddl.parsing import lifted
from serendipity.pddl.parsing.tree import quoted
from serendipity.pddl.parsing.types import OBJECT, Type

_ACTS = "acts-in-this-call"
_COST = "cost-of-"


@dataclass(frozen=True, slots=True)
class ClassicalFiles:
    """A task as one problem of a single agent, the whole team; costs there are team costs times ``scale``."""

    domain: str
    problem: str
    scale: int


class _Priced(NamedTuple):
    """An action with the terms that its cost depends on, and the cost for their values."""

    schema: lifted.Schema
    terms: tuple[str, ...]
    costs: dict[lifted.Key, Fraction]


def lifted_files(unit: lifted.Unit, shares: Mapping[str, Fraction]) -> ClassicalFiles:
    """One domain and problem whose optimal plans are the composite ones without a horizon.

    Plans of such a problem are sequences.  Where actions may share an epoch although each
    spoils a precondition of another (``interference="paper"``), no sequence does the same.

    Args:
        shares: the agents that may act, each with the share of an action's cost that counts: 1
            for the human, what the discount leaves for robots.

    Raises:
        InputError: an action has no ``:agent``, or a type is ``either`` of several.
    """
    if unit.problem.timed or any(schema.course is not None for schema in unit.domain.schemas):
        raise InputError(
            "planners for one agent are given no durations and no timed literals", unit.domain_file
        )
    priced = [_priced(schema, unit, shares) for schema in unit.domain.schemas]
    scale = lcm(*(cost.denominator for action in priced for cost in action.costs.values()))
    return ClassicalFiles(_domain(unit, priced), _problem(unit, shares, priced, scale), scale)


def _priced(schema: lifted.Schema, unit: lifted.Unit, shares: Mapping[str, Fraction]) -> _Priced:
    if not schema.agent:
        raise unit.domain_error(f"action {quoted(schema.name)}: expected an ':agent'", schema.line)
    agent, *others = schema.parameters
    used = {term for value in schema.increases for term in _terms(value)}
    terms = [agent, *(parameter for parameter in others if parameter.name in used)]
    product = Product([Bindings((t.name,), [(name,) for name in unit.objects_of(t.type)]) for t in terms])
    names = tuple(term.name for term in terms)
    costs = {}
    for values, cost in zip(product, Costs(unit.problem.values).of(schema, unit, product), strict=True):
        key = tuple(values[name] for name in names)
        if key[0] in shares and isinstance(cost, Fraction):
            costs[key] = cost * shares[key[0]]
    return _Priced(schema, names, costs)


def _terms(value: lifted.Expression) -> Iterator[str]:
    match value:
        case lifted.FunctionValue(key):
            yield from key[1:]
        case lifted.Operation(_, values):
            for part in values:
                yield from _terms(part)


def _domain(unit: lifted.Unit, priced: Iterable[_Priced]) -> str:
    domain = unit.domain
    types = (f"{name} - {_type(above, unit)}" for name, above in domain.types.parents.items())
    predicates = (
        f"({name}{_parameters([lifted.Parameter(f'?x{i}', kind) for i, kind in enumerate(kinds)], unit)})"
        for name, kinds in {**domain.predicates, _ACTS: ((OBJECT,),)}.items()
    )
    functions = (
        f"({_COST}{schema.name}{''.join(f' ?x{i}' for i in range(len(terms)))})"
        for schema, terms, _ in priced
    )
    return _text(
        f"(define (domain {domain.name})",
        "(:requirements :adl :typing :action-costs)",
        *_section(":types", types),
        *_section(":constants", _objects(domain.constants, unit)),
        *_section(":predicates", predicates),
        *_section(":functions", ["(total-cost)", *functions]),
        *(_action(action, unit) for action in priced),
    )


def _action(action: _Priced, unit: lifted.Unit) -> str:
    schema = action.schema
    agent = schema.parameters[0].name
    effects = [f"(increase (total-cost) ({_COST}{schema.name} {' '.join(action.terms)}))"]
    effects += [_effect(effect, unit) for effect in schema.effects]
    return "\n".join(
        (
            f"(:action {schema.name}",
            f"  :parameters ({_parameters(schema.parameters, unit).strip()})",
            f"  :precondition (and ({_ACTS} {agent}) {_formula(schema.precondition, unit)})",
            f"  :effect (and {' '.join(effects)}))",
        )
    )


def _problem(unit: lifted.Unit, shares: Iterable[str], priced: Iterable[_Priced], scale: int) -> str:
    problem = unit.problem
    own = {name: kind for name, kind in problem.objects.items() if name not in unit.domain.constants}
    costs = (
        f"(= ({_COST}{schema.name} {' '.join(key)}) {cost * scale})"
        for schema, _, of in priced
        for key, cost in of.items()
    )
    facts = (f"({' '.join(key)})" for key in problem.init)
    acting = (f"({_ACTS} {agent})" for agent in shares)
    return _text(
        f"(define (problem {problem.name})",
        f"(:domain {unit.domain.name})",
        *_section(":objects", _objects(own, unit)),
        *_section(":init", ["(= (total-cost) 0)", *acting, *facts, *costs]),
        f"(:goal {_formula(problem.goal, unit)})",
        "(:metric minimize (total-cost))",
    )


def _text(*lines: str) -> str:
    return "\n".join([*lines, ")", ""])


def _section(keyword: str, items: Iterable[str]) -> list[str]:
    listed = [f"  {item}" for item in items]
    return [f"({keyword}", *listed, ")"] if listed else []


def _objects(objects: Mapping[str, Type], unit: lifted.Unit) -> Iterator[str]:
    return (f"{name} - {_type(kind, unit)}" for name, kind in objects.items())


def _parameters(parameters: Iterable[lifted.Parameter], unit: lifted.Unit) -> str:
    return "".join(f" {name} - {_type(kind, unit)}" for name, kind in parameters)


def _type(kind: Type, unit: lifted.Unit) -> str:
    if len(kind) > 1:
        raise InputError(f"planners for one agent know no type 'either' ({' '.join(kind)})", unit.domain_file)
    return kind[0]


def _formula(formula: lifted.Formula, unit: lifted.Unit) -> str:
    match formula:
        case lifted.Literal(key, positive):
            atom = f"({' '.join(key)})"
            return atom if positive else f"(not {atom})"
        case lifted.And(parts):
            return f"(and{''.join(f' {_formula(part, unit)}' for part in parts)})"
        case lifted.Or(parts):
            return f"(or{''.join(f' {_formula(part, unit)}' for part in parts)})"
    word = "forall" if formula.universal else "exists"
    return f"({word} ({_parameters(formula.parameters, unit).strip()}) {_formula(formula.body, unit)})"


def _effect(effect: lifted.Effect, unit: lifted.Unit) -> str:
    text = _formula(effect.literal, unit)
    if effect.condition is not None:
        text = f"(when {_formula(effect.condition, unit)} {text})"
    if effect.parameters:
        text = f"(forall ({_parameters(effect.parameters, unit).strip()}) {text})"
    return text
