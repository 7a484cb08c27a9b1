"""The initial state: what a problem says is true, is false, and what functions are worth."""

from dataclasses import dataclass, field
from fractions import Fraction
from operator import contains
from typing import cast

from serendipity.model import InputError
from serendipity.pddl.parsing.lifted import EQUALITY, Key, Literal, TimedLiteral
from serendipity.pddl.parsing.scope import TOTAL_COST, Scope, is_number, number
from serendipity.pddl.parsing.tree import SExpression, expected, node_at, quoted, refuse_more, shown
from serendipity.pddl.parsing.types import Type
from serendipity.pddl.work import Work


@dataclass(slots=True)
class Initial:
    """The contents of a section ``(:init ...)``; see :class:`~serendipity.pddl.parsing.lifted.Problem`."""

    true: dict[Key, None] = field(default_factory=dict)
    false: dict[Key, int] = field(default_factory=dict)
    values: dict[Key, Fraction] = field(default_factory=dict)
    timed: list[TimedLiteral] = field(default_factory=list)


def read_initial(section: SExpression, scope: Scope, work: Work) -> Initial:
    """The initial state that a section describes."""
    initial = Initial()
    fitting = _Fitting(scope)
    for i in work.deadline.each(range(1, len(section.items))):
        node = node_at(section, i, "an atom")
        key = fitting.atom(node)
        if key is not None:
            initial.true[key] = None
        else:
            _add_other(initial, node, scope)
    for key, line in initial.false.items():
        if key in initial.true:
            raise InputError(f"{quoted(' '.join(key))} is both true and false", line=line)
    return initial


class _Fitting:
    """Atoms of objects, looked up quickly: most of a large file is made of them."""

    def __init__(self, scope: Scope) -> None:
        self._scope = scope
        self._objects: dict[Type, frozenset[str]] = {}
        self._signatures: dict[str, list[frozenset[str]]] = {}

    def atom(self, node: SExpression) -> Key | None:
        """The atom of a node, None where it is not a correct one."""
        head, *terms = node.items or [""]
        if not isinstance(head, str) or head not in self._scope.predicates:
            return None
        fitting = self._signatures.get(head)
        if fitting is None:
            fitting = self._signatures[head] = [*map(self._of_type, self._scope.predicates[head])]
        if len(terms) != len(fitting) or not all(map(contains, fitting, terms)):
            return None
        return cast(Key, tuple(node.items))

    def _of_type(self, kind: Type) -> frozenset[str]:
        found = self._objects.get(kind)
        if found is None:
            fits = self._scope.types.is_subtype
            names = (name for name, own in self._scope.objects.items() if fits(own, kind))
            found = self._objects[kind] = frozenset(names)
        return found


def _add_other(initial: Initial, node: SExpression, scope: Scope) -> None:
    """Add what is no atom, or complain."""
    if node.head == EQUALITY:
        _add_value(initial.values, node, scope)
    elif node.head == "not":
        refuse_more(node, 2)
        initial.false.setdefault(scope.atom(node_at(node, 1, "an atom")), node.line)
    elif len(node.items) == 3 and is_number(node.items[1]) and isinstance(node.items[2], SExpression):
        initial.timed.append(_timed(node, node.items[2], scope))
    else:
        initial.true[scope.atom(node)] = None


def _timed(node: SExpression, effect: SExpression, scope: Scope) -> TimedLiteral:
    """The timed literal ``(at 30 (not (open shop)))``."""
    if node.head != "at":
        raise expected("'(at TIME LITERAL)'", node, 0)
    time = number(str(node.items[1]), node.line_of(1))
    if time <= 0:
        raise InputError(f"expected a time above 0, got {float(time):g}", line=node.line_of(1))
    if effect.head == EQUALITY:
        raise InputError(f"timed initial fluents ({shown(node)}) are not supported", line=node.line)
    if effect.head == "not":
        refuse_more(effect, 2)
        atom = scope.atom(node_at(effect, 1, "an atom"))
    else:
        atom = scope.atom(effect)
    return TimedLiteral(time, Literal(atom, effect.head != "not"), node.line)


def _add_value(values: dict[Key, Fraction], node: SExpression, scope: Scope) -> None:
    refuse_more(node, 3)
    function = node_at(node, 1, "a function")
    word = node.items[2] if len(node.items) > 2 else None
    if isinstance(word, str) and word in scope.objects and not is_number(word):
        raise InputError(f"object fluents ({shown(node)}) are not supported", line=node.line)
    if not isinstance(word, str):
        raise expected("a number", node, 2)
    value = number(word, node.line_of(2))
    if function.items == [TOTAL_COST]:  # where it starts has no effect on what plans cost
        return
    key = scope.atom(function, "function")
    if values.setdefault(key, value) != value:
        raise InputError(f"{quoted(' '.join(key))} is given two values", line=function.line)
