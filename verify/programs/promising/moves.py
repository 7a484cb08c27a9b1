"""Rounds of bounds on the moves of all agents' automata, until none of them drops anything.

A move stays if all of this holds, each of which a plan within the limits satisfies:

* of the human: a path over it is cheap enough together with what robots must have spent for its needs
  (:mod:`.person`), and after the earliest epoch in which it can take place there are enough for the rest;
* of a robot: what must have been spent when it was done (:mod:`.spending`) is no more than what may have
  been, for anybody to make use of it (:mod:`.use`); and the same for epochs.
"""

from collections.abc import Callable
from typing import Final

from verify.programs.agents.product import Move
from verify.programs.promising.person import Level, fewest, levels
from verify.programs.promising.spending import Spending
from verify.programs.promising.team import FAR, Team
from verify.programs.promising.use import Use

MANY_MOVES: Final = 10_000
"""Moves from which on arrays are worth their while."""

_MOST_ROUNDS: Final = 6

Price = Callable[[int], int]
"""Of an action, by id."""

_WORTH: Final = 0.9
"""A round that leaves more than this share of the moves is the last one."""


def keep_promising(team: Team) -> bool:
    """Drop the moves that are on no plan within the limits; False if there is no plan.

    Args:
        team: its ``moves`` are replaced.
    """
    if team.count() < MANY_MOVES:
        return _rounds(team.count, lambda: _round(team))
    from verify.programs.promising.many_moves import ManyMoves  # loads numpy, which few calls need

    many = ManyMoves(team)
    promising = _rounds(many.count, many.round)
    many.write()
    return promising


def _rounds(count: Callable[[], int], one_round: Callable[[], bool]) -> bool:
    before = count()
    for _ in range(_MOST_ROUNDS):
        if not one_round():
            return False
        left = count()
        if left > before * _WORTH:
            break
        before = left
    return True


def _round(team: Team) -> bool:
    human = team.task.human
    everybody = range(len(team.machines))
    epochs = Spending(team, everybody, lambda _: 1)
    offered = team.actions(human)
    together = team.task.actions

    def price(action: int) -> int:
        return 0 if human in together[action].participants else team.price[action]

    spent = Spending(team, team.robots, price, offered)
    needs = {i: max(spent.facts(i), spent.partners(i, human)) for i in team.deadline.each(offered)}
    found = levels(team, needs)
    if not found:
        return False
    _keep_human(team, found, needs, epochs)
    _keep_robots(team, found, needs, spent, epochs, price)
    return True


def _keep_human(team: Team, found: list[Level], needs: dict[int, int], epochs: Spending) -> None:
    human, left = team.task.human, fewest(team)
    kept: list[list[Move]] = []
    for state, moves in enumerate(team.deadline.each(team.moves[human])):
        kept.append(
            [
                (action, target)
                for action, target in moves
                if epochs.arc(human, state, action) + left[target] <= team.horizon
                and _least(team, found, needs[action], state, action, target) < FAR
            ]
        )
    team.moves[human] = kept


def _least(team: Team, found: list[Level], need: int, state: int, action: int, target: int) -> int:
    """The least price of the human's actions on a path over a move, on a level where it is cheap enough."""
    best = FAR
    for level in found:
        if need <= level.most:
            path = level.done.get(state, FAR) + team.price[action] + level.left.get(target, FAR)
            if path + level.least <= team.most:
                best = min(best, path)
    return best


def _keep_robots(
    team: Team,
    found: list[Level],
    needs: dict[int, int],
    spent: Spending,
    epochs: Spending,
    price: Price,
) -> None:
    human = team.task.human
    budget: dict[int, int] = {}
    latest: dict[int, int] = {}
    left = fewest(team)
    for state, moves in enumerate(team.deadline.each(team.moves[human])):
        for action, target in moves:
            path = _least(team, found, needs[action], state, action, target)
            budget[action] = max(budget.get(action, -1), team.most - path)
            latest[action] = max(latest.get(action, -1), team.horizon - left[target])
    cheapest = min(level.total for level in found)
    costs = _use(team, price, budget, 0, team.most - cheapest)
    times = _use(team, lambda _: 1, latest, 1, team.horizon)
    for k in team.robots:
        kept: list[list[Move]] = []
        for state, moves in enumerate(team.deadline.each(team.moves[k])):
            kept.append(
                [
                    (action, target)
                    for action, target in moves
                    if spent.arc(k, state, action) <= costs.arc(k, action, target)
                    and epochs.arc(k, state, action) <= times.arc(k, action, target)
                ]
            )
        team.moves[k] = kept
    team.spare, team.latest = costs.state, times.state


def _use(team: Team, price: Price, human: dict[int, int], before: int, end: int) -> Use:
    """Bounds from what may have been spent when the human's actions take place.

    Args:
        team: automata and needs.
        price: of robots' actions.
        human: by action, what may have been spent after it.
        before: what is taken of it, for what comes before it.
        end: what may have been spent at the end.
    """
    true: dict[int, int] = {}
    false: dict[int, int] = {}
    joint: dict[int, int] = {}
    for action, value in team.deadline.each(human.items()):
        for f in team.pre[action]:
            true[f] = max(true.get(f, -1), value - before)
        for f in team.neg[action]:
            false[f] = max(false.get(f, -1), value - before)
        if len(team.task.actions[action].participants) > 1:
            joint[action] = value
    return Use(team, price, true, false, joint, end)
