"""Where the human may act together with others: near their own plan, if windows are short.

Before the window the human does what is planned, so that their automaton is in a state of ``pi_H`` (of any
optimal plan, where all are asked about at once) when it opens; after it they are alone (semantics 3.1).  So
a joint action is done no further from such a state than a window is long.
"""

from collections.abc import Iterator

from serendipity.model import Task
from verify.base.subproblem import WINDOW, Subproblem
from verify.programs.agents.product import Automaton, Move


def keep_within_windows(question: Subproblem, machine: Automaton) -> None:
    """Drop the joint moves of the human's automaton that are in no window.

    Args:
        question: what is asked.
        machine: its ``moves`` are replaced.
    """
    longest = longest_window(question)
    if question.rule != WINDOW or question.options.keep_prefix or longest >= question.horizon:
        return
    near = _near(question, machine, longest)
    task, each = question.task, question.deadline.each
    machine.moves = [
        moves if state in near else [move for move in moves if not _is_joint(task, move)]
        for state, moves in enumerate(each(machine.moves))
    ]


def longest_window(question: Subproblem) -> int:
    """The length of the longest window that the limits allow."""
    longest, epoch = question.horizon, question.prices.epoch
    if question.options.max_window is not None:
        longest = min(longest, question.options.max_window)
    if question.most is not None and epoch:
        longest = min(longest, question.most // epoch)
    return longest


def _near(question: Subproblem, machine: Automaton, longest: int) -> set[int]:
    """States that the human may be in when an epoch of a window begins."""
    near = layer = set().union(*_opened(question, machine))
    for _ in range(longest - 1):
        question.deadline.check()
        layer = {target for state in layer for _, target in machine.moves[state]} - near
        near = near | layer
    return near


def _opened(question: Subproblem, machine: Automaton) -> Iterator[set[int]]:
    """By epoch, the states in which a window may open before it, whichever plan the human is on."""
    graph = question.any_of
    planned = [[[(action, 0)]] for action in question.human_plan] if graph is None else graph.moves
    layer = {(0, 0)}
    for moves in planned:
        question.deadline.check()
        yield {state for state, _ in layer}
        layer = {
            (target, node)
            for state, before in layer
            for action, node in moves[before]
            for i, target in machine.moves[state]
            if i == action  # else it is on no plan within the limits
        }


def _is_joint(task: Task, move: Move) -> bool:
    return len(task.actions[move[0]].participants) > 1
