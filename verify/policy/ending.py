"""Can the supporter bring the game to an end at all?  By looking at every state."""

from serendipity.model import Deadline
from verify.base.undecided import UndecidedError
from verify.policy.board import Board

_MOST_STATES = 50_000

END = -1

Choices = dict[int, list[list[int]]]
"""Per state with the supporter to move, for each of its moves the states that may follow, or the end."""


def lost_states(board: Board) -> set[int]:
    """States that may come up, with the supporter to move, from which no policy has a value.

    One has a value if its runs end (semantics 7).
    """
    choices = _explore(board)
    if board.ties == "expected":
        return set(choices) - _almost_surely(choices, board.deadline)
    return set(choices) - forced(choices, board.deadline, every=board.ties == "robust")


def _explore(board: Board) -> Choices:
    choices: Choices = {}
    pending = [board.start]
    while pending:
        state = pending.pop()
        if state in choices:
            continue
        board.deadline.check()
        if len(choices) >= _MOST_STATES:
            raise UndecidedError(f"more than {_MOST_STATES} states")
        choices[state] = []
        for _, middle, name in board.moves(state):
            if board.goal.holds(middle):
                choices[state].append([])
            elif not board.blocks(name, state, middle):
                after = [reply.state for reply in board.replies(middle)]
                final = [s for s in after if board.goal.holds(s)]
                choices[state].append([s for s in after if s not in final])
                choices[state][-1] += [END] * bool(final)
                pending.extend(s for s in after if s not in final)
    return choices


def forced(choices: Choices, deadline: Deadline, *, every: bool) -> set[int]:
    """States from which the end is reached; against the human if ``every``, else with them."""
    good, grows, kind = {END}, True, all if every else any
    while grows:
        found = deadline.each(choices.items())
        more = {s for s, moves in found if any(not a or kind(x in good for x in a) for a in moves)}
        grows = not more <= good
        good |= more
    return good


def _almost_surely(choices: Choices, deadline: Deadline) -> set[int]:
    """States from which some policy ends with probability 1."""
    safe = {END, *choices}
    while True:
        left = ((s, moves) for s, moves in deadline.each(choices.items()) if s in safe)
        kept = {s: [a for a in moves if safe.issuperset(a)] for s, moves in left}
        reached = forced(kept, deadline, every=False)
        if reached == safe:
            return safe
        safe = reached
