"""A closed-loop policy of the supporter in silent assistance (semantics 7), with its certificate."""

from collections.abc import Iterator
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

from serendipity.model.errors import InputError, UsageError
from serendipity.model.numbers import MOST_IN_RESULTS, exact, plain
from serendipity.model.task.actions import NOOP
from serendipity.model.telling import Grid, Line, Told, json_of

Costs = tuple[Fraction, Fraction]
"""The human's total and the supporter's, compared in this order."""


@dataclass(frozen=True, slots=True)
class StateDelta:
    """A state as its difference from the initial one, in the facts that matter to the goal.

    Attributes:
        true: names of facts that hold there and did not initially, ascending.
        false: names of facts that held initially and do not there, ascending.
    """

    true: tuple[str, ...] = ()
    false: tuple[str, ...] = ()

    def to_dict(self) -> dict[str, Any]:
        """The JSON object."""
        return {"true": list(self.true), "false": list(self.false)}


@dataclass(frozen=True, slots=True)
class Decision:
    """What the supporter does in a state in which it is to move.

    Attributes:
        state: the state.
        action: name of the action, or ``noop``.
        value: what the policy still costs from here (its mean, where ties are expected).
    """

    state: StateDelta
    action: str
    value: Costs

    def to_dict(self) -> dict[str, Any]:
        """The JSON object; costs as exact texts."""
        return {**self.state.to_dict(), "action": self.action, "value": _texts(self.value)}


@dataclass(frozen=True, slots=True)
class Floor:
    """A lower bound on the value of a state in which the supporter is to move."""

    state: StateDelta
    value: Costs

    def to_dict(self) -> dict[str, Any]:
        """The JSON object; costs as exact texts."""
        return {**self.state.to_dict(), "value": _texts(self.value)}


@dataclass(frozen=True, slots=True, repr=False)
class Policy(Told):
    """What the supporter does in each state that can be reached while it helps.

    In a state that is not listed it does nothing, and goes on doing nothing for ever.

    Attributes:
        decisions: the initial state's first.
        floors: lower bounds that prove each other, one round at a time; a state that is not
            listed is bounded without search.  None where there were too many to write down.
    """

    decisions: tuple[Decision, ...]
    floors: tuple[Floor, ...] | None

    def to_dict(self) -> dict[str, Any]:
        """The JSON object."""
        floors = None if self.floors is None else [floor.to_dict() for floor in self.floors]
        return {
            "states": [decision.to_dict() for decision in self.decisions],
            "otherwise": NOOP,
            "floors": floors,
        }

    def to_json(self) -> str:
        """The JSON text, as the command line writes it."""
        return json_of(self.to_dict())

    def told(self) -> Iterator[Line | Grid]:
        """The decisions, state by state."""
        states = [
            " ".join((*d.state.true, *(f"!{fact}" for fact in d.state.false))) or "at first"
            for d in self.decisions
        ]
        costs = [", ".join(plain(cost) for cost in d.value) for d in self.decisions]
        actions = [d.action for d in self.decisions]
        yield Grid(("action", "costs to come", "state"), list(zip(actions, costs, states, strict=True)))
        yield Line("in any other state nothing any more")

    def _in_short(self) -> Iterator[str]:
        """What stands between the brackets of its ``repr``."""
        yield f"{len(self.decisions)} states"
        yield from (f"first {first.action!r}" for first in self.decisions[:1])

    @classmethod
    def from_dict(cls, data: Any, file: object = None) -> "Policy":
        """The policy that a JSON object writes down.

        Raises:
            InputError: a field is missing or has the wrong type.
        """
        return _Reader(file).policy(data)


def _texts(value: Costs) -> list[str]:
    return [str(cost) for cost in value]


class _Reader:
    def __init__(self, file: object) -> None:
        self.file = file

    def policy(self, data: Any) -> Policy:
        if not isinstance(data, dict) or data.get("otherwise") != NOOP:
            raise self._error("expected an object with states, otherwise 'noop' and floors")
        floors = data.get("floors")
        decisions = tuple(self._decision(x, f"states[{i}]") for i, x in enumerate(self._list(data, "states")))
        if floors is None:
            return Policy(decisions, None)
        return Policy(
            decisions, tuple(self._floor(x, f"floors[{i}]") for i, x in enumerate(self._list(data, "floors")))
        )

    def _error(self, message: str) -> InputError:
        return InputError(f"result: policy: {message}", self.file)

    def _list(self, data: dict[str, Any], key: str) -> list[Any]:
        value = data.get(key)
        if not isinstance(value, list):
            raise self._error(f"{key}: expected a list, got {value!r:.50}")
        return value

    def _decision(self, data: Any, where: str) -> Decision:
        state = self._state(data, where)
        action = data.get("action")
        if not isinstance(action, str):
            raise self._error(f"{where}.action: expected a text, got {action!r:.50}")
        return Decision(state, action, self._value(data, where))

    def _floor(self, data: Any, where: str) -> Floor:
        return Floor(self._state(data, where), self._value(data, where))

    def _state(self, data: Any, where: str) -> StateDelta:
        if not isinstance(data, dict):
            raise self._error(f"{where}: expected an object, got {data!r:.50}")
        return StateDelta(self._names(data, "true", where), self._names(data, "false", where))

    def _names(self, data: dict[str, Any], key: str, where: str) -> tuple[str, ...]:
        names = self._list(data, key)
        if not all(isinstance(name, str) for name in names) or sorted(set(names)) != names:
            raise self._error(f"{where}.{key}: expected a list of facts, ascending")
        return tuple(names)

    def _value(self, data: dict[str, Any], where: str) -> Costs:
        value = data.get("value")
        if not isinstance(value, list) or len(value) != 2 or not all(isinstance(cost, str) for cost in value):
            raise self._error(
                f"{where}.value: expected the human's and the supporter's cost as texts, got {value!r:.50}"
            )
        try:
            first, second = (exact(cost, f"{where}.value", MOST_IN_RESULTS) for cost in value)
        except UsageError as error:
            raise self._error(str(error)) from None
        if first < 0 or second < 0:
            raise self._error(f"{where}.value: expected costs of at least 0, got {value!r:.50}")
        return first, second
