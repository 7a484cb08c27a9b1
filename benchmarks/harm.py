"""Whom robots harm while it happens: random small tasks, with people in them and without, gone through once.

    python -m benchmarks.harm [--runs N] [--first SEED]

A sixth takes place in time, beside a script, and a sixth among two or three people; robots tidy up by
default.  The person is observant, local or told the plan, follows the canonical or any other of their optimal
plans (who is local the first), and in a fifth of the runs robots fail or are slow.  Who has no plan alone is
left out.  Bystanders have paid who can't do the rest of their plans, or do not have what they want, as they
would with idle robots (semantics 12), once the person is there with help and would be there alone.
"""

from collections import Counter
from collections.abc import Iterable, Mapping
from itertools import zip_longest
from random import Random
from typing import Any

import serendipity
from benchmarks.problems import run
from serendipity import Options, SerendipityError, Task
from serendipity.model.task.plans_in_time import broken_script
from serendipity_testing.generator.among_people import random_call_among
from serendipity_testing.generator.in_time import random_call_in_time
from serendipity_testing.generator.tasks import random_task, varied
from serendipity_testing.oracle import Moment, optimal_human_plan
from serendipity_testing.oracle.moments import OracleWorld
from serendipity_testing.oracle.nobody_pays import LastMomentRule


def main(runs: int = 10_000, first: int = 0) -> None:
    """Go through the runs, and print how many of them there are of each kind."""
    found = Counter(what for seed in range(first, first + runs) for what in harmed(seed))
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
    (row,), (log,) = series.rows, series.logs
    if row.alone is None:
        return ["no plan alone"]
    # Who is told may have a part in robots' own goals, where there is nobody else.
    has_part = human == "omniscient" and task.robot_goal
    kind = "told, beside robots with goals of their own" if has_part else human
    marks = {
        kind: True,
        f"{kind}: paid more than alone": row.human_cost > row.alone,
        f"{kind}: paid less": row.human_cost < row.alone,
        "did not get there": not row.reached,
        "in time": task.needs_time,
        "beside bystanders": bool(task.script.people),
        f"{kind}: bystanders paid": not faults and _bystanders_paid(task, log),
        "left without faults or goals of their own": bool(row.left and not (faults or task.robot_goal)),
    }
    return [what for what, holds in marks.items() if holds]


def _bystanders_paid(task: Task, log: Iterable[Mapping[str, Any]]) -> bool:
    """Whether help keeps somebody from what they would do and get, by brute force."""
    if not task.script.people or broken_script(task):
        return False
    world, epochs = OracleWorld(task), [line["steps"] for line in log if "steps" in line]
    plan = optimal_human_plan(task) or ()
    last = max(len(epochs), task.epochs_of(plan))
    rule = LastMomentRule(world, Options(nobody_pays=True), plan, last)
    now: Moment | None = Moment(task.init)
    for epoch, steps in zip_longest(range(1, last + 1), epochs, fillvalue=()):
        if now is not None:
            ways = [task.named[step["action"]] for step in steps]
            begun = [next((i for i in ids if task.actions[i].applicable(now.state)), ids[0]) for ids in ways]
            now = world.after(now, epoch, begun)
    return now is None or not rule.keeps(now)


def _task(dice: Random, seed: int) -> Task:
    if seed % 6 == 3:
        return random_call_among(2 + seed // 6 % 2, seed).task
    if seed % 3 == 0:
        return random_call_in_time(seed).task
    return varied(dice, random_task(dice)) if seed % 3 == 1 else random_task(dice)


if __name__ == "__main__":
    run(main, __doc__)
