"""Where the human may act together with others: near their own plan, if windows are short.

Before the window the human does what is planned, so that their automaton is in a state of ``pi_H`` (of any
optimal plan, where all are asked about at once) when it opens; after it they are alone (semantics 3.1).  So
a joint action is done no further from such a state than a window is long, and no later: whoever takes part
has to be there by then.
"""

from verify.base.subproblem import WINDOW, Subproblem
from verify.programs.agents.product import Automaton
from verify.programs.promising import Windows


def keep_within_windows(question: Subproblem, machine: Automaton) -> Windows | None:
    """Drop the joint moves of the human's automaton that are in no window.

    Args:
        machine: its ``moves`` are replaced.

    Returns:
        Where windows may be; None: they are long, or are not what is asked about.
    """
    longest = longest_window(question)
    if question.rule != WINDOW or question.options.keep_prefix or longest >= question.horizon:
        return None
    windows = _windows(question, machine, longest)
    task, each = question.task, question.deadline.each
    machine.moves = [
        moves if state in windows.last else [move for move in moves if not task.actions[move[0]].joint]
        for state, moves in enumerate(each(machine.moves))
    ]
    return windows


def longest_window(question: Subproblem) -> int:
    """The length of the longest window that the limits allow."""
    longest, epoch = question.horizon, question.prices.epoch
    if question.options.max_window is not None:
        longest = min(longest, question.options.max_window)
    if question.most is not None and epoch:
        longest = min(longest, question.most // epoch)
    return longest


def _windows(question: Subproblem, machine: Automaton, longest: int) -> Windows:
    paid, planned = _prefixes(question, machine)
    layer: dict[int, int] = {}
    for before, states in enumerate(paid):
        layer.update(dict.fromkeys(states, min(before + longest, question.horizon)))
    last = dict(layer)
    for _ in range(longest - 1):
        following: dict[int, int] = {}
        for state, epoch in question.deadline.each(layer.items()):
            for _, target in machine.moves[state]:
                if epoch > max(last.get(target, 0), following.get(target, 0)):
                    following[target] = epoch
        last.update(following)
        layer = following
    return Windows(longest, paid, planned, last)


def _prefixes(
    question: Subproblem, machine: Automaton
) -> tuple[list[dict[int, int]], dict[tuple[int, int], int]]:
    """The states in which a window may open, and the moves before it, whichever plan the human is on."""
    graph, prices = question.any_of, question.prices
    plans = [[[(action, 0)]] for action in question.human_plan] if graph is None else graph.moves
    paid: list[dict[int, int]] = []
    planned: dict[tuple[int, int], int] = {}
    layer = {(0, 0): 0}
    for before, moves in enumerate(plans):
        question.deadline.check()
        here: dict[int, int] = {}
        after: dict[tuple[int, int], int] = {}
        for (state, node), cost in layer.items():
            here[state] = min(cost, here.get(state, cost))
            for action, onward in moves[node]:
                target = next((target for i, target in machine.moves[state] if i == action), None)
                if target is not None:  # else it is on no plan within the limits
                    planned.setdefault((state, action), before)
                    total = cost + prices.team[action] + prices.talk[action]
                    after[target, onward] = min(total, after.get((target, onward), total))
        paid.append(here)
        layer = after
    return paid, planned
