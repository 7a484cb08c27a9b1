"""Do the lower bounds of a result prove each other, round by round?

If every floor is at most what each of the supporter's moves and the floors after it make,
no policy whose runs end is worth less than the floor of ``I``.  States without a floor
are bounded by both agents together, without turns.
"""

from fractions import Fraction
from typing import Final

from serendipity.model import Policy
from verify.base.undecided import UNDECIDED, UndecidedError, why
from verify.policy.board import NOTHING, Board, Costs, Reply
from verify.policy.ending import lost_states
from verify.policy.reading import combine, plus

_NOT_PROVED: Final = "a lower bound does not follow from those after '{}'"
_A_LOOK: Final = 300
"""States worth looking at before the human's replies are worked out."""


class Floors:
    """The lower bounds of one result, which its policy comes with."""

    def __init__(self, board: Board, policy: Policy) -> None:
        self._board = board
        self._lost: set[int] | None = None
        floors = board.deadline.each(policy.floors or ())
        self._floors = {board.state(floor.state): floor.value for floor in floors}

    def prove(self, value: Costs) -> None:
        """Return if no policy is worth less than ``value`` in ``I``, or raise an UndecidedError."""
        start = self._board.start
        if self._board.goal.holds(start) or self._board.at_least(start, value):
            return
        if self._floors.get(start, NOTHING) < value:
            raise UndecidedError("the lower bounds that came with the policy do not reach its value")
        for state, floor in self._board.deadline.each(self._floors.items()):
            for cost, middle, name in self._board.moves(state):
                if not self._justified(state, middle, name, cost, floor):
                    self._look_for_lost_states(name)
                    if not self._justified(state, middle, name, cost, floor):
                        raise UndecidedError(_NOT_PROVED.format(name))

    def _look_for_lost_states(self, name: str) -> None:
        """Bounds do not see that a run may never end; looking at every state does."""
        if self._lost is None:
            try:
                self._lost = lost_states(self._board)
            except UNDECIDED as error:
                raise UndecidedError(f"{_NOT_PROVED.format(name)}; {why(error)}") from None

    def _justified(self, state: int, middle: int, name: str, cost: Fraction, floor: Costs) -> bool:
        board = self._board
        if board.goal.holds(middle):
            return floor <= (Fraction(0), cost)
        rest = (floor[0], max(floor[1] - cost, Fraction(0)))
        if rest <= board.count(middle):
            return True
        if board.replies_are_dear and board.at_least(middle, rest, most=_A_LOOK):
            return True
        if board.blocks(name, state, middle):
            return True
        replies = board.replies(middle)
        combined = combine(board.ties, [plus(reply, self._after(reply)) for reply in replies])
        return floor <= (combined[0], combined[1] + cost) or board.at_least(middle, rest)

    def _after(self, reply: Reply) -> Costs:
        board = self._board
        if board.goal.holds(reply.state):
            return NOTHING
        if self._lost is not None and reply.state in self._lost:
            return board.far
        floor = self._floors.get(reply.state)
        return board.bound(reply.state) if floor is None else floor
