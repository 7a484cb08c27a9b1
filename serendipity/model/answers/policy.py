"""A closed-loop policy of the supporter in silent assistance (semantics 7), with its certificate."""

from collections.abc import Iterator
from dataclasses import dataclass
from fractions import Fraction
from typing import Any, Final

from serendipity.model.answers.fields import (
    Form,
    MalformedError,
    Written,
    checked,
    form,
    form_of,
    list_of,
    mapping,
    optional,
    read,
    read_fields,
    written,
)
from serendipity.model.errors import InputError
from serendipity.model.numbers import plain
from serendipity.model.task.actions import NOOP
from serendipity.model.telling import Grid, Line, Output

Costs = tuple[Fraction, Fraction]
"""The human's total and the supporter's, compared in this order."""


@dataclass(frozen=True, slots=True)
class StateDelta(Written):
    """A state as its difference from the initial one, in the facts that matter to the goal.

    Attributes:
        true: names of facts that hold there and did not initially, ascending.
        false: names of facts that held initially and do not there, ascending.
    """

    true: tuple[str, ...] = ()
    false: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class Decision:
    """The supporter's action in a state in which it is to move.

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
        return {**self.state.to_dict(), **written(self, ("action", "value"))}


@dataclass(frozen=True, slots=True)
class Floor:
    """A lower bound on the value of a state in which the supporter is to move."""

    state: StateDelta
    value: Costs

    def to_dict(self) -> dict[str, Any]:
        """The JSON object; costs as exact texts."""
        return {**self.state.to_dict(), **written(self, ("value",))}


@dataclass(frozen=True, slots=True, repr=False)
class Policy(Output):
    """The supporter's action in each state that can be reached while it helps.

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
        data = written(self)
        return {"states": data["decisions"], "otherwise": NOOP, "floors": data["floors"]}

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
        yield f"{len(self.decisions)} states"
        yield from (f"first {first.action!r}" for first in self.decisions[:1])

    @classmethod
    def from_dict(cls, data: Any, file: object = None) -> "Policy":
        """The policy that a JSON object writes down.

        Raises:
            InputError: a field is missing or has the wrong type.
        """
        try:
            return read_policy(data, "policy")
        except MalformedError as error:
            raise InputError(f"result: {error}", file) from None


def read_policy(value: Any, where: str) -> Policy:
    """The policy that a part of a file writes down."""
    given = mapping(value, where)
    if given.get("otherwise") != NOOP:
        raise MalformedError(f"{where}: expected an object with states, otherwise '{NOOP}' and floors")
    states = _DECISIONS.read(given.get("states"), f"{where}.states")
    return Policy(states, _FLOORS.read(given.get("floors"), f"{where}.floors"))


def _ascending(value: Any, where: str) -> tuple[str, ...]:
    names: tuple[str, ...] = form_of(tuple[str, ...]).read(value, where)
    return checked(names, where, "facts in ascending order", sorted({*names}) == [*names])


def _decision(value: Any, where: str) -> Decision:
    return Decision(
        read(StateDelta, value, where), **read_fields(Decision, value, ("action", "value"), where)
    )


def _floor(value: Any, where: str) -> Floor:
    return Floor(read(StateDelta, value, where), **read_fields(Floor, value, ("value",), where))


_DECISIONS: Final = list_of(Form(_decision, Decision.to_dict))
_FLOORS: Final = optional(list_of(Form(_floor, Floor.to_dict)))

form(StateDelta, dict.fromkeys(("true", "false"), Form(_ascending, list)))
form(Policy, {"decisions": _DECISIONS, "floors": _FLOORS})
