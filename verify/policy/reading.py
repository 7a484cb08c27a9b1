"""A policy as bits, and what the human's choices make of values."""

from fractions import Fraction

from serendipity.model import Policy
from serendipity.model.answers.policy import Decision
from verify.policy.board import Board, Costs, Reply


def read_decisions(board: Board, policy: Policy) -> dict[int, Decision]:
    """What the policy does, by state, or raise a ValueError."""
    listed: dict[int, Decision] = {}
    for decision in board.deadline.each(policy.decisions):
        try:
            state = board.state(decision.state)
        except KeyError as error:
            raise ValueError(f"the task has no fact {error}") from None
        if state in listed:
            raise ValueError(f"two entries for one state, one of them does '{decision.action}'")
        listed[state] = decision
    return listed


def combine(ties: str, values: list[Costs]) -> Costs:
    """The value of a state in which the human chooses (semantics 7)."""
    if ties == "robust":
        return max(values)
    if ties == "expected":
        count, zero = len(values), Fraction(0)
        return sum((v[0] for v in values), zero) / count, sum((v[1] for v in values), zero) / count
    return min(values)


def plus(reply: Reply, rest: Costs) -> Costs:
    """A reply's cost and what follows it."""
    return rest[0] + reply.cost, rest[1]


def show(value: Costs) -> str:
    """A value for people."""
    return f"({value[0]}, {value[1]})"
