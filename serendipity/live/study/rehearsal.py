"""Scenarios played before anybody else does, by somebody who plays well: what each condition comes to."""

from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass, replace
from statistics import fmean
from typing import Any

from serendipity.execution import Omniscient, Person, Replanner, moment_of
from serendipity.live.play.round import RoundSetting
from serendipity.model.numbers import plain


@dataclass(frozen=True, slots=True)
class RehearsedRound:
    """What a round came to.

    Attributes:
        reached: whether the goal was.
        human_cost: what the person paid.
        cost: what the team paid.
        helped: in how many epochs robots did something.
    """

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
