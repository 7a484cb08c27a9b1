"""Solutions of the game: a policy with bounds on its value."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from fractions import Fraction
from typing import Final, NamedTuple

from serendipity.model.answers.policy import Costs

ZERO: Final[Costs] = (Fraction(0), Fraction(0))

MAX_FLOORS: Final = 20_000
"""Lower bounds that are written down; more would be megabytes."""


class PolicyEntry(NamedTuple):
    """The supporter's action in a state: the value of it, the action, the state after it."""

    value: Costs
    action: int
    after: int


@dataclass(frozen=True, slots=True)
class GameSolution:
    """A policy and what is known of its value.

    Attributes:
        lower: no policy is worth less; None where none ends.
        upper: what this one is worth; None where none was found.
        policy: per packed state with the supporter to move what it does; in a state that is
            not listed it does nothing, for ever.
        floors: lower bounds of packed states with the supporter to move, which prove each other;
            None where they were not asked for, or are too many.
    """

    lower: Costs | None
    upper: Costs | None
    policy: Mapping[int, PolicyEntry] = field(default_factory=dict)
    floors: Mapping[int, Costs] | None = None
