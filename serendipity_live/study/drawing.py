"""Scenarios of a study: drawn in the paper's building, and played first by somebody who plays well."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import asdict, dataclass, replace
from fractions import Fraction
from functools import cache
from pathlib import Path
from random import Random
from statistics import fmean
from tempfile import TemporaryDirectory
from typing import Any, Final

import networkx as nx

import serendipity
from serendipity.execution import Omniscient, Person, Replanner, moment_of
from serendipity.model import UsageError
from serendipity.model.numbers import plain
from serendipity.scenarios.generate import make_usar
from serendipity.scenarios.usar import Usar, figure2
from serendipity_live.play.labels import labels_for
from serendipity_live.play.round import RoundSetting


@dataclass(frozen=True, slots=True)
class RehearsedRound:
    """What a round came to, and in how many epochs robots helped."""

    reached: bool
    human_cost: float
    cost: float
    helped: int


Rehearsal = Mapping[str, RehearsedRound]
"""A scenario by condition; ``none`` is always played."""


def rehearse(setting: RoundSetting, conditions: Sequence[str]) -> dict[str, RehearsedRound]:
    """A scenario under some conditions, and under ``none``.

    Robots that announce their plan have somebody before them who does their part of it, the others somebody
    who goes the best way that they see, and takes what is offered where that pays.
    """
    names = dict.fromkeys(("none", *conditions))
    return {name: _play(replace(setting, condition=name)) for name in names}


def _play(setting: RoundSetting) -> RehearsedRound:
    run = setting.execution()
    person: Person = Replanner(setting.task, setting.view)
    if setting.condition == "announced":
        person = Omniscient(setting.task)
    most = setting.most_epochs or 1_000
    while not run.done and run.epoch <= most:
        run.step(person.choose(moment_of(run)))
    helped = sum(any(set(s.agents) != {run.human} for s in passed.steps) for passed in run.passed)
    return RehearsedRound(run.done, float(run.human_cost), float(run.cost), helped)


def fault(played: Rehearsal, conditions: Sequence[str]) -> str | None:
    """What a scenario does not show; None where each condition shows what it promises."""
    alone = played["none"].cost
    for name in conditions:
        here = played[name]
        if not here.reached:
            return f"the goal is not reached where robots are {name}"
        if name != "none" and here.cost >= alone:
            return f"{name} robots save nothing"
    if {"silent", "announced"} <= set(conditions) and played["announced"].cost > played["silent"].cost:
        return "announced robots save less than silent ones"
    for i, name in enumerate(conditions):
        for other in conditions[:i]:
            if (played[name].human_cost, played[name].cost) == (played[other].human_cost, played[other].cost):
                return f"{other} and {name} come to the same"
    return None


def report(played: Mapping[str, Rehearsal], conditions: Sequence[str]) -> str:
    """The rehearsals of all scenarios, in words."""
    width = max(map(len, played))
    lines = [f"{'scenario':{width}}  " + "  ".join(f"{name:>16}" for name in conditions)]
    for name, rehearsal in played.items():
        cells = [f"{plain(rehearsal[c].human_cost)} / {plain(rehearsal[c].cost)}" for c in conditions]
        lines.append(f"{name:{width}}  " + "  ".join(f"{cell:>16}" for cell in cells))
    lines.append("(what somebody pays who plays well / what the team pays)")
    for condition in conditions:
        helped = sum(rehearsal[condition].helped > 0 for rehearsal in played.values())
        saved = fmean(r["none"].cost - r[condition].cost for r in played.values())
        spared = fmean(r["none"].human_cost - r[condition].human_cost for r in played.values())
        lines.append(
            f"condition {condition} helps in {helped} of {len(played)}, saves {saved:.3g} in the mean"
            f" ({spared:.3g} for the person)"
        )
    return "\n".join(lines) + "\n"


def to_dict(rehearsal: Rehearsal) -> dict[str, Any]:
    """A rehearsal for JSON."""
    return {name: asdict(played) for name, played in rehearsal.items()}


def places(conditions: Sequence[str], rounds: int, seed: int) -> Iterator[tuple[str, int]]:
    """The places of a study, one after another: a condition, and a row of :func:`order`.

    In every block each condition has each row once.  Within it, conditions come in groups, drawn in their
    order and in their size, that hold each of them once or twice: so nobody can tell the next one from those
    before, and the numbers are never far apart.
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
        **how: fields of :class:`.setting.RoundSetting`.
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
