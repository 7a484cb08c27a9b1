"""Draws of a study: balanced conditions and orders, and scenarios in the paper's building."""

from collections.abc import Iterator, Sequence
from fractions import Fraction
from functools import cache
from pathlib import Path
from random import Random
from tempfile import TemporaryDirectory
from typing import Any, Final

import networkx as nx

import serendipity
from serendipity.live.play.labels import labels_for
from serendipity.live.play.round import RoundSetting
from serendipity.live.study.rehearsal import Rehearsal, fault, rehearse
from serendipity.model import UsageError
from serendipity.scenarios.generate import make_usar
from serendipity.scenarios.usar import Usar, figure2


def places(conditions: Sequence[str], rounds: int, seed: int) -> Iterator[tuple[str, int]]:
    """The places of a study, one after another: a condition, and a row of :func:`order`.

    In every block each condition has each row once.  Within it, conditions come in groups, drawn in their
    order and in their size, that hold each of them once or twice: so nobody can tell the next one from those
    before, and the numbers are never far apart.

    Args:
        conditions: to be shared out.
        rounds: of each participant.
        seed: of the draws.
    """
    block = 0
    while True:
        dice = Random(f"{seed} block {block}")
        count = rounds * (1 + rounds % 2)
        rows = {name: dice.sample(range(count), count) for name in conditions}
        while left := len(rows[conditions[0]]):
            group = [*conditions] * min(left, dice.choice((1, 2)))
            dice.shuffle(group)
            yield from ((name, rows[name].pop()) for name in group)
        block += 1


def order(row: int, count: int) -> tuple[int, ...]:
    """A row of a Williams design: over all rows each scenario comes equally often in each place, and
    equally often right behind each other one.

    Args:
        row: from 0; rows begin again behind the last one.
        count: of scenarios; there are as many rows, or twice as many where that is odd.
    """
    zigzag = [0]
    for step in range(1, count):
        zigzag.append((step + 1) // 2 if step % 2 else count - step // 2)
    turned, mirrored = row % count, count % 2 and row // count % 2
    found = tuple((place + turned) % count for place in zigzag)
    return found[::-1] if mirrored else found


_MEDKITS: Final = 4
_TRIES: Final = 100_000
"""Draws for each scenario."""

_LENGTHS: Final = {"scenario": range(9, 17), "practice": range(5, 8)}
"""What the best way alone costs: of a scenario, and of the practice round."""


def draw(
    count: int, seed: int, conditions: Sequence[str], **how: Any
) -> Iterator[tuple[RoundSetting, Rehearsal]]:
    """Scenarios in which conditions show what they promise, with what they come to.

    Args:
        count: how many.
        seed: of the draws.
        conditions: of the study.
        **how: fields of :class:`.setting.RoundSetting`.

    Raises:
        UsageError: there are too few.
    """
    dice, found = Random(f"{seed} scenarios"), set()
    for _ in range(_TRIES * count):
        number = dice.randrange(10**9)
        if number in found or not _promising(_usar(number), how["discount"]):
            continue
        setting = numbered(number, **how)
        played = rehearse(setting, conditions)
        if fault(played, conditions) is None:
            yield setting, played
            found.add(number)
        if len(found) == count:
            return
    raise UsageError(
        f"--discount: at {float(how['discount']):g} too few scenarios show what {conditions} promise"
    )


def practice(seed: int) -> int:
    """The number of a short task to practise with."""
    dice = Random(f"{seed} practice")
    numbers = (dice.randrange(10**9) for _ in range(_TRIES))
    return next(number for number in numbers if _alone(_usar(number))[0] in _LENGTHS["practice"])


def numbered(number: int, **how: Any) -> RoundSetting:
    """The scenario of a number."""
    with TemporaryDirectory(prefix="serendipity-") as folder:
        serendipity.generate_usar(Path(folder), preset="figure2", medkits=_MEDKITS, seed=number)
        task = serendipity.load(folder, human="commx")
    return RoundSetting(f"figure2-{number}", task, labels=labels_for(task), **how)


def _usar(number: int) -> Usar:
    return make_usar(preset="figure2", medkits=_MEDKITS, seed=number)


@cache
def _steps() -> dict[str, dict[str, int]]:
    """How many steps it is from each place to each other one."""
    return dict(nx.all_pairs_shortest_path_length(nx.Graph(figure2().connections)))


def _alone(usar: Usar) -> tuple[int, str]:
    """What the person pays alone, and where the medkit lies that they fetch: moves, picking up, triage."""
    far, start = _steps(), usar.agents_at[0]
    return min((far[start][kit] + far[kit][usar.triage_in] + 2, kit) for kit in usar.medkits_at)


def _promising(usar: Usar, discount: Fraction) -> bool:
    """Whether it is worth playing.

    A robot saves something that meets the person on their way with a kit that they are not about to fetch;
    and it saves more, and spares them more, if it may take the one that they are.
    """
    alone, nearest = _alone(usar)
    if alone not in _LENGTHS["scenario"] or len(set(usar.medkits_at)) < _MEDKITS:
        return False
    far, (start, robot) = _steps(), usar.agents_at
    silent = told = (Fraction(0), 0)  # what the team saves, and what the person is spared
    on_the_way = [p for p in far if far[start][p] + far[p][nearest] == far[start][nearest]]
    for kit in usar.medkits_at:
        for place in on_the_way:
            carried = far[robot][kit] + 1 + far[kit][place]
            if carried <= far[start][place]:
                spared = alone - (far[start][place] + 2 + far[place][usar.triage_in])
                worth = spared - (1 - discount) * carried, spared
                told = max(told, worth)
                silent = max(silent, worth) if kit != nearest else silent
    return told[0] > silent[0] > 0 and told[1] > silent[1]
