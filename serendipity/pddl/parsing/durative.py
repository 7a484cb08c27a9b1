"""Durative actions of PDDL 2.1: what is asked and changed when, and how long they take."""

from collections.abc import Iterator, Mapping
from fractions import Fraction
from typing import Final

from serendipity.model import InputError
from serendipity.pddl.parsing.lifted import DurativeParts, Effect, Expression, Formula
from serendipity.pddl.parsing.scope import END, INSIDE, START, Scope, timed
from serendipity.pddl.parsing.tree import SExpression, expected, node_at, refuse_more, shown

_DURATION: Final = "?duration"
_BOUNDS: Final = ("=", "<=", ">=")


class DurativeReader:
    """Reads the parts of durative actions."""

    def __init__(self, scope: Scope) -> None:
        self._scope = scope

    def read(
        self, parts: Mapping[str, SExpression]
    ) -> tuple[Formula, list[Effect], list[Expression], DurativeParts]:
        """Conditions at start, effects at end, what is added to the total cost, and the rest."""
        least, most = self._duration(parts[":duration"])
        asked, changed = parts.get(":condition", SExpression(0)), parts[":effect"]
        start, inside, end = (self._scope.condition_at(when, asked) for when in (START, INSIDE, END))
        (first, sooner), (last, later) = (self._scope.effects_at(when, changed) for when in (START, END))
        course = DurativeParts(least, most, inside, end, tuple(first))
        return start, last, [*sooner, *later], course

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
            for i in range(1, len(node.items)):
                yield from self._bounds(node_at(node, i, "a bound of the duration"))
            return
        if node.head == "at":
            yield from self._bounds(timed(node, (START, END))[1])
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
