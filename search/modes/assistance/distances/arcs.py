"""Weighted transitions, and what is too many of them."""

from typing import NamedTuple

from search.packed.packed_task import PackedGoal


class ClosureTooLargeError(Exception):
    """The closure of a state is larger than the limit."""


class Arc(NamedTuple):
    """A weighted transition: where it applies, what it keeps and puts, its weight."""

    condition: PackedGoal
    keep: int
    put: int
    weight: int
