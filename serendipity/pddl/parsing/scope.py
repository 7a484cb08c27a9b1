"""Conditions, effects and costs in a place: names, arities and types are right afterwards."""

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import replace
from fractions import Fraction
from functools import lru_cache, reduce
from operator import add, mul, sub, truediv
from re import compile as regex
from typing import Final, TypeVar

from serendipity.model import InputError
from serendipity.model.numbers import MOST_DIGITS, fraction
from serendipity.pddl.parsing.lifted import (
    EQUALITY,
    And,
    Effect,
    Expression,
    Formula,
    FunctionValue,
    Key,
    Literal,
    Operation,
    Or,
    Parameter,
    Quantified,
)
from serendipity.pddl.parsing.syntax import VARIABLE, Typed, typed_list
from serendipity.pddl.parsing.tree import (
    Item,
    SExpression,
    expected,
    name_at,
    node_at,
    quoted,
    refuse_more,
    shown,
)
from serendipity.pddl.parsing.types import ANYTHING, Type, Types, type_text
from serendipity.pddl.work import Work

T = TypeVar("T")

_MOST_DIGITS: Final = 2 * MOST_DIGITS
"""Digits of a cost: a number in a file may have so many, its exponent included."""

_OPERATORS: Final[dict[str, Callable[[Fraction, Fraction], Fraction]]] = {
    "+": add,
    "-": sub,
    "*": mul,
    "/": truediv,
}

TOTAL_COST: Final = "total-cost"

_NUMBER: Final = regex(r"[-+]?(\d+\.?\d*|\.\d+)(e[-+]?\d+)?")

_COMPARISONS: Final = ("<", "<=", ">", ">=")
NUMERIC_EFFECTS: Final = ("increase", "decrease", "assign", "scale-up", "scale-down")

START, INSIDE, END = "at start", "over all", "at end"

_UNSUPPORTED: Final = {
    "preference": "preferences",
    "probabilistic": "probabilistic effects",
    "oneof": "non-deterministic effects",
    **dict.fromkeys(
        (
            "always",
            "sometime",
            "within",
            "at-most-once",
            "sometime-after",
            "sometime-before",
            "always-within",
            "hold-during",
            "hold-after",
        ),
        "trajectory constraints",
    ),
}
"""Words that other planners know, in front of other things than arguments."""

RESERVED: Final = frozenset(
    {"and", "or", "not", "imply", "forall", "exists", "when", EQUALITY, *_COMPARISONS, *NUMERIC_EFFECTS}
)
"""Words that are no names of predicates, since they begin conditions or effects of their own."""


class Scope:
    """The names that may occur in a place.

    Attributes:
        variables: types of those in scope, by name.
        when: the part of a durative action that is read; None within it, and in what is not durative.
        quantified: whether there has been a quantifier.
    """

    def __init__(
        self,
        types: Types,
        predicates: Mapping[str, tuple[Type, ...]],
        functions: Mapping[str, tuple[Type, ...]],
        objects: Mapping[str, Type],
        work: Work,
    ) -> None:
        self.types = types
        self.predicates = predicates
        self.functions = functions
        self.objects = objects
        self.tick = work.deadline.tick
        self.variables: dict[str, Type] = {}
        self.when: str | None = None
        self.quantified = False

    def parameters(self, definitions: Iterable[Typed]) -> tuple[Parameter, ...]:
        """Typed variables; from here on they are in scope."""
        found: dict[str, Type] = {}
        for name, kind, line in definitions:
            if name in found:
                raise InputError(f"parameter {quoted(name)} is declared twice", line=line)
            check_type(kind, self.types, line)
            found[name] = kind
        self.variables = self.variables | found
        return tuple(Parameter(name, kind) for name, kind in found.items())

    def atom(self, node: SExpression, what: str = "predicate") -> Key:
        """The atom or function term of a node, its name, arity and types checked."""
        self.tick()
        name = name_at(node, 0, f"a {what}")
        types = (self.predicates if what == "predicate" else self.functions).get(name)
        if types is None:
            self._refuse_unsupported(node, name)
            raise InputError(f"unknown {what} {quoted(name)}", line=node.line)
        given = len(node.items) - 1
        if given != len(types):
            plural = "" if len(types) == 1 else "s"
            message = f"{what} {quoted(name)} takes {len(types)} argument{plural}, got {given}"
            raise InputError(message, line=node.line)
        return (name, *[self.term(node, i, kind) for i, kind in enumerate(types, start=1)])

    def _refuse_unsupported(self, node: SExpression, name: str) -> None:
        if name in _UNSUPPORTED:
            raise InputError(f"{_UNSUPPORTED[name]} ({quoted(name)}) are not supported", line=node.line)
        if name in RESERVED:
            raise InputError(f"{quoted(name)} is not possible here", line=node.line)

    def term(self, node: SExpression, i: int, kind: Type = ANYTHING) -> str:
        """A variable or object among the items of a node, its type checked."""
        word = node.items[i]
        if not isinstance(word, str):
            raise expected("an object or a variable", node, i)
        if word[0] == "?":
            own = self.variables.get(word)
            fits = own is not None and self.types.comparable(own, kind)
        else:
            own = self.objects.get(word)
            fits = own is not None and self.types.is_subtype(own, kind)
        if own is None:
            what = "variable" if word[0] == "?" else "object"
            raise InputError(f"{what} {quoted(word)} is not declared", line=node.line_of(i))
        if not fits:
            types = f"is of type '{type_text(own)}', expected type '{type_text(kind)}'"
            raise InputError(f"{quoted(word)} {types}", line=node.line_of(i))
        return word

    def condition_at(self, when: str, node: SExpression) -> Formula:
        """What a durative action asks for at ``when``."""
        self.when = when
        found = self.condition(node)
        self.when = None
        return found

    def effects_at(self, when: str, node: SExpression) -> tuple[list[Effect], list[Expression]]:
        """What a durative action changes at ``when``."""
        self.when = when
        found = self.effects(node)
        self.when = None
        return found

    def condition(self, node: SExpression, positive: bool = True) -> Formula:
        """A condition in negation normal form; ``positive`` is False below a negation."""
        if self.when is not None and node.head not in (None, "and", "forall"):
            when, part = timed(node, (START, INSIDE, END))
            return self._within(lambda: self.condition(part)) if when == self.when else And()
        match node.head:
            case None:
                return And() if positive else Or()
            case ("and" | "or") as word:
                parts = [self.condition(node_at(node, i, "a condition"), positive) for i in _rest(node)]
                return (And if (word == "and") == positive else Or)(tuple(parts))
            case "not":
                refuse_more(node, 2)
                return self.condition(node_at(node, 1, "a condition"), not positive)
            case "imply":
                refuse_more(node, 3)
                left = self.condition(node_at(node, 1, "a condition"), not positive)
                right = self.condition(node_at(node, 2, "a condition"), positive)
                return Or((left, right)) if positive else And((left, right))
            case ("forall" | "exists") as word:
                refuse_more(node, 3)
                outer = self.variables
                parameters = self.bound(node)
                body = self.condition(node_at(node, 2, "a condition"), positive)
                self.variables = outer
                return Quantified((word == "forall") == positive, parameters, body)
            case "=":
                return Literal(self._equality(node), positive)
            case "<" | "<=" | ">" | ">=":
                raise InputError("numeric conditions are not supported", line=node.line)
        return Literal(self.atom(node), positive)

    def _equality(self, node: SExpression) -> Key:
        if any(isinstance(item, SExpression) or _NUMBER.fullmatch(item) for item in node.items[1:]):
            raise InputError("numeric conditions are not supported", line=node.line)
        if len(node.items) != 3:
            raise InputError(f"'=' takes 2 arguments, got {len(node.items) - 1}", line=node.line)
        return (EQUALITY, self.term(node, 1), self.term(node, 2))

    def bound(self, quantified: SExpression) -> tuple[Parameter, ...]:
        """The variables of a quantifier; from here on they are in scope."""
        self.quantified = True
        refuse_more(quantified, 3)
        return self.parameters(typed_list(node_at(quantified, 1, "variables in brackets"), 0, VARIABLE))

    def effects(self, node: SExpression) -> tuple[list[Effect], list[Expression]]:
        """Effects on facts, and what is added to the total cost."""
        if self.when is not None and node.head not in (None, "and", "forall"):
            return self._timed_effects(node)
        match node.head:
            case None:
                return [], []
            case "and":
                both = [self.effects(node_at(node, i, "an effect")) for i in _rest(node)]
                return [e for found, _ in both for e in found], [c for _, costs in both for c in costs]
            case "not":
                refuse_more(node, 2)
                return [Effect(Literal(self.atom(node_at(node, 1, "an atom")), positive=False))], []
            case "forall":
                outer = self.variables
                parameters = self.bound(node)
                found = self._facts_only(node, "quantified")
                self.variables = outer
                return [replace(e, parameters=parameters + e.parameters) for e in found], []
            case "when":
                refuse_more(node, 3)
                condition = self.condition(node_at(node, 1, "a condition"))
                found = self._facts_only(node, "conditional")
                return [replace(e, condition=_both(condition, e.condition)) for e in found], []
        if node.head in NUMERIC_EFFECTS:
            return [], [self._increase(node)]
        return [Effect(Literal(self.atom(node)))], []

    def _timed_effects(self, node: SExpression) -> tuple[list[Effect], list[Expression]]:
        if isinstance(node.head, str) and node.head in NUMERIC_EFFECTS:
            message = f"continuous effects ({quoted(node.head)} without 'at start' or 'at end')"
            raise InputError(f"{message} are not supported", line=node.line)
        conditional = node.head == "when"
        found: tuple[list[Effect], list[Expression]] = [], []
        if not conditional:
            when, part = timed(node, (START, END))
            found = self._within(lambda: self.effects(part)) if when == self.when else found
        if conditional or any(effect.condition is not None for effect in found[0]):
            raise InputError("conditional effects of durative actions are not supported", line=node.line)
        return found

    def _within(self, read: Callable[[], T]) -> T:
        """What is read where there is no more word of when."""
        when, self.when = self.when, None
        found = read()
        self.when = when
        return found

    def _increase(self, node: SExpression) -> Expression:
        function = node_at(node, 1, "a function")
        if node.head != "increase" or function.head != TOTAL_COST:
            message = f"numeric effects are not supported, except 'increase ({TOTAL_COST})'"
            raise InputError(message, line=node.line)
        refuse_more(node, 3)
        self.atom(function, "function")
        return self.expression(node, 2)

    def _facts_only(self, node: SExpression, kind: str) -> list[Effect]:
        found, costs = self.effects(node_at(node, 2, "an effect"))
        if costs:
            raise InputError(f"{kind} action costs are not supported", line=node.line)
        return found

    def expression(self, node: SExpression, i: int) -> Expression:
        """A cost or duration among the items of a node: numbers, functions and what is calculated of them."""
        item = node.items[i] if i < len(node.items) else None
        if item == "#t":
            raise InputError("continuous effects ('#t') are not supported", line=node.line_of(i))
        if item == "?duration":
            message = "'?duration' in effects on numbers is not supported"
            raise InputError(message, line=node.line_of(i))
        if isinstance(item, str):
            return number(item, node.line_of(i))
        inner = node_at(node, i, "a number or a function")
        if inner.head == TOTAL_COST:
            raise InputError("a cost that depends on the total cost so far is not supported", line=inner.line)
        if inner.head not in ("+", "-", "*", "/"):
            return FunctionValue(self.atom(inner, "function"))
        operator, *_ = inner.items
        if len(inner.items) < 3:
            raise expected(f"two values to {operator}", inner, len(inner.items))
        return _operation(str(operator), [self.expression(inner, j) for j in _rest(inner)], inner.line)


def timed(node: SExpression, allowed: tuple[str, ...]) -> tuple[str, SExpression]:
    """When something of a durative action is asked, or takes effect, and what."""
    when = " ".join(item for item in node.items[:2] if isinstance(item, str))
    if len(node.items) < 2 or when not in allowed:
        words = " or ".join(f"'({one} ...)'" for one in allowed)
        raise InputError(f"expected {words}, got {shown(node)}", line=node.line)
    refuse_more(node, 3)
    return when, node_at(node, 2, f"brackets behind '{when}'")


def _rest(node: SExpression) -> range:
    return range(1, len(node.items))


def _operation(operator: str, values: Sequence[Expression], line: int) -> Expression:
    numbers = [value for value in values if isinstance(value, Fraction)]
    if len(numbers) < len(values):
        return Operation(operator, tuple(values))
    if operator == "/" and 0 in numbers[1:]:
        raise InputError("division by zero", line=line)
    return calculate(operator, numbers)


def calculate(operator: str, values: Iterable[Fraction]) -> Fraction:
    """The values with ``operator`` between them, from the left to the right, exactly."""
    return reduce(_OPERATORS[operator], values)


def cost_fault(value: Fraction) -> str | None:
    """The fault in the cost of an action, or None."""
    if max(abs(value.numerator), value.denominator) >= 10**_MOST_DIGITS:
        return f"expected a cost of at most {_MOST_DIGITS} digits"
    return f"expected a cost of at least 0, got {float(value):g}" if value < 0 else None


def is_number(item: Item) -> bool:
    """Whether an item is a word that writes down a number."""
    return isinstance(item, str) and _NUMBER.fullmatch(item) is not None


def number(text: str, line: int) -> Fraction:
    """The value of a number."""
    try:
        if not _NUMBER.fullmatch(text):
            raise ValueError
        return _fraction(text)
    except (ValueError, ZeroDivisionError):
        raise InputError(f"expected a number, got {quoted(text)}", line=line) from None


def check_type(kind: Type, types: Types, line: int) -> None:
    """Check that all names of a type are declared."""
    unknown = next((name for name in kind if name not in types), None)
    if unknown is not None:
        raise InputError(f"unknown type {quoted(unknown)}", line=line)


def _both(a: Formula, b: Formula | None) -> Formula:
    return a if b is None else And((a, b))


@lru_cache(maxsize=1024)
def _fraction(text: str) -> Fraction:
    """One object per number, so that costs can be told apart by identity."""
    return fraction(text)
