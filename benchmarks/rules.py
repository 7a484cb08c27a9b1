"""What each rule of help costs, domain by domain: of harming nobody, of leaving nothing changed, and others.

    python -m benchmarks.rules [--smallest N] [--stride N] [--small N] [--limit S] [--jobs N] [--record FILE]

The human wants half of a problem's goals.  ``nobody pays``: a second person, a bystander, wants another goal.
In the buildings robots may be anywhere (``at_robot*``).  A price is what the best answer costs more than the
best without the rule, if both are proved; problems that are not there are left out.
"""

from collections.abc import Iterator, Mapping
from random import Random
from typing import Any, Final, NamedTuple

import serendipity
from benchmarks.problems import PROBLEMS, Record, Source, can_some, load, of_suite, run, usar
from serendipity import Condition, SerendipityError, Task, UsageError
from serendipity.evaluation.measuring.record import measured
from serendipity.evaluation.measuring.tables import Cell, Row, as_markdown, counted, grouped, table, total

RULES: Final[Mapping[str, Mapping[str, Any]]] = {
    "nobody pays": {"nobody_pays": True},
    "nothing left changed": {"leave_free": ""},
    "robots elsewhere only": {"leave_free": "at_robot*"},
    "0.1 for each that is": {"leave_price": "*=0.1"},
    "noticed": {"noticed": True},
    "no disturbance": {"max_disturbance": 0},
}

SMALL: Final[Mapping[str, int]] = {"blocks": 3, "logistics": 3, "switches": 6}
"""Families of random tasks, and how many blocks, parcels, and switches."""


class Job(NamedTuple):
    """A task of a family, under a rule; the seconds of each call."""

    family: str
    rule: str
    source: Source
    limit: float


def main(
    smallest: int = 3,
    stride: int = 4,
    small: int = 100,
    limit: float = 10,
    jobs: int = 1,
    record: Record = None,
) -> None:
    """Measure and print the table."""
    found = measured([*_jobs(smallest, stride, small, limit)], priced, record, processes=jobs)
    rows = [{"family": job.family, "rule": job.rule, **row} for job, row in found if row]
    lines = grouped(rows, lambda row: (row["family"], row["rule"]))
    print(as_markdown([table(("family", "rule"), lines, COLUMNS)]), flush=True)


def _jobs(smallest: int, stride: int, small: int, limit: float) -> Iterator[Job]:
    everywhere = [rule for rule in RULES if rule != "robots elsewhere only"]
    for source in usar(stride):
        yield from (Job("buildings", rule, source, limit) for rule in RULES if rule != "nobody pays")
    for problem, who, source in of_suite(PROBLEMS / "codmap15", can_some, smallest=smallest):
        if who.alone and len(who.robots) > 1:
            yield from (Job(problem.domain, rule, source, limit) for rule in everywhere)
    for family, size in SMALL.items():
        for seed in range(small):
            yield from (Job(f"small {family}", rule, (family, seed, size, 3), limit) for rule in everywhere)


def priced(job: Job) -> Row | None:
    """Both answers; None where the human can't reach half of the goals alone, or the bystander their own."""
    task = load(job.source)
    asked = {"discount": "0.9", "time_limit": job.limit}
    try:
        task = _shared(task, bystander=job.rule == "nobody pays")
        free = serendipity.plan(task, **asked, nobody_pays=False)
        bound = serendipity.plan(task, **asked, **{"nobody_pays": False, **RULES[job.rule]})
    except SerendipityError:
        return None
    if free.status == "infeasible":
        return None
    return {
        "proved": free.status == bound.status == "optimal",
        "alone": free.human_cost,
        "free": free.saving,
        "bound": bound.saving,
    }


def _shared(task: Task, *, bystander: bool) -> Task:
    """The task with half of its goals for the human, and one of the others for a bystander.

    A UsageError where nothing is left for a bystander to want, or they can't reach it alone.
    """
    goals = sorted(task.goal.positive)
    if len(goals) < 2 and not bystander:
        return task
    if len(goals) < 2:
        raise UsageError("nothing is left for a bystander to want")
    dice = Random(task.name)
    wanted = dice.sample(goals, (len(goals) + 1) // 2)
    others = [fact for fact in goals if fact not in wanted]
    task = task.with_goal(Condition(tuple(sorted(wanted))), Condition())
    if not bystander:
        return task
    person, fact = task.agents[task.robots[-1]], task.facts[dice.choice(others)]
    return serendipity.with_bystanders(task, {person: [fact]})


COLUMNS: Final[Mapping[str, Cell]] = {
    "calls": len,
    "proved": counted(lambda row: row["proved"]),
    "alone": total(lambda row: row["proved"] and row["alone"]),
    "saved without": total(lambda row: row["proved"] and row["free"]),
    "saved under it": total(lambda row: row["proved"] and row["bound"]),
    "calls with a price": counted(lambda row: row["proved"] and row["bound"] < row["free"]),
}


if __name__ == "__main__":
    run(main, __doc__)
