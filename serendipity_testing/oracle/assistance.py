"""Silent assistance by brute force (semantics 7): every state, every policy; no bound, no cleverness."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from fractions import Fraction
from typing import NamedTuple

from serendipity.model import GroundAction, Task
from serendipity_testing.oracle.alone import Alone
from serendipity_testing.oracle.epochs import State, after, holds, usable
from serendipity_testing.oracle.moments import Moment

Costs = tuple[Fraction, Fraction]

FREE: Costs = (Fraction(0), Fraction(0))


class Reached(NamedTuple):
    """The cost of one of the prime's optimal actions, and the state that it leads to."""

    cost: Fraction
    state: State


class Ply(NamedTuple):
    """One thing that the supporter may do, and what may come of it; none where it ends the game."""

    cost: Fraction
    outcomes: tuple[Reached, ...]


@dataclass(frozen=True)
class Tree:
    """The whole game from ``I``: per state with the supporter to move all its choices."""

    task: Task
    choices: dict[State, list[Ply]]

    def final(self, state: State) -> bool:
        """Whether the prime's goal holds."""
        return holds(self.task.goal, state)


def explore(task: Task, *, fixed: bool, no_block: bool) -> Tree:
    """All states that can come up, whatever the supporter does."""
    alone, robot = Alone(task), task.robots[0]
    idle = GroundAction("noop", (robot,), (), (), (), (), Fraction(0))
    moves = [idle, *(action for action in task.actions if action.participants == (robot,))]
    choices: dict[State, list[Ply]] = {}
    pending = [frozenset(task.init)]
    while pending:
        state = pending.pop()
        if state in choices or holds(task.goal, state):
            continue
        found = choices[state] = []
        for move in moves:
            if usable(move, state):
                choice = _choice(alone, state, move, fixed=fixed, no_block=no_block)
                if choice is not None:
                    found.append(choice)
                    pending.extend(outcome.state for outcome in choice.outcomes)
    return Tree(task, choices)


def _choice(alone: Alone, state: State, move: GroundAction, *, fixed: bool, no_block: bool) -> Ply | None:
    middle = after(state, [move])
    if holds(alone.task.goal, middle):
        return Ply(move.cost, ())
    ways = alone.best(Moment(middle))
    if not ways:
        if no_block and move.name != "noop" and alone.worth(Moment(state)) is not None:
            return None
        return Ply(move.cost, (Reached(Fraction(0), middle),))
    chosen = ways[:1] if fixed else ways
    return Ply(move.cost, tuple(Reached(way.price[0], way.moment.state) for way in chosen))


def by_rounds(tree: Tree, worst: Callable[[list[Costs]], Costs]) -> Costs | None:
    """The least value that is certain within as many rounds as there are states."""
    values: dict[State, Costs] = {}
    for _ in range(len(tree.choices) + 1):
        fresh: dict[State, Costs] = {}
        for state, choices in tree.choices.items():
            found = [_value(tree, choice, values, worst) for choice in choices]
            finite = [value for value in found if value is not None]
            if finite:
                fresh[state] = min(finite)
        values = fresh
    return FREE if tree.final(frozenset(tree.task.init)) else values.get(frozenset(tree.task.init))


def _value(
    tree: Tree, choice: Ply, values: dict[State, Costs], worst: Callable[[list[Costs]], Costs]
) -> Costs | None:
    if not choice.outcomes:
        return (Fraction(0), choice.cost)
    ends: list[Costs | None] = []
    for outcome in choice.outcomes:
        rest = FREE if tree.final(outcome.state) else values.get(outcome.state)
        ends.append(None if rest is None else (rest[0] + outcome.cost, rest[1] + choice.cost))
    known = [end for end in ends if end is not None]
    if not known or (worst is not min and len(known) < len(ends)):
        return None
    return worst(known)


def mean_over_all_policies(tree: Tree, most: int) -> Costs | str | None:
    """The least mean over all policies; ``"too many"`` if there are more than ``most``."""
    start = frozenset(tree.task.init)
    if tree.final(start):
        return FREE
    best: Costs | None = None
    for count, policy in enumerate(_policies(tree, {}, [start])):
        if count >= most:
            return "too many"
        value = _mean(tree, policy, start)
        if value is not None and (best is None or value < best):
            best = value
    return best


def _policies(tree: Tree, policy: dict[State, Ply], pending: list[State]) -> Iterator[dict[State, Ply]]:
    pending = [state for state in pending if state not in policy and not tree.final(state)]
    if not pending:
        yield policy
        return
    state, rest = pending[0], pending[1:]
    for choice in tree.choices[state]:
        yield from _policies(tree, {**policy, state: choice}, rest + [o.state for o in choice.outcomes])


def _mean(tree: Tree, policy: dict[State, Ply], start: State) -> Costs | None:
    """The mean costs of a policy; None if a run may not end."""
    ending = {state for state, choice in policy.items() if not choice.outcomes}
    grows = True
    while grows:
        more = {
            state
            for state, choice in policy.items()
            if any(tree.final(o.state) or o.state in ending for o in choice.outcomes)
        }
        grows = not more <= ending
        ending |= more
    if set(policy) - ending:
        return None
    order = list(policy)
    rows = []
    for state in order:
        row = [Fraction(int(state == other)) for other in order]
        prime, supporter = Fraction(0), policy[state].cost
        outcomes = policy[state].outcomes
        for outcome in outcomes:
            share = Fraction(1, len(outcomes))
            prime += share * outcome.cost
            if not tree.final(outcome.state):
                row[order.index(outcome.state)] -= share
        rows.append([*row, prime, supporter])
    return _solve(rows)[order.index(start)]


def _solve(rows: list[list[Fraction]]) -> list[Costs]:
    """Gauss and Jordan."""
    for i in range(len(rows)):
        pivot = next(k for k in range(i, len(rows)) if rows[k][i])
        rows[i], rows[pivot] = rows[pivot], rows[i]
        rows[i] = [x / rows[i][i] for x in rows[i]]
        for k in range(len(rows)):
            if k != i and rows[k][i]:
                factor = rows[k][i]
                rows[k] = [x - factor * y for x, y in zip(rows[k], rows[i], strict=True)]
    return [(row[-2], row[-1]) for row in rows]
