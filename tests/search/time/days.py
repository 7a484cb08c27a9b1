"""Days of some thousand epochs, buildings with slow walks, and robots at work.

Somebody at home has ten things to do, of 5 to 60 epochs each, some of them only while the shop, the garden or
the office is open, and a robot can do half of them.
"""

from collections.abc import Iterator
from contextlib import suppress
from dataclasses import replace
from random import Random
from typing import Final

from serendipity.model import Script, Task, Timing
from serendipity.model.task.course import BrokenPlanError
from serendipity.model.task.passing import epoch_later
from serendipity_testing.builders import Builder

_LAST: Final = 1_000
_WAYS: Final = (("bed", "hall"), ("kitchen", "hall"), ("bath", "hall"), ("hall", "garden"), ("hall", "shop"))
_OPEN: Final = ("garden", "shop", "office")


def day(seed: int, activities: int = 10) -> Task:
    """A day at home."""
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


def with_a_robot_at_work(task: Task, dice: Random) -> Task:
    """The task an epoch later, a robot having begun something that takes longer; as it is where none can."""
    long = [a for a in task.actions if a.timing is not None and task.human not in a.participants]
    possible = [action for action in long if action.applicable(task.init)]
    with suppress(BrokenPlanError):
        return epoch_later(task, [dice.choice(possible)] if possible else [])
    return task
