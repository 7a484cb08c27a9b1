"""The human's paths in their automaton, where robots have to spend something for some of the actions.

A plan in which the dearest of its needs has made robots spend ``s`` is a path over actions whose needs cost
at most ``s``, and costs that path and ``s``, at least.  So paths are looked at level by level: each has a
limit on what its actions' needs may cost, and adds the least that a path pays which is on no lower level.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from heapq import heappop, heappush
from itertools import pairwise
from typing import Final

from verify.programs.agents.product import Move
from verify.programs.promising.team import FAR, Team

_LEVELS: Final = 10


@dataclass(slots=True)
class Level:
    """The paths that need no more than some amount.

    Attributes:
        least: what robots have spent at least.
        most: what an action's needs may cost.
        done: for each state the least price of a way there; a missing one is not within the limit.
        left: the least price of a way from there to the goal.
        total: the least price of a whole path.
    """

    least: int
    most: int
    done: dict[int, int]
    left: dict[int, int]
    total: int


def levels(team: Team, needs: Mapping[int, int]) -> list[Level]:
    """The levels on which there are paths that are cheap enough.

    Args:
        team: automata, prices, and what may be spent in all.
        needs: what robots have spent at least when each of the human's actions takes place.
    """
    values = sorted({value for value in team.deadline.each(needs.values()) if value <= team.most} | {0})
    backward = team.backward(team.task.human)
    found = []
    for low, high in pairwise(cuts(values)):
        if low >= high:
            continue
        least, most = values[low], values[high - 1]
        level = _level(team, backward, needs, least, most)
        if level.total + least <= team.most:
            found.append(level)
    return found


def cuts(values: Sequence[int]) -> list[int]:
    """Where to divide ascending values into levels, as positions; the first level is without any help."""
    count = min(_LEVELS, len(values))
    found = [len(values) * k // count for k in range(count)] + [len(values)]
    if values[0] == 0 and len(values) > 1 and count > 1:
        found[1] = 1
    return found


def _level(team: Team, backward: list[list[Move]], needs: Mapping[int, int], least: int, most: int) -> Level:
    human = team.task.human
    limit = team.most - least
    forward = team.moves[human]
    left = _distances(team, backward, dict.fromkeys(team.finals[human], 0), needs, most, limit, None)
    total = left.get(0, FAR)
    done = {} if total > limit else _distances(team, forward, {0: 0}, needs, most, limit, left)
    return Level(least, most, done, left, total)


def _distances(
    team: Team,
    edges: list[list[Move]],
    sources: dict[int, int],
    needs: Mapping[int, int],
    most: int,
    limit: int,
    rest: Mapping[int, int] | None,
) -> dict[int, int]:
    """Least prices of ways over actions whose needs cost at most ``most``, within a limit.

    With ``rest``, what is left from a state counts for the limit as well.
    """
    price, best = team.price, dict(sources)
    queue = [(0, state) for state in best]
    while queue:
        team.deadline.tick()
        distance, state = heappop(queue)
        if distance > best[state]:
            continue
        for action, target in edges[state]:
            if needs.get(action, FAR) > most:
                continue
            total = distance + price[action]
            after = 0 if rest is None else rest.get(target, FAR)
            if total + after <= limit and total < best.get(target, FAR):
                best[target] = total
                heappush(queue, (total, target))
    return best


def fewest(team: Team) -> list[int]:
    """For each state of the human's the fewest actions to the end; ``FAR``: there is no way."""
    backward = team.backward(team.task.human)
    found = [FAR] * len(backward)
    layer = list(team.finals[team.task.human])
    for state in layer:
        found[state] = 0
    steps = 0
    while layer:
        steps += 1
        following = []
        for state in team.deadline.each(layer):
            for _, source in backward[state]:
                if found[source] == FAR:
                    found[source] = steps
                    following.append(source)
        layer = following
    return found
