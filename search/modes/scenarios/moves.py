"""What the human may do in an epoch beside robots, for all scenarios that share a task (semantics 11).

Scenarios that are not told apart are in one state, so each asks for the same moves, one after another.
"""

from collections.abc import Sequence
from typing import NamedTuple

from search.modes.scenarios.measure import Worths
from search.packed.joint_actions import NOTHING, JointAction, together
from search.packed.successor_generator import Successors


class Move(NamedTuple):
    """What the human does, joint actions included, what the epoch is worth, and the state after it."""

    part: JointAction
    worth: int
    state: int


class Moves:
    """The moves of one task."""

    def __init__(self, successors: Successors, worths: Worths) -> None:
        self.successors = successors
        self._worths = worths
        self.fits = successors.due.fits
        self._asked: tuple[int, JointAction] = (-1, NOTHING)
        self._free: list[Move] = []

    def free(self, state: int, beside: JointAction) -> Sequence[Move]:
        """All that the human may do where they follow no plan."""
        if self._asked != (state, beside):
            parts = (part for part in self.successors.free(state) if self.fits(part, beside))
            self._free = [self.together(state, part, beside) for part in parts]
            self._asked = state, beside
        return self._free

    def together(self, state: int, part: JointAction, beside: JointAction) -> Move:
        """What the human does, beside all that others do."""
        done = together(part, beside)
        return Move(part, self._worths.of_key(done.weight), self.successors.due.outcome(state, done))
