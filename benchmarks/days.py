"""Days and slow buildings: how long answers take where actions take time.

    python -m benchmarks.days [--seeds N]

A *day* has some thousand epochs: somebody at home has ten things to do, of 5 to 60 epochs each, some of them
only while the shop, the garden or the office is open, and a robot can do half of them.  A *slow building* is
one of ``serendipity generate usar`` in which walks take 3 to 20 epochs.  Processor time.
"""

import time
from collections.abc import Iterator
from dataclasses import replace
from random import Random
from typing import Any, Final

import typer

import serendipity
from benchmarks.problems import building
from serendipity.model import Result, Script, Task, Timing
from serendipity.testing.builders import Builder

_LAST: Final = 1_000
_WAYS: Final = (("bed", "hall"), ("kitchen", "hall"), ("bath", "hall"), ("hall", "garden"), ("hall", "shop"))
_OPEN: Final = ("garden", "shop", "office")


def day(seed: int, activities: int = 10) -> Task:
    """A day at home.

    Args:
        seed: of the dice.
        activities: what there is to do.
    """
    dice = Random(f"day {seed}")
    ways = (*_WAYS, ("shop", "office"))
    places = sorted({place for way in ways for place in way})
    built = Builder(("ann", "robot"), "day")
    for way in ways:
        epochs = dice.randint(3, 20)
        for (here, there), who in ((w, who) for w in (way, way[::-1]) for who in (0, 1)):
            name = built.agents[who]
            pre, effects = f"at_{name}_{here}", f"at_{name}_{there} !at_{name}_{here}"
            built.named(f"walk {name} {here} {there}", (who,), pre, effects, str(epochs), epochs)
    for number in range(activities):
        place, epochs = dice.choice(places), dice.randint(5, 60)
        opened = f"open_{place}" if place in _OPEN else ""
        before = f"done_{dice.randrange(number)}" if number and dice.random() < 0.6 else ""
        for who in (0, 1) if dice.random() < 0.5 else (0,):
            name = built.agents[who]
            pre = f"at_{name}_{place} {opened} {before} / {opened}"
            built.named(f"do {name} {number}", (who,), pre, f"done_{number}", str(epochs), epochs)
    done = " ".join(f"done_{number}" for number in range(activities))
    home = built.task(init="at_ann_bed at_robot_kitchen", goal=done)
    known = {fact for fact in home.facts if fact.startswith("open")}
    return home.with_script(
        Script(facts=[(at, fact) for at, fact in _hours(dice) if fact.strip("!") in known])
    )


def _hours(dice: Random) -> Iterator[tuple[int, str]]:
    for place in _OPEN:
        epoch = dice.randint(50, 300)
        while epoch < _LAST - 150:
            yield epoch, f"open_{place}"
            epoch += dice.randint(60, 200)
            yield epoch, f"!open_{place}"
            epoch += dice.randint(30, 150)


def slowed(task: Task, seed: int) -> Task:
    """A building in which each walk takes 3 to 20 epochs, there as long as back."""
    dice, lengths = Random(f"slow {seed}"), dict[tuple[str, ...], int]()
    actions = []
    for action in task.actions:
        if action.name.startswith("move"):
            way = tuple(sorted(action.name.split()[2:]))
            timing = Timing(lengths.setdefault(way, dice.randint(3, 20)))
            actions.append(replace(action, timing=timing))
        else:
            actions.append(action)
    return replace(task, actions=tuple(actions))


def timed(task: Task, **options: Any) -> tuple[Result, float, float]:
    """The last answer, and the processor time until the first one and until that."""
    began, first, last = time.process_time(), 0.0, None
    for last in serendipity.plan_anytime(task, **options):
        if not first and last.cost is not None:
            first = time.process_time() - began
    assert last is not None
    return last, first, time.process_time() - began


def main(seeds: int = 3, time_limit: float = 120) -> None:
    """Print a line for each."""
    for seed in range(seeds):
        rows = [("day", day(seed))]
        rows += [(f"84 rooms, {r} robots", slowed(building(84, 4, r, seed + 1), seed)) for r in (1, 2)]
        for name, task in rows:
            answer, first, last = timed(task, discount="0.9", time_limit=time_limit)
            print(f"{name}, seed {seed}: {answer.status}, T = {answer.horizon}, {first:.2f} s, {last:.2f} s")


if __name__ == "__main__":
    typer.run(main)
