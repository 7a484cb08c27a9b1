"""Rounds of bounds on the moves of all agents' automata, until none of them drops anything.

A move stays if all of this holds, each of which a plan within the limits satisfies:

* of the human: a path over it is cheap enough together with what robots must have spent for its needs
  (:mod:`.person`), and after the earliest epoch in which it can take place there are enough for the rest;
  what is done together with others can take place while a window may still be open;
* of a robot: what must have been spent when it was done (:mod:`.spending`) is no more than what may have
  been, for anybody to make use of it (:mod:`.use`); and the same for epochs.
"""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Final

from verify.limits import limits
from verify.programs.agents.product import Move
from verify.programs.promising.person import Asked, Level, fewest, levels
from verify.programs.promising.spending import Spending
from verify.programs.promising.team import Team
from verify.programs.promising.use import Use

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
    few = team.count() < limits().many_moves
    if few or 4 * (team.far + max(team.price, default=0)) > limits().weight:
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
    costs = Asked.of(team, spent, offered)
    judged = [_Judged(costs, levels(team, costs, costs))]
    if team.windows is not None:
        earliest = Spending(team, team.robots, lambda i: int(human not in together[i].participants), offered)
        times = Asked.of(team, earliest, offered, by_epoch=True)
        judged.append(_Judged(times, levels(team, times, costs)))
    if not all(each.found for each in judged):
        return False
    _keep_human(team, judged, epochs)
    _keep_robots(team, judged, spent, epochs, price)
    return True


@dataclass(frozen=True, slots=True)
class _Judged:
    """Levels, and what the human's actions ask for of what they are levels of."""

    asked: Asked
    found: list[Level]


def _keep_human(team: Team, judged: list[_Judged], epochs: Spending) -> None:
    human, left = team.task.human, fewest(team)
    kept: list[list[Move]] = []
    for state, moves in enumerate(team.deadline.each(team.moves[human])):
        kept.append(
            [
                (action, target)
                for action, target in moves
                if epochs.arc(human, state, action)
                <= min(team.horizon - left[target], team.last(state, action))
                and _least(team, judged, state, action, target) < team.far
            ]
        )
    team.moves[human] = kept


def _least(team: Team, judged: list[_Judged], state: int, action: int, target: int) -> int:
    """The least price of the human's actions on a path over a move, on levels where it is cheap enough."""
    planned = team.far if team.windows is None else team.windows.planned.get((state, action), team.far)
    return max(_least_of(team, each, planned, state, action, target) for each in judged)


def _least_of(team: Team, judged: _Judged, planned: int, state: int, action: int, target: int) -> int:
    best = team.far
    for level in judged.found:
        if judged.asked.needs[action] <= level.most:
            paid = max(level.done.get(state, team.far), level.ready.get(action, 0))
            path = paid + team.price[action] + level.left.get(target, team.far)
            path = level.total if planned < level.before else path
            if path + level.least <= team.most:
                best = min(best, path)
    return best


def _keep_robots(
    team: Team,
    judged: list[_Judged],
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
            path = _least(team, judged, state, action, target)
            budget[action] = max(budget.get(action, -1), team.most - path)
            last = min(team.horizon - left[target], team.last(state, action))
            latest[action] = max(latest.get(action, -1), last)
    cheapest = max(min(level.total for level in each.found) for each in judged)
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
