"""A policy as a plan with branches: after each move of the supporter, what the human may do."""

from typing import NamedTuple

from serendipity.model import Deadline, Result, Task
from verify.policy.board import Board
from verify.policy.reading import read_decisions


class ReplyBranch(NamedTuple):
    """One of the human's optimal actions and where it leads."""

    action: str | None
    """None where the human waits."""
    then: int | None
    """Number of the next state, from 1; None where the supporter idles from then on."""
    ends: bool
    """Whether the goal holds."""


class StateBranch(NamedTuple):
    """A state of the policy: the supporter's action, and what may follow."""

    action: str
    replies: tuple[ReplyBranch, ...]


def branches(task: Task, result: Result) -> list[StateBranch]:
    """The states of a policy in the order in which they are written down, numbered from 1.

    Raises:
        ValueError: the policy is not for this task, or an action of it is not applicable.
    """
    assert result.policy is not None
    board = Board(task, result.options, Deadline())
    listed = read_decisions(board, result.policy)
    numbers = {state: number for number, state in enumerate(listed, start=1)}
    found = []
    for state, decision in listed.items():
        after = next((s for _, s, name in board.moves(state) if name == decision.action), None)
        if after is None:
            raise ValueError(f"the supporter can't do '{decision.action}' where the policy says so")
        replies = [] if board.goal.holds(after) else board.replies(after)
        found.append(
            StateBranch(
                decision.action,
                tuple(ReplyBranch(r.name, numbers.get(r.state), board.goal.holds(r.state)) for r in replies),
            )
        )
    return found
