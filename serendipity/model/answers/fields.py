"""The JSON form of answers: objects of a class's fields, written and read back by the types of these.

=====================  ===================================================================
type of a field        in JSON
=====================  ===================================================================
``str``, ``bool``      the same
``float``              a finite number of at least 0
``Fraction``           a figure (see :func:`serendipity.model.numbers.figure`)
a pair of ``Fraction`` their exact texts
``tuple[X, ...]``      a list
``dict[str, X]``       an object
``Literal``            one of its values
``X | None``           null, or what ``X`` is
a dataclass            an object of its fields, or what its own ``to_dict`` makes of it
anything else          the same, whatever it is
=====================  ===================================================================

A class declares what differs from that by :func:`form`.
"""

import math
from collections.abc import Callable, Iterable, Mapping
from fractions import Fraction
from functools import cache
from inspect import signature
from types import NoneType, UnionType
from typing import Any, Final, Literal, NamedTuple, TypeVar, Union, get_args, get_origin

from serendipity.model.errors import UsageError
from serendipity.model.numbers import MOST_IN_RESULTS, Figure, as_written, exact, rounded
from serendipity.model.options import MAX_EPOCH
from serendipity.model.task.plans import PlanStep, PlanTimes, Window

T = TypeVar("T")

_KINDS: Final[dict[type, str]] = {
    dict: "an object",
    list: "a list",
    str: "a text",
    int: "a number",
    float: "a number",
    bool: "true or false",
    type(None): "null",
}


class MalformedError(Exception):
    """A part of a file of another form than it should have; the text says which, and what was expected."""


def kind_in_json(value: object) -> str:
    """What JSON calls such a value; what Python does, where JSON has none."""
    return _KINDS.get(type(value), type(value).__name__)


class Form(NamedTuple):
    """The JSON form of some values.

    Attributes:
        read: the value of what stands in a file, given its place there for errors; raises
            :class:`MalformedError`.
        write: what is written for a value; None where that is the value itself.
    """

    read: Callable[[Any, str], Any]
    write: Callable[[Any], Any] | None = None


class Written:
    """A dataclass that is written as a JSON object of its fields."""

    __slots__ = ()

    def to_dict(self) -> dict[str, Any]:
        """The JSON object; plain values only."""
        return written(self)


_SPECIAL: Final[dict[type, dict[str, Form]]] = {}
_CLOSED: Final[set[type]] = set()


def form(kind: type, special: dict[str, Form], *, closed: bool = False) -> None:
    """Declare what of the form of a dataclass does not follow from the types of its fields.

    Args:
        special: forms of fields, by name.
        closed: whether an object has no other fields than the dataclass.
    """
    _SPECIAL[kind] = special
    if closed:
        _CLOSED.add(kind)


def written(value: Any, names: Iterable[str] | None = None) -> dict[str, Any]:
    """The JSON object of a dataclass, or of some of its fields in this order."""
    kind: Any = type(value)
    forms, found = _forms(kind), {}
    for name in forms if names is None else names:
        part, write = getattr(value, name), forms[name].write
        found[name] = part if write is None else write(part)
    return found


def read(kind: Callable[..., T], value: Any, where: str) -> T:
    """The dataclass that a JSON object writes down; fields that have a default may be missing."""
    given, forms = mapping(value, where), _forms(kind)
    if kind in _CLOSED and not (given.keys() <= forms.keys() and given.keys() >= {*_needed(kind)}):
        raise MalformedError(f"{where}: expected an object with {', '.join(forms)} only, got {value!r:.50}")
    names = forms if given.keys() >= forms.keys() else [n for n in forms if n in given or n in _needed(kind)]
    try:
        return kind(**read_fields(kind, given, names, where))
    except UsageError as error:
        raise MalformedError(str(error)) from None


def read_fields(
    kind: Callable[..., Any], given: Mapping[str, Any], names: Iterable[str], where: str = ""
) -> dict[str, Any]:
    """The values of some fields of a dataclass, by name, of an object at that place in a file."""
    forms, found = _forms(kind), {}
    for name in names:
        if name not in given:
            raise MalformedError(f"{where}{': ' if where else ''}the field '{name}' is missing")
        found[name] = forms[name].read(given[name], f"{where}.{name}" if where else name)
    return found


def checked(value: T, where: str, expected: str, fits: bool) -> T:
    """The value itself, if it fits."""
    if not fits:
        raise MalformedError(f"{where}: expected {expected}, got {value!r:.50}")
    return value


def mapping(value: Any, where: str) -> Mapping[str, Any]:
    """An object, or the error that it is none."""
    return checked(value, where, "an object", isinstance(value, Mapping))


def is_whole(value: Any, least: int = 0, most: float = math.inf) -> bool:
    """Whether a JSON value is a whole number in some range."""
    return isinstance(value, int) and not isinstance(value, bool) and least <= value <= most


def finite(value: Any) -> float | None:
    """A JSON number as a float; None where it is none, or has no finite float."""
    if isinstance(value, bool) or not isinstance(value, int | float):
        return None
    try:
        number = value if isinstance(value, Figure) else float(value)
    except OverflowError:
        return None
    return number if math.isfinite(number) else None


def number(value: Any, where: str) -> float:
    """A finite number, or the error that it is none."""
    found = finite(value)
    checked(value, where, "a finite number", found is not None)
    return found or 0.0


def _not_negative(value: Any, where: str) -> float:
    found = number(value, where)
    return checked(found, where, "a number of at least 0", found >= 0)


def _costs(value: Any, where: str) -> tuple[Fraction, ...]:
    """Two costs that were written as exact texts."""
    texts = isinstance(value, list | tuple) and len(value) == 2 and all(isinstance(x, str) for x in value)
    checked(value, where, "the human's and the robot's cost as texts", texts)
    try:
        costs = tuple(exact(text, where, MOST_IN_RESULTS) for text in value)
    except UsageError as error:
        raise MalformedError(str(error)) from None
    checked(value, where, "costs of at least 0", min(costs) >= 0)
    return costs


def _whole(what: str) -> Form:
    words = f"{what} from 1 to {MAX_EPOCH}"
    return Form(lambda value, where: checked(value, where, words, is_whole(value, least=1, most=MAX_EPOCH)))


EPOCH: Final = _whole("an epoch")
EPOCHS: Final = _whole("a number of epochs")

_SIMPLE: Final[dict[Any, Form]] = {
    str: Form(lambda value, where: checked(value, where, "a text", isinstance(value, str))),
    bool: Form(lambda value, where: checked(value, where, "true or false", isinstance(value, bool))),
    float: Form(_not_negative),
    Fraction: Form(lambda value, where: as_written(_not_negative(value, where)), rounded),
    tuple[Fraction, Fraction]: Form(_costs, lambda costs: [str(cost) for cost in costs]),
}


@cache
def form_of(hint: Any) -> Form:
    """The form of a type."""
    if hint in _SIMPLE:
        return _SIMPLE[hint]
    origin, parts = get_origin(hint), get_args(hint)
    if origin in (Union, UnionType) and NoneType in parts and len(parts) == 2:
        return optional(form_of(next(part for part in parts if part is not NoneType)))
    if origin is Literal:
        words = f"one of {', '.join(map(str, parts))}"
        return Form(lambda value, where: checked(value, where, words, value in parts))
    if origin is tuple:
        return list_of(form_of(parts[0]))
    if origin in (dict, Mapping):
        each, write = form_of(parts[1])
        return Form(
            lambda value, where: {k: each(x, f"{where}.{k}") for k, x in mapping(value, where).items()},
            dict if write is None else lambda value: {name: write(part) for name, part in value.items()},
        )
    if hasattr(hint, "__dataclass_fields__") or hasattr(hint, "_fields"):
        return Form(lambda value, where: read(hint, value, where), getattr(hint, "to_dict", written))
    return Form(lambda value, _: value)


@cache
def _forms(kind: Any) -> dict[str, Form]:
    """The forms of a dataclass's fields, by name."""
    special = _SPECIAL.get(kind, {})
    return {n: special.get(n) or form_of(field.annotation) for n, field in signature(kind).parameters.items()}


@cache
def _needed(kind: Any) -> list[str]:
    """The fields without a default."""
    return [name for name, field in signature(kind).parameters.items() if field.default is field.empty]


def list_of(item: Form) -> Form:
    """The form of a list."""

    def read_each(value: Any, where: str) -> tuple[Any, ...]:
        checked(value, where, "a list", isinstance(value, list | tuple))
        return tuple(item.read(each, f"{where}[{i}]") for i, each in enumerate(value))

    write = item.write
    return Form(read_each, list if write is None else lambda values: [write(each) for each in values])


def optional(inner: Form) -> Form:
    """The form of what may be null."""
    write = inner.write
    return Form(
        lambda value, where: None if value is None else inner.read(value, where),
        None if write is None else lambda value: None if value is None else write(value),
    )


form(PlanStep, {"epoch": EPOCH, "duration": EPOCHS}, closed=True)
form(PlanTimes, {"starts": list_of(EPOCH), "durations": list_of(EPOCHS), "epochs": EPOCHS}, closed=True)
form(Window, {"start": EPOCH, "end": EPOCH}, closed=True)
