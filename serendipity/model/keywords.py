"""Options as typed keyword arguments: a checker sees names that no option has, and values that can't be."""

import inspect
from collections.abc import Callable, Iterable
from typing import Any, Final, Literal, TypedDict, TypeVar, get_args

from serendipity.model.errors import UsageError
from serendipity.model.numbers import Number

Horizon = int | Literal["inf"]
Mode = Literal["serendipity", "individual", "communication", "composite", "assistance"]
Suffix = Literal["replan", "subplan"]
Preservation = Literal["kernel", "state"]
Interference = Literal["paper", "strict"]
HumanModel = Literal["omniscient", "observant", "local"]
Ties = Literal["fixed", "robust", "expected", "optimistic", "watched"]
PolicyRule = Literal["watching", "fixed"]
Risk = Literal["mean", "worst", "regret"]

ANYBODY: Final = "any"
"""In the place of the human's name: whoever of those with goals of their own can be helped best."""

CHOICES: Final[dict[str, tuple[str, ...]]] = {
    "mode": get_args(Mode),
    "suffix": get_args(Suffix),
    "preservation": get_args(Preservation),
    "interference": get_args(Interference),
    "human_model": get_args(HumanModel),
    "ties": get_args(Ties),
    "policy": get_args(PolicyRule),
    "risk": get_args(Risk),
}
"""The legal values of the options that are names; the first is the default."""


class InterruptionOptions(TypedDict, total=False):
    """The options that make a difference to windows (semantics 3.2); see :class:`Options`."""

    discount: Number
    horizon: int | float | Literal["inf"] | None
    suffix: Suffix
    preservation: Preservation
    interference: Interference
    waiting_cost: Number
    head_start: int


class AnswerOptions(InterruptionOptions, total=False):
    """Every option that changes what an answer means; see :class:`Options`."""

    mode: Mode
    window_weight: Number
    max_window: int | None
    max_cost: Number | Literal["human"] | None
    communication_weight: Number
    keep_prefix: bool
    human_model: HumanModel
    ties: Ties
    max_ties: int
    no_block: bool | None
    policy: PolicyRule
    risk: Risk
    nobody_pays: bool | None
    leave_free: str | None
    leave_price: str | None
    disturbance: str | None
    max_disturbance: Number | None
    noticed: bool


class PlanOptions(AnswerOptions, total=False):
    """The options of a planning call; see :class:`Options`."""

    time_limit: float | None
    memory_limit: float | None
    strategies: str | None


def require_one_of(name: str, value: object, known: Iterable[str]) -> None:
    """Return if the value of an argument, of whatever type, is one of some words; a UsageError says which."""
    if not (isinstance(value, str) and value in known):
        raise UsageError(f"{name}: expected one of {', '.join(known)}, got {value!r:.50}")


F = TypeVar("F", bound=Callable[..., Any])


def listing(function: F) -> F:
    """A decorator: the options of a ``TypedDict`` stand in the signature, where editors and ``help`` look."""
    signature = inspect.signature(function)
    *named, more = signature.parameters.values()
    (kind,) = get_args(more.annotation)  # of Unpack[...]
    options = [
        more.replace(name=name, kind=more.KEYWORD_ONLY, default=..., annotation=annotation)
        for name, annotation in kind.__annotations__.items()
    ]
    function.__signature__ = signature.replace(parameters=[*named, *options])  # type: ignore[attr-defined]
    return function
