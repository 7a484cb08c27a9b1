"""Help for a person of whom two to five goals are possible, by robots that watch, or commit themselves.

    python -m benchmarks.scenarios [--tables buildings,domains,home] [--stride N] [--limit S] [--jobs N]
        [--record FILE]

Beside both stands what it would be worth to know the goal from the start: the mean of the answers for each.
``buildings``: the 200 buildings, in each two to five rooms, in turn, where triage may be wanted.
``domains``: the smallest problems of each domain of CoDMAP 2015, with two of their goals at a time.
``home``: breakfasts, of which all is wanted, or all but one thing.  Problems that are not there are left out.
"""

from collections.abc import Callable, Iterator, Mapping, Sequence
from itertools import product
from pathlib import Path
from random import Random
from statistics import median
from time import perf_counter
from typing import Any, NamedTuple

import typer

import serendipity
from benchmarks.problems import PROBLEMS, Source, can_some, candidates_in, load, of_suite, usar
from serendipity import Task
from serendipity.evaluation.measuring.record import measured
from serendipity.evaluation.measuring.tables import as_markdown, grouped, table

DISCOUNT = "0.9"
COUNTS = (2, 3, 4, 5)
SMALLEST = 3
"""Problems of a domain, from its first."""

Row = Mapping[str, Any]


class Job(NamedTuple):
    """A task of a family, the table's line; how many goals are possible; and seconds for each answer."""

    family: str
    source: Source
    count: int
    limit: float


def main(
    tables: str = "buildings,domains,home",
    stride: int = 1,
    limit: float = 10,
    jobs: int = 1,
    record: Path | None = None,
) -> None:
    """Measure and print the table."""
    asked = (Job(*job, limit) for name in tables.split(",") for job in JOBS[name](stride))
    rows = [
        {"family": job.family, **row} for job, row in measured(asked, done, record, processes=jobs) if row
    ]
    lines = grouped(rows, lambda row: (row["family"],))
    print(as_markdown([table(("family",), lines, COLUMNS)]), flush=True)


def done(job: Job) -> Row | None:
    """What each kind of robots comes to; None where the person can reach none of the goals alone."""
    task = load(job.source)
    goals = _goals_of(task, job)
    found: dict[str, Any] = {}
    for policy in ("watching", "fixed"):
        begun = perf_counter()
        result = serendipity.plan(task, goals=goals, policy=policy, discount=DISCOUNT, time_limit=job.limit)
        if result.status == "infeasible":
            return None
        took = perf_counter() - begun
        found[policy] = {"status": result.status, "cost": result.cost, "seconds": took}
        found["idle"] = None if result.cost is None else result.cost + (result.saving or 0)
    singles = [
        (served.probability, serendipity.plan(task, goals=[goal], discount=DISCOUNT, time_limit=job.limit))
        for goal in goals
        for served in result.goals or ()
        if served.name == goal["name"]
    ]
    known = all(single.status == "optimal" for _, single in singles)
    costs = [probability * (single.cost or 0) for probability, single in singles]
    return found | {"knowing": sum(costs) if known else None}


def _goals_of(task: Task, job: Job) -> list[dict[str, Any]]:
    """The goals that are possible, the same for the same job."""
    if job.family == "buildings":
        return candidates_in(task, job.count)
    dice = Random(f"{task.name} {job.count}")
    positive = sorted(task.facts[i] for i in task.goal.positive)
    others = [f"!{task.facts[i]}" for i in task.goal.negative]
    if job.family == "home":
        left_out = [None, *dice.sample([fact for fact in positive if fact.startswith("on ")], job.count - 1)]
        return [
            {"name": f"without {one}", "goal": [*(f for f in positive if f != one), *others]}
            for one in left_out
        ]
    drawn = [sorted(dice.sample(positive, 2)) for _ in range(job.count)]
    return [{"name": str(number), "goal": goal} for number, goal in enumerate(drawn)]


Asked = Iterator[tuple[str, Source, int]]


def _buildings(stride: int) -> Asked:
    for number, source in enumerate(usar(stride)):
        yield "buildings", source, COUNTS[number % len(COUNTS)]


def _domains(stride: int) -> Asked:
    found = of_suite(PROBLEMS / "codmap15", can_some, smallest=SMALLEST)
    for name, of in grouped(found, lambda each: each[0].domain).items():
        for number, (_, who, source) in enumerate(of[::stride]):
            if who.alone:
                yield name, source, COUNTS[number % len(COUNTS)]


def _home(stride: int) -> Asked:
    found = sorted((PROBLEMS / "home").glob("p*.pddl"))
    for path, count in product(found[::stride], COUNTS[:3]):
        yield "home", (str(path.with_name("domain.pddl")), str(path), "ann"), count


JOBS = {"buildings": _buildings, "domains": _domains, "home": _home}


def _proved(policy: str) -> Callable[[Sequence[Row]], str]:
    def cell(of: Sequence[Row]) -> str:
        number = sum(row[policy]["status"] == "optimal" for row in of)
        return f"{number} ({100 * number / len(of):.0f} %)"

    return cell


def _seconds(of: Sequence[Row]) -> str:
    times = [row["watching"]["seconds"] for row in of]
    return f"{median(times):.2f}, {max(times):.1f}"


def _closed(of: Sequence[Row]) -> str:
    """The share of what knowing saves beyond committed robots that those who watch save, too."""
    rows = [row for row in of if row["knowing"] is not None and row["watching"]["cost"] is not None]
    gap = sum(row["fixed"]["cost"] - row["knowing"] for row in rows)
    won = sum(row["fixed"]["cost"] - row["watching"]["cost"] for row in rows)
    return f"{won:.2f} of {gap:.2f} ({100 * won / gap:.0f} %)" if gap > 1e-9 else "-"


def _sum(cost: Callable[[Row], float | None]) -> Callable[[Sequence[Row]], str]:
    return lambda of: f"{sum(cost(row) or 0 for row in of):.1f}"


COLUMNS: dict[str, Callable[[Sequence[Row]], object]] = {
    "calls": len,
    "idle": _sum(lambda row: row["idle"]),
    "committed": _sum(lambda row: row["fixed"]["cost"]),
    "watching": _sum(lambda row: row["watching"]["cost"]),
    "knowing": _sum(lambda row: row["knowing"]),
    "gap closed": _closed,
    "proved": _proved("watching"),
    "proved, committed": _proved("fixed"),
    "median, longest s": _seconds,
    "dearer than idle": lambda of: sum(
        (row["watching"]["cost"] or 0) > (row["idle"] or 0) + 1e-9 for row in of
    ),
}


if __name__ == "__main__":
    main.__doc__ = __doc__
    typer.run(main)
