"""Contents of sections: typed lists, signatures of predicates and functions, actions."""

from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Final, NamedTuple

from serendipity.model import InputError
from serendipity.pddl.parsing.tree import SExpression, expected, name_at, naming, node_at, quoted
from serendipity.pddl.parsing.types import ANYTHING, Type

PRIVATE: Final = ":private"
VARIABLE: Final = "a variable, as ?x"

DURATIVE: Final = ":durative-action"

_PARTS: Final = (":parameters", ":precondition", ":effect")
_DURATIVE_PARTS: Final = (":parameters", ":duration", ":condition", ":effect")


class Typed(NamedTuple):
    """A name or variable, its type, and its line."""

    name: str
    type: Type
    line: int


class Declaration(NamedTuple):
    """A predicate or function, its line, and its parameters."""

    name: str
    line: int
    parameters: list[Typed]


@dataclass(slots=True)
class ActionText:
    """The parts of a section ``(:action ...)`` or ``(:durative-action ...)``.

    Attributes:
        parts: what stands behind ``:parameters``, ``:precondition`` (or ``:duration`` and ``:condition``)
            and ``:effect``.
    """

    name: str
    line: int
    durative: bool = False
    agent: Typed | None = None
    parts: dict[str, SExpression] = field(default_factory=dict)


def typed_list(
    node: SExpression, start: int, what: str, private: int = 0, empty: list[int] | None = None
) -> list[Typed]:
    """``a b - type c``, from item ``start`` of a node.

    Args:
        what: how an error calls its names; ``a variable`` if they begin with ``?``.
        private: where the names in ``(:private ...)`` start; 0 if there may be none.
        empty: takes the lines of types before which no name stands; None where that is an error.
    """
    found: list[Typed] = []
    untyped = 0
    i = start
    while i < len(node.items):
        item = node.items[i]
        if item == "-" and untyped:
            kind = _type_at(node, i + 1)
            found[-untyped:] = [typed._replace(type=kind) for typed in found[-untyped:]]
            untyped, i = 0, i + 2
        elif item == "-" and empty is not None:
            _type_at(node, i + 1)
            empty.append(node.line_of(i))
            i += 2
        elif private and isinstance(item, SExpression) and item.head == PRIVATE:
            found += typed_list(item, private, what, empty=empty)
            untyped, i = 0, i + 1
        else:
            name = _variable_at(node, i) if what == VARIABLE else name_at(node, i, what)
            found.append(Typed(name, ANYTHING, node.line_of(i)))
            untyped, i = untyped + 1, i + 1
    return found


def _variable_at(node: SExpression, i: int) -> str:
    item = node.items[i] if i < len(node.items) else None
    if isinstance(item, str) and item[0] == "?" and len(item) > 1:
        return item
    raise expected(VARIABLE, node, i)


def _type_at(node: SExpression, i: int) -> Type:
    item = node.items[i] if i < len(node.items) else None
    if not isinstance(item, SExpression):
        return (name_at(node, i, "a type"),)
    if item.head != "either" or len(item.items) < 2:
        raise expected("a type or '(either TYPE ...)'", node, i)
    return tuple(dict.fromkeys(name_at(item, j, "a type") for j in range(1, len(item.items))))


def signatures(section: SExpression, what: str) -> Iterator[Declaration]:
    """The predicates or functions of a section, private ones among them, functions without results."""
    i = 1
    while i < len(section.items):
        if section.items[i] == "-" and what == "function":
            if section.items[i + 1 : i + 2] != ["number"]:
                message = "object fluents are not supported: expected '- number'"
                raise InputError(message, line=section.line_of(i))
            i += 2
            continue
        item = node_at(section, i, f"a {what} in brackets")
        if item.head == PRIVATE:  # then, unless the files are factored, an agent: '?a - agent'
            yield from signatures(_without_words(item), what)
        else:
            name = name_at(item, 0, f"the name of a {what}")
            with naming(f"{what} {quoted(name)}"):
                parameters = typed_list(item, 1, VARIABLE)
            yield Declaration(name, item.line, parameters)
        i += 1


def _without_words(private: SExpression) -> SExpression:
    nodes = SExpression(private.line)
    nodes.items = [PRIVATE, *(item for item in private.items if isinstance(item, SExpression))]
    return nodes


def read_action(section: SExpression) -> ActionText:
    """The parts of a section ``(:action ...)`` or ``(:durative-action ...)``."""
    durative = section.head == DURATIVE
    action = ActionText(name_at(section, 1, "the name of an action"), section.line, durative)
    with naming(f"action {quoted(action.name)}"):
        i = 2
        while i < len(section.items):
            i = _read_part(action, section, i)
        if ":effect" not in action.parts:
            raise InputError("expected an ':effect'", line=section.line)
        if durative and ":duration" not in action.parts:
            raise InputError("expected a ':duration'", line=section.line)
    return action


def _read_part(action: ActionText, section: SExpression, i: int) -> int:
    """Read the part at item ``i``; returns where the next one starts."""
    keyword = section.items[i]
    parts = _DURATIVE_PARTS if action.durative else _PARTS
    if not isinstance(keyword, str) or keyword not in (":agent", *parts):
        raise expected(f"{', '.join(map(repr, parts))}", section, i)
    if keyword in action.parts or (keyword == ":agent" and action.agent is not None):
        raise InputError(f"'{keyword}' was given already", line=section.line_of(i))
    if keyword != ":agent":
        action.parts[keyword] = node_at(section, i + 1, f"brackets behind '{keyword}'")
        return i + 2
    end = i + 4 if section.items[i + 2 : i + 3] == ["-"] else i + 2
    words = SExpression(section.line_of(i))
    words.items = section.items[i + 1 : end]
    found = typed_list(words, 0, VARIABLE)
    if not found:
        raise expected(VARIABLE, section, i + 1)
    action.agent = found[0]
    return end
