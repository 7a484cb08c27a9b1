"""Durative actions of PDDL 2.1: what is asked and changed when, and how long they take."""

from collections.abc import Iterator, Mapping
from dataclasses import replace
from fractions import Fraction
from typing import Final

from serendipity.model import InputError
from serendipity.pddl.parsing.lifted import (
    And,
    DurativeParts,
    Effect,
    Expression,
    Formula,
    Parameter,
    Quantified,
)
from serendipity.pddl.parsing.scope import NUMERIC_EFFECTS, Scope
from serendipity.pddl.parsing.tree import SExpression, expected, node_at, quoted, refuse_more, shown

START, INSIDE, END = "at start", "over all", "at end"

_DURATION: Final = "?duration"
_BOUNDS: Final = ("=", "<=", ">=")


class DurativeReader:
    """Reads the parts of durative actions.

    Args:
        scope: the names that may occur in them, parameters included.
    """

    def __init__(self, scope: Scope) -> None:
        self._scope = scope

    def read(
        self, parts: Mapping[str, SExpression]
    ) -> tuple[Formula, list[Effect], list[Expression], DurativeParts]:
        """Conditions at start, effects at end, what is added to the total cost, and the rest.

        Raises:
            InputError: something is not of that form, or not supported; with the line.
        """
        least, most = self._duration(parts[":duration"])
        conditions: dict[str, list[Formula]] = {START: [], INSIDE: [], END: []}
        if ":condition" in parts:
            for when, formula in self._conditions(parts[":condition"]):
                conditions[when].append(formula)
        effects: dict[str, list[Effect]] = {START: [], END: []}
        increases: list[Expression] = []
        for when, found, costs in self._effects(parts[":effect"]):
            effects[when] += found
            increases += costs
        start, inside, end = (And(tuple(conditions[when])) for when in (START, INSIDE, END))
        course = DurativeParts(least, most, inside, end, tuple(effects[START]))
        return start, effects[END], increases, course

    def _conditions(self, node: SExpression) -> Iterator[tuple[str, Formula]]:
        match node.head:
            case None:
                return
            case "and":
                for part in _parts(node, "a condition"):
                    yield from self._conditions(part)
            case "forall":
                outer = self._scope.variables
                parameters = self._scope.bound(node)
                inner = [*self._conditions(node_at(node, 2, "a condition"))]
                self._scope.variables = outer
                yield from _for_all(parameters, inner)
            case _:
                when, part = _timed(node, (START, INSIDE, END))
                yield when, self._scope.condition(part)

    def _effects(self, node: SExpression) -> Iterator[tuple[str, list[Effect], list[Expression]]]:
        match node.head:
            case None:
                return
            case "and":
                for part in _parts(node, "an effect"):
                    yield from self._effects(part)
            case "forall":
                yield from self._quantified(node)
            case "when":
                message = "conditional effects of durative actions are not supported"
                raise InputError(message, line=node.line)
            case str() as word if word in NUMERIC_EFFECTS:
                message = (
                    f"continuous effects ({quoted(word)} without 'at start' or 'at end') are not supported"
                )
                raise InputError(message, line=node.line)
            case _:
                when, part = _timed(node, (START, END))
                found, costs = self._scope.effects(part)
                if any(effect.condition is not None for effect in found):
                    message = "conditional effects of durative actions are not supported"
                    raise InputError(message, line=node.line)
                yield when, found, costs

    def _quantified(self, node: SExpression) -> Iterator[tuple[str, list[Effect], list[Expression]]]:
        outer = self._scope.variables
        parameters = self._scope.bound(node)
        inner = [*self._effects(node_at(node, 2, "an effect"))]
        self._scope.variables = outer
        for when, found, costs in inner:
            if costs:
                raise InputError("quantified action costs are not supported", line=node.line)
            yield when, [replace(e, parameters=parameters + e.parameters) for e in found], []

    def _duration(self, node: SExpression) -> tuple[tuple[Expression, ...], tuple[Expression, ...]]:
        """The lower and the upper bounds of the duration."""
        least: list[Expression] = []
        most: list[Expression] = []
        for operator, value in self._bounds(node):
            if operator != "<=":
                least.append(value)
            if operator != ">=":
                most.append(value)
        if not least:
            got = shown(node) if node.items else "'()'"
            raise InputError(
                f"expected '(= {_DURATION} N)' or '(>= {_DURATION} N)', got {got}", line=node.line
            )
        return tuple(least), tuple(most)

    def _bounds(self, node: SExpression) -> Iterator[tuple[str, Expression]]:
        if node.head is None:
            return
        if node.head == "and":
            for part in _parts(node, "a bound of the duration"):
                yield from self._bounds(part)
            return
        if node.head == "at":
            yield from self._bounds(_timed(node, (START, END))[1])
            return
        if not isinstance(node.head, str) or node.head not in _BOUNDS:
            raise expected(f"'=', '<=' or '>=' before '{_DURATION}'", node, 0)
        if node.items[1:2] != [_DURATION]:
            raise expected(f"'{_DURATION}'", node, 1)
        refuse_more(node, 3)
        value = self._scope.expression(node, 2)
        if isinstance(value, Fraction) and node.head != "<=" and value <= 0:
            raise InputError(f"expected a duration above 0, got {float(value):g}", line=node.line)
        yield node.head, value


def _for_all(
    parameters: tuple[Parameter, ...], conditions: list[tuple[str, Formula]]
) -> Iterator[tuple[str, Formula]]:
    for when, formula in conditions:
        yield when, Quantified(True, parameters, formula)


def _parts(node: SExpression, what: str) -> Iterator[SExpression]:
    return (node_at(node, i, what) for i in range(1, len(node.items)))


def _timed(node: SExpression, allowed: tuple[str, ...]) -> tuple[str, SExpression]:
    """When something of a durative action is asked, or takes effect, and what."""
    when = " ".join(item for item in node.items[:2] if isinstance(item, str))
    if len(node.items) < 2 or when not in allowed:
        words = " or ".join(f"'({one} ...)'" for one in allowed)
        raise InputError(f"expected {words}, got {shown(node)}", line=node.line)
    refuse_more(node, 3)
    return when, node_at(node, 2, f"brackets behind '{when}'")
