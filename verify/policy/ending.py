"""Can the supporter bring the game to an end at all?  By looking at every state."""

from serendipity.model import Deadline
from verify.base.undecided import UndecidedError
from verify.policy.board import Board

_MOST_STATES = 50_000

Choices = dict[int, list[list[int]]]
"""Per state with the supporter to move, for each of its moves the states that may follow; none: the end."""


def ends(board: Board, ties: str, *, no_block: bool, deadline: Deadline) -> bool:
    """Whether some policy has a value in ``I`` (semantics 7: one whose runs end).

    Args:
        ties: how the human's choices count.
        no_block: no move may take the human's last plan away.
    """
    if board.goal.holds(board.start):
        return True
    return board.start not in lost_states(board, ties, no_block=no_block, deadline=deadline)


def lost_states(board: Board, ties: str, *, no_block: bool, deadline: Deadline) -> set[int]:
    """States that may come up, with the supporter to move, from which no policy has a value.

    Args:
        ties: how the human's choices count.
        no_block: no move may take the human's last plan away.
    """
    choices = _explore(board, no_block, deadline)
    if ties == "expected":
        return set(choices) - _almost_surely(choices, deadline)
    return set(choices) - _forced(choices, deadline, every=ties == "robust")


def _explore(board: Board, no_block: bool, deadline: Deadline) -> Choices:
    choices: Choices = {}
    pending = [board.start]
    while pending:
        state = pending.pop()
        if state in choices:
            continue
        deadline.check()
        if len(choices) >= _MOST_STATES:
            raise UndecidedError(f"more than {_MOST_STATES} states")
        choices[state] = []
        for _, middle, name in board.moves(state):
            if board.goal.holds(middle):
                choices[state].append([])
            elif not (no_block and name != "noop" and _blocked(board, state, middle)):
                after = [reply.state for reply in board.replies(middle)]
                final = [s for s in after if board.goal.holds(s)]
                choices[state].append([s for s in after if s not in final])
                choices[state][-1] += [-1] * bool(final)
                pending.extend(s for s in after if s not in final)
    return choices


def _blocked(board: Board, state: int, middle: int) -> bool:
    return board.alone(middle) is None and board.alone(state) is not None


def _forced(choices: Choices, deadline: Deadline, *, every: bool) -> set[int]:
    """States from which the end is reached; against the human if ``every``, else with them."""
    good = {-1}
    grows = True
    while grows:
        more = {
            state
            for state, moves in deadline.each(choices.items())
            if any(_leads(after, good, every) for after in moves)
        }
        grows = not more <= good
        good |= more
    return good


def _leads(after: list[int], good: set[int], every: bool) -> bool:
    return not after or (all if every else any)(state in good for state in after)


def _almost_surely(choices: Choices, deadline: Deadline) -> set[int]:
    """States from which some policy ends with probability 1."""
    safe = {-1, *choices}
    while True:
        kept = {
            s: [a for a in moves if safe.issuperset(a)]
            for s, moves in deadline.each(choices.items())
            if s in safe
        }
        reached = _forced(kept, deadline, every=False)
        if reached == safe:
            return safe
        safe = reached
