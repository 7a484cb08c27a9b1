"""Every option that changes what an answer means (semantics 3), validated in one place."""

import math
from dataclasses import dataclass, field, fields, replace
from fractions import Fraction
from typing import TYPE_CHECKING, Any, Final, Literal

from serendipity.model.errors import UsageError
from serendipity.model.keywords import (
    CHOICES,
    Horizon,
    HumanModel,
    Interference,
    Mode,
    PolicyRule,
    Preservation,
    Risk,
    Suffix,
    Ties,
    require_one_of,
)
from serendipity.model.numbers import exact, unrounded

if TYPE_CHECKING:
    from typing import Unpack

    from serendipity.model.keywords import PlanOptions

INFINITE: Final = "inf"
"""Horizon without an end (composite mode only)."""

MAX_EPOCH: Final = 1_000_000
"""The largest epoch that a horizon or a result may name; the search's cost vectors have room for no more."""

MAX_TIES: Final = 1_000_000_000
"""The most that ``max_ties`` may be: nobody waits for so many plans."""

_FLAGS: Final = {
    "keep_prefix": (True, False),
    "no_block": (True, False, None),
    "nobody_pays": (True, False, None),
    "noticed": (True, False),
}
_LIMITS: Final = {"time_limit": "seconds", "memory_limit": "MiB"}

_LATER: Final = (
    *("memory_limit", "strategies", "waiting_cost", "head_start", "policy", "risk"),
    *("nobody_pays", "leave_free", "leave_price", "disturbance", "max_disturbance", "noticed"),
)
"""Options that results of the first versions do without."""

OF_SCENARIOS: "Final[PlanOptions]" = {"policy": "watching", "risk": "mean"}
"""Options that say something of several scenarios only, and what they are by default."""

_SELDOM: Final[dict[str, object]] = {
    "waiting_cost": 0,
    "head_start": 0,
    **OF_SCENARIOS,
    "nobody_pays": None,
    "leave_free": None,
    "leave_price": None,
    "disturbance": None,
    "max_disturbance": None,
    "noticed": False,
}
"""Options that are written down only where they are not the default, which this is."""


@dataclass(frozen=True, slots=True, repr=False)
class Options:
    """Options in force for one answer; see ``docs/semantics.md`` for each.

    Numbers may be given as int, float, text or Fraction; they are kept exact.

    Attributes:
        mode: one of ``CHOICES["mode"]``.
        discount: in [0, 1]; what is taken off the cost of actions without the human.
        horizon: number of epochs ``T``, ``"inf"``, or None for the length of ``pi_H``.
        window_weight: ``K`` of the objective, cost units per epoch of the window.
        max_window: longest window in epochs, or None.
        suffix: what the human does after the window.
        preservation: Def. 3.1 as its kernel or literally.
        interference: which actions may share an epoch.
        max_cost: reject dearer plans: a number, ``"human"`` for cost(pi_H), or None.
        communication_weight: cost per unit of the human's actions that are not in pi_H.
        keep_prefix: the paper's second (7b), in communication mode.
        human_model: what the human does (semantics 6).
        ties: over the human's optimal plans (semantics 1, 11), or over their choices (semantics 7).
        max_ties: the most optimal human plans that are enumerated, at most :data:`MAX_TIES`.
        waiting_cost: of an epoch in which the human waits before their last action (semantics 10.2).
        head_start: epochs of waiting before the human's plan (semantics 10.2).
        policy: whether robots act on what they see the human do, or commit themselves (semantics 11).
        risk: what is minimised over scenarios (semantics 11).
        nobody_pays: whether help may cost nobody anything (semantics 12); None: beside bystanders.
        leave_free: patterns, by commas, of the facts that help may leave changed (semantics 12); None: all.
        leave_price: patterns of others that it may, each with the price of such a fact.
        disturbance: weights of what disturbs the human, ``"ask=1,meet=1,sight=1"`` (semantics 13).
        max_disturbance: the most that help may disturb the human, or None.
        noticed: whether the human has to see what they leave their plan for (semantics 14).
        no_block: whether robots may leave the human without a plan; None for the default
            of the mode (forbidden under a human model, allowed in assistance).
        time_limit: seconds, or None.
        memory_limit: what the process may have in memory, in MiB, or None.
        strategies: names of those that are tried, or of those that are not, as ``"-NAME"``, apart by commas;
            None for all.

    Raises:
        UsageError: naming the option, what was expected and what was given.
    """

    mode: Mode = "serendipity"
    discount: Fraction = field(default=Fraction(0))
    horizon: Horizon | None = None
    window_weight: Fraction = field(default=Fraction(1000))
    max_window: int | None = None
    suffix: Suffix = "replan"
    preservation: Preservation = "kernel"
    interference: Interference = "paper"
    max_cost: Fraction | Literal["human"] | None = None
    communication_weight: Fraction = field(default=Fraction(0))
    keep_prefix: bool = False
    human_model: HumanModel = "omniscient"
    ties: Ties = "fixed"
    max_ties: int = 1000
    no_block: bool | None = None
    waiting_cost: Fraction = field(default=Fraction(0))
    head_start: int = 0
    policy: PolicyRule = "watching"
    risk: Risk = "mean"
    nobody_pays: bool | None = None
    leave_free: str | None = None
    leave_price: str | None = None
    disturbance: str | None = None
    max_disturbance: Fraction | None = None
    noticed: bool = False
    time_limit: float | None = None
    memory_limit: float | None = None
    strategies: str | None = None

    if TYPE_CHECKING:  # they are made of more than they hold

        def __init__(self, **options: Unpack[PlanOptions]) -> None: ...

    def __post_init__(self) -> None:
        for name, legal in CHOICES.items():
            require_one_of(name, getattr(self, name), legal)
        for name in ("discount", "window_weight", "communication_weight", "waiting_cost"):
            self._set(name, _not_negative(exact(getattr(self, name), name), name))
        if self.discount > 1:
            raise UsageError(f"discount: expected a number in [0, 1], got {float(self.discount):g}")
        if self.max_cost is not None and not _is(self.max_cost, "human"):
            self._set("max_cost", _not_negative(exact(self.max_cost, "max_cost"), "max_cost"))
        for name, legal_flags in _FLAGS.items():
            if not any(getattr(self, name) is flag for flag in legal_flags):
                raise UsageError(f"{name}: expected true or false, got {getattr(self, name)!r:.50}")
        self._check_numbers()

    def _check_numbers(self) -> None:
        self._set("horizon", _horizon(self.horizon))
        if self.horizon == INFINITE and self.mode != "composite":
            raise UsageError(f"horizon: 'inf' is for composite mode only, not for {self.mode}")
        if self.max_window is not None:
            self._set("max_window", _whole(self.max_window, "max_window", least=1))
        self._set("head_start", _whole(self.head_start, "head_start", least=0, most=MAX_EPOCH))
        self._set("max_ties", _whole(self.max_ties, "max_ties", least=1, most=MAX_TIES))
        for name, unit in _LIMITS.items():
            if getattr(self, name) is not None:
                limit = limit_of(name, getattr(self, name), unit)
                self._set(name, None if math.isinf(limit) else limit)
        names = self.strategies
        if names is not None and not (isinstance(names, str) and self.strategy_names):
            raise UsageError(f"strategies: expected names apart by commas, got {names!r:.50}")
        if self.keep_prefix and self.mode != "communication":
            raise UsageError("keep_prefix: is for communication mode only")
        if self.human_model != "omniscient" and self.mode != "serendipity":
            raise UsageError(
                f"human_model: '{self.human_model}' is for serendipity mode only, not for {self.mode}"
            )
        self._check_rule()
        if self.mode != "serendipity":
            for name, value in {"ties": "watched", "policy": "fixed"}.items():
                if getattr(self, name) == value:
                    raise UsageError(f"{name}: '{value}' is for serendipity mode only, not for {self.mode}")

    def _check_rule(self) -> None:
        texts = {
            "leave_free": "patterns apart by commas",
            "leave_price": "patterns with prices, such as dirty *=0.5",
            "disturbance": "weights such as ask=1,meet=1,sight=1",
        }
        for name, expected in texts.items():
            given = getattr(self, name)
            if given is not None and not isinstance(given, str):
                raise UsageError(f"{name}: expected {expected}, got {given!r:.50}")
        if self.max_disturbance is not None:
            most = exact(self.max_disturbance, "max_disturbance")
            self._set("max_disturbance", _not_negative(most, "max_disturbance"))
        for name in ("nobody_pays", "leave_free", "leave_price", "max_disturbance"):
            if getattr(self, name) is None or getattr(self, name) is False:
                continue
            if self.mode == "assistance" or self.human_model != "omniscient":
                raise UsageError(f"{name}: is not known of mode 'assistance', nor of humans who replan")
            if self.horizon == INFINITE:
                raise UsageError(f"{name}: needs a horizon, by which it is to hold")
        if self.noticed:
            self._check_noticed()

    def _check_noticed(self) -> None:
        needed = {"mode": "serendipity", "human_model": "omniscient", "suffix": "replan"}
        for name, value in {**needed, "preservation": "kernel"}.items():
            if getattr(self, name) != value:
                raise UsageError(f"noticed: goes with {name} {value} only")

    def _set(self, name: str, value: object) -> None:
        object.__setattr__(self, name, value)

    @property
    def strict(self) -> bool:
        """Whether interference is strict (semantics 2)."""
        return self.interference == "strict"

    @property
    def strategy_names(self) -> tuple[str, ...]:
        """Names of strategies, some with a minus sign."""
        return tuple(name.strip() for name in (self.strategies or "").split(",") if name.strip())

    @property
    def windowed(self) -> bool:
        """Whether answers have windows (serendipity, or communication that keeps the prefix)."""
        return self.mode == "serendipity" or self.keep_prefix

    def __repr__(self) -> str:
        """The mode, and what is not the default."""
        given = {f.name: _plain(getattr(self, f.name)) for f in fields(self)}
        shown = [f"{f.name}={given[f.name]!r}" for f in fields(self) if getattr(self, f.name) != f.default]
        return f"Options({', '.join(shown)})"

    def to_dict(self) -> dict[str, Any]:
        """JSON form: every option in force; numbers as floats, or as exact texts where no float is exact."""
        given = {f.name: _plain(getattr(self, f.name)) for f in fields(self)}
        return {name: value for name, value in given.items() if value != _SELDOM.get(name, ...)}

    @classmethod
    def from_dict(cls, data: dict[str, Any]) -> "Options":
        """The options that :meth:`to_dict` wrote: each of them, in the form in which it writes them.

        Raises:
            UsageError: an unknown or a missing key, or a value that is not legal.
        """
        if not isinstance(data, dict):
            raise UsageError(f"options: expected an object, got {data!r:.50}")
        known = [f.name for f in fields(cls)]
        for key in data:
            if key not in known:
                raise UsageError(f"options: unknown option {key!r:.50}")
        options = cls(**data)
        for name, value in data.items():
            if not _comes_back(value, getattr(options, name)):
                raise UsageError(f"options: {name}: got {value!r:.50}, which is of another type")
        missing = next((name for name in known if name not in data and name not in _LATER), None)
        if missing is not None:
            raise UsageError(f"options: the option '{missing}' is missing")
        return options

    def but(self, **changes: "Unpack[PlanOptions]") -> "Options":
        """These options with some changed."""
        given: dict[str, Any] = {**changes}
        return replace(self, **given)


def _plain(value: object) -> object:
    return unrounded(value) if isinstance(value, Fraction) else value


def _comes_back(value: object, option: object) -> bool:
    """Whether an option is written in the form in which it was read from JSON."""
    if isinstance(option, Fraction):
        is_text = isinstance(value, str)
        return not is_text or "/" in str(value) or isinstance(unrounded(option), str)
    return value is option or (value == option and not isinstance(value, bool))


def _is(value: object, word: str) -> bool:
    return isinstance(value, str) and value == word


def _not_negative(value: Fraction, name: str) -> Fraction:
    if value < 0:
        raise UsageError(f"{name}: expected a number of at least 0, got {float(value):g}")
    return value


def _whole(value: object, name: str, *, least: int, most: int | None = None) -> int:
    try:
        number = int(str(value))
    except ValueError:
        raise UsageError(f"{name}: expected a whole number, got {value!r:.50}") from None
    if number < least:
        raise UsageError(f"{name}: expected at least {least}, got {number!r:.50}")
    if most is not None and number > most:
        raise UsageError(f"{name}: expected at most {most}, got {number!r:.50}")
    return number


def _horizon(value: object) -> Horizon | None:
    if value is None:
        return None
    if _is(value, INFINITE) or (isinstance(value, float) and value == math.inf):
        return INFINITE
    return _whole(value, "horizon", least=0, most=MAX_EPOCH)


def limit_of(name: str, value: object, unit: str) -> float:
    """A limit as a number of at least 0, or a UsageError."""
    try:
        number = float(str(value))
    except ValueError:
        raise UsageError(f"{name}: expected {unit}, got {value!r:.50}") from None
    if not (number >= 0):
        raise UsageError(f"{name}: expected at least 0 {unit}, got {number:g}")
    return number
