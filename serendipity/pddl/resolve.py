"""Syntax trees to checked lifted values: names, arities and types are right afterwards.

Errors carry the line; the caller adds the file.
"""

from collections.abc import Iterable, Sequence
from dataclasses import replace
from fractions import Fraction
from functools import lru_cache
from sys import intern
from typing import Any, Final

from plado import pddl

from serendipity.model import InputError
from serendipity.model.numbers import fraction
from serendipity.pddl.lifted import (
    EQUALITY,
    OBJECT,
    And,
    Domain,
    Effect,
    Expression,
    Formula,
    FunctionValue,
    Key,
    Literal,
    Operation,
    Or,
    Parameter,
    Problem,
    Quantified,
    Schema,
    Types,
)
from serendipity.pddl.syntax import DomainSyntax, ProblemSyntax, parse_domain, parse_problem

TOTAL_COST: Final = "total-cost"

_OPERATORS: Final = {pddl.Sum: "+", pddl.Subtraction: "-", pddl.Product: "*", pddl.Division: "/"}


@lru_cache(maxsize=64)
def read_domain(text: str) -> Domain:
    """The checked domain that a text defines; equal texts are read once.

    Raises:
        InputError: with the line, without the file.
    """
    return _DomainResolver(parse_domain(text)).domain()


def read_problem(text: str, domain: Domain) -> Problem:
    """The checked problem that a text defines for a domain.

    Raises:
        InputError: with the line, without the file.
    """
    return _resolve_problem(parse_problem(text), domain)


class _Scope:
    """What names may occur in a place: predicates, functions, objects, variables."""

    def __init__(
        self,
        types: Types,
        predicates: dict[str, tuple[str, ...]],
        functions: dict[str, tuple[str, ...]],
        objects: dict[str, str],
    ) -> None:
        self.types = types
        self.predicates = predicates
        self.functions = functions
        self.objects = objects
        self.variables: dict[str, str] = {}
        self.where = ""

    def error(self, message: str, name: object) -> InputError:
        return InputError(f"{self.where}{message}", line=getattr(name, "line", None))

    def parameters(self, definitions: Iterable[Any]) -> tuple[Parameter, ...]:
        """Typed variables; from here on they are in scope."""
        found: dict[str, str] = {}
        for definition in definitions:
            name, kind = definition.name, definition.type_name
            if name in found:
                raise self.error(f"parameter '{name}' is declared twice", name)
            if kind not in self.types:
                raise self.error(f"unknown type '{kind}'", kind if hasattr(kind, "line") else name)
            found[intern(str(name))] = intern(str(kind))
        self.variables = self.variables | found
        return tuple(Parameter(name, kind) for name, kind in found.items())

    def key(self, node: Any, known: dict[str, tuple[str, ...]], what: str) -> Key:
        """The atom or function term of a node, its name, arity and types checked."""
        name = node.name
        expected = known.get(name)
        if expected is None:
            raise self.error(f"unknown {what} '{name}'", name)
        arguments = node.arguments
        if len(arguments) != len(expected):
            raise self.error(f"{what} '{name}' takes {len(expected)} arguments, got {len(arguments)}", name)
        if not arguments:
            return (intern(str(name)),)
        return (intern(str(name)), *map(self.term, (a.name for a in arguments), expected))

    def term(self, name: str, expected: str = OBJECT) -> str:
        """A variable or object, its type checked."""
        if name[0] == "?":
            kind = self.variables.get(name)
            if kind is None:
                raise self.error(f"variable '{name}' is not declared", name)
            fits = self.types.comparable(kind, expected)
        else:
            kind = self.objects.get(name)
            if kind is None:
                raise self.error(f"object '{name}' is not declared", name)
            fits = self.types.is_subtype(kind, expected)
        if not fits:
            raise self.error(f"'{name}' is of type '{kind}', expected type '{expected}'", name)
        return intern(str(name))

    def condition(self, node: Any, positive: bool = True) -> Formula:
        """A condition in negation normal form; ``positive`` is False below a negation."""
        kind = type(node)
        if kind is pddl.Atom:
            if node.name == EQUALITY:
                return Literal((EQUALITY, *(self.term(a.name) for a in node.arguments)), positive)
            return Literal(self.key(node, self.predicates, "predicate"), positive)
        if kind is pddl.Conjunction or kind is pddl.Disjunction:
            parts = tuple([self.condition(part, positive) for part in node.sub_formulas])
            return And(parts) if (kind is pddl.Conjunction) == positive else Or(parts)
        if kind is pddl.Negation:
            return self.condition(node.sub_formula, not positive)
        if kind is pddl.Truth or node is None:
            return And() if positive else Or()
        if kind is pddl.Forall or kind is pddl.Exists:
            outer = self.variables
            parameters = self.parameters(node.parameters)
            body = self.condition(node.sub_formula, positive)
            self.variables = outer
            return Quantified((kind is pddl.Forall) == positive, parameters, body)
        raise self.error("numeric conditions are not supported", _first_name(node))

    def effects(self, node: Any) -> tuple[list[Effect], list[Expression]]:
        """Effects on facts, and what is added to the total cost."""
        kind = type(node)
        if kind is pddl.AtomEffect:
            return [Effect(Literal(self.key(node, self.predicates, "predicate")))], []
        if kind is pddl.NegativeEffect:
            return [Effect(Literal(self.key(node.atom, self.predicates, "predicate"), positive=False))], []
        if kind is pddl.ConjunctiveEffect:
            found: list[Effect] = []
            costs: list[Expression] = []
            for part in node.effects:
                inner, more = self.effects(part)
                found += inner
                costs += more
            return found, costs
        if kind is pddl.IncreaseEffect and node.variable.name == TOTAL_COST:
            self.key(node.variable, self.functions, "function")
            return [], [self.expression(node.expression, node.variable.name)]
        if kind is pddl.UniversalEffect:
            outer = self.variables
            parameters = self.parameters(node.parameters)
            found = self._facts_only(node.effect, parameters)
            self.variables = outer
            return [replace(e, parameters=parameters + e.parameters) for e in found], []
        if kind is pddl.ConditionalEffect:
            condition = self.condition(node.condition)
            found = self._facts_only(node.effect, ())
            return [replace(e, condition=_both(condition, e.condition)) for e in found], []
        if kind is pddl.ProbabilisticEffect:
            raise self.error("probabilistic effects are not supported", _first_name(node))
        name = _first_name(node)
        raise self.error(f"numeric effects are not supported, except 'increase ({TOTAL_COST})'", name)

    def _facts_only(self, node: Any, parameters: Sequence[Parameter]) -> list[Effect]:
        found, costs = self.effects(node)
        if costs:
            kind = "quantified" if parameters else "conditional"
            raise self.error(f"{kind} action costs are not supported", _first_name(node))
        return found

    def expression(self, node: Any, near: str) -> Expression:
        """A cost expression over numbers and functions."""
        if type(node) is pddl.NumericConstant:
            return _number(node.value_str)
        if type(node) is pddl.FunctionCall:
            return FunctionValue(self.key(node, self.functions, "function"))
        operator = _OPERATORS.get(type(node))
        if operator is None:
            raise self.error("cost expression is not supported", near)
        left, right = self.expression(node.lhs, near), self.expression(node.rhs, near)
        if isinstance(left, Fraction) and isinstance(right, Fraction):
            return self.calculate(operator, left, right, near)
        return Operation(operator, left, right)

    def calculate(self, operator: str, left: Fraction, right: Fraction, near: str) -> Fraction:
        """The value of an operation on numbers."""
        if operator == "/" and right == 0:
            raise self.error("division by zero in a cost", near)
        return calculate(operator, left, right)


def calculate(operator: str, left: Fraction, right: Fraction) -> Fraction:
    """``left operator right``, exactly."""
    match operator:
        case "+":
            return left + right
        case "-":
            return left - right
        case "*":
            return left * right
        case _:
            return left / right


class _DomainResolver:
    def __init__(self, syntax: DomainSyntax) -> None:
        self.syntax = syntax
        self.types = _resolve_types(syntax.types)
        self.constants = _resolve_objects(syntax.constants, self.types, {})
        self.predicates = self._signatures(syntax.predicates, "predicate")
        self.functions = self._signatures(syntax.functions, "function")

    def domain(self) -> Domain:
        schemas: dict[str, Schema] = {}
        for action in self.syntax.actions:
            if action.name in schemas:
                first = schemas[action.name].line
                raise InputError(
                    f"action '{action.name}' is defined already in line {first}", line=action.name.line
                )
            schemas[str(action.name)] = self._schema(action)
        return Domain(
            str(self.syntax.name),
            self.types,
            self.constants,
            self.predicates,
            self.functions,
            tuple(schemas.values()),
        )

    def _signatures(self, definitions: Iterable[Any], what: str) -> dict[str, tuple[str, ...]]:
        found: dict[str, tuple[str, ...]] = {}
        for definition in definitions:
            name = definition.name
            scope = _Scope(self.types, {}, {}, {})
            scope.where = f"{what} '{name}': "
            signature = tuple(p.type for p in scope.parameters(definition.parameters))
            if found.setdefault(intern(str(name)), signature) != signature:
                raise InputError(f"{what} '{name}' is declared twice, in different ways", line=name.line)
        return found

    def _schema(self, action: Any) -> Schema:
        scope = _Scope(self.types, self.predicates, self.functions, self.constants)
        scope.where = f"action '{action.name}': "
        parameters = scope.parameters(action.parameters)
        precondition = scope.condition(action.precondition)
        effects, increases = scope.effects(action.effect)
        for value in increases:
            if isinstance(value, Fraction) and value < 0:
                raise scope.error(f"expected a cost of at least 0, got {float(value):g}", action.name)
        return Schema(
            intern(str(action.name)),
            action.name.line,
            parameters,
            precondition,
            tuple(effects),
            tuple(increases),
        )


def _resolve_types(definitions: Iterable[Any]) -> Types:
    parents: dict[str, str] = {}
    lines: dict[str, Any] = {}
    for definition in definitions:
        name, parent = str(definition.name), str(definition.parent_type_name)
        if name in lines and parents.get(name, OBJECT) != parent:
            raise InputError(f"type '{name}' is declared twice, in different ways", line=definition.name.line)
        lines[name] = definition.name
        if name != OBJECT:
            parents[name] = parent
    for parent in list(parents.values()):
        parents.setdefault(parent, OBJECT)
    for name in lines:
        _refuse_cycle(name, parents, lines)
    return Types(parents)


def _refuse_cycle(name: str, parents: dict[str, str], lines: dict[str, Any]) -> None:
    above = parents.get(name, OBJECT)
    for _ in parents:
        if above == name:
            raise InputError(f"type '{name}' is its own supertype", line=lines[name].line)
        above = parents.get(above, OBJECT)


def _resolve_objects(definitions: Iterable[Any], types: Types, known: dict[str, str]) -> dict[str, str]:
    objects = dict(known)
    for definition in definitions:
        name, kind = intern(str(definition.name)), intern(str(definition.type_name))
        if kind not in types:
            line = getattr(definition.type_name, "line", definition.name.line)
            raise InputError(f"object '{name}': unknown type '{kind}'", line=line)
        before = objects.get(name, kind)
        if not types.comparable(before, kind):
            raise InputError(
                f"object '{name}' is declared as '{before}' and as '{kind}'", line=definition.name.line
            )
        objects[name] = kind if types.is_subtype(kind, before) else before
    return objects


def _resolve_problem(syntax: ProblemSyntax, domain: Domain) -> Problem:
    objects = _resolve_objects(syntax.objects, domain.types, domain.constants)
    scope = _Scope(domain.types, domain.predicates, domain.functions, objects)
    scope.where = "initial state: "
    init: set[Key] = set()
    values: dict[Key, Fraction] = {}
    functions = {TOTAL_COST: (), **domain.functions}
    for item in syntax.init:
        if type(item) is pddl.Atom:
            init.add(scope.key(item, domain.predicates, "predicate"))
            continue
        key = scope.key(item.variable, functions, "function")
        value = _number(item.expression.value_str)
        if values.setdefault(key, value) != value:
            raise scope.error(f"'{' '.join(key)}' is given two values", item.variable.name)
    scope.where = "goal: "
    goal = scope.condition(syntax.goal)
    return Problem(
        str(syntax.name),
        None if syntax.domain is None else str(syntax.domain),
        objects,
        frozenset(init),
        values,
        goal,
        syntax.goal_line,
        _minimises_cost(syntax),
    )


def _minimises_cost(syntax: ProblemSyntax) -> bool:
    metric = syntax.metric
    if metric is None:
        return False
    expression = metric.expression
    total = type(expression) is pddl.FunctionCall and expression.name == TOTAL_COST
    if metric.direction != pddl.Metric.MINIMIZE or not total:
        raise InputError(f"the only metric supported is 'minimize ({TOTAL_COST})'", line=syntax.metric_line)
    return True


def _number(text: str) -> Fraction:
    try:
        return _fraction(str(text))
    except (ValueError, ZeroDivisionError):
        raise InputError(f"expected a number, got '{text:.50}'", line=getattr(text, "line", None)) from None


def _both(a: Formula, b: Formula | None) -> Formula:
    return a if b is None else And((a, b))


def _first_name(node: Any) -> str:
    """Some word of a node, for its line."""
    pending = [node]
    while pending:
        item = pending.pop()
        if hasattr(item, "line"):
            return item  # type: ignore[no-any-return]
        if isinstance(item, (tuple, list)):
            pending.extend(reversed(item))
        elif hasattr(item, "__dict__"):
            pending.extend(reversed(list(vars(item).values())))
    return ""


@lru_cache(maxsize=1024)
def _fraction(text: str) -> Fraction:
    """One object per number, so that costs can be told apart by identity."""
    return fraction(text)
