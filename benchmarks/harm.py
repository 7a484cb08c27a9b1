"""Whom robots harm while it happens: random small tasks, with people in them and without, gone through once.

    python -m benchmarks.harm [--runs N] [--first SEED]

A third takes place in time, beside a script and bystanders; robots tidy up by default.  The person is
observant, local or told the plan, follows the canonical or any other of their optimal plans (who is local the
first), and in a fifth of the runs robots fail or are slow.  Those without a plan alone are left out.
"""

from collections import Counter
from random import Random

import typer

import serendipity
from serendipity import SerendipityError, Task
from serendipity.testing.generator.in_time import random_call_in_time
from serendipity.testing.generator.tasks import random_task, varied


def main(runs: int = 10_000, first: int = 0) -> None:
    """Go through the runs, and print how many of them there are of each kind."""
    found = Counter[str]()
    for seed in range(first, first + runs):
        found.update(harmed(seed))
    for what, number in sorted(found.items()):
        print(f"{number:6} {what}", flush=True)


def harmed(seed: int) -> list[str]:
    """What is to be counted of a run."""
    dice = Random(seed)
    task, human = _task(dice, seed), dice.choice(["observant", "observant", "omniscient", "local"])
    ties = "drawn" if human != "local" and dice.random() < 0.5 else "fixed"
    faults = "fail=0.2,slow=0.2" if dice.random() < 0.2 else None
    discount = dice.choice(["0", "0.5", "0.9", "1"])
    try:
        series = serendipity.execute(task, human, ties=ties, seed=seed, faults=faults, discount=discount)
    except SerendipityError:
        return ["refused"]
    (row,) = series.rows
    if row.alone is None:
        return ["no plan alone"]
    # Who is told may have a part in robots' own goals, where there is nobody else.
    kind = (
        "told, beside robots with goals of their own" if human == "omniscient" and task.robot_goal else human
    )
    marks = {
        kind: True,
        f"{kind}: paid more than alone": row.human_cost > row.alone,
        f"{kind}: paid less": row.human_cost < row.alone,
        "did not get there": not row.reached,
        "in time": task.needs_time,
        "beside bystanders": bool(task.script.people),
        "left by robots without faults or goals of their own": bool(
            row.left and not (faults or task.robot_goal)
        ),
    }
    return [what for what, holds in marks.items() if holds]


def _task(dice: Random, seed: int) -> Task:
    if seed % 3 == 0:
        return random_call_in_time(seed).task
    task = random_task(dice)
    return varied(dice, task) if seed % 3 == 1 else task


if __name__ == "__main__":
    main.__doc__ = __doc__
    typer.run(main)
