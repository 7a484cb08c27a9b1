"""Help for a person of whom two to five goals are possible, by robots that watch, or commit themselves.

    python -m benchmarks.scenarios [--tables buildings,domains,home] [--stride N] [--limit S] [--jobs N]
        [--record FILE]

Beside both stands what it would be worth to know the goal from the start: the mean of the answers for each.
``buildings``: the 200 buildings, in each two to five rooms, in turn, where triage may be wanted.
``domains``: the smallest problems of each domain of CoDMAP 2015, with two of their goals at a time.
``home``: breakfasts, of which all is wanted, or all but one thing.  Problems that are not there are left out.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from random import Random
from statistics import median
from time import perf_counter
from typing import Any

import typer

import serendipity
from benchmarks.execution import can_alone, candidates_in
from benchmarks.problems import PROBLEMS
from serendipity import Task
from serendipity.evaluation.measuring.record import Record
from serendipity.evaluation.measuring.running import measured
from serendipity.evaluation.measuring.suites import Problem, Roles, folders, problems, roles
from serendipity.evaluation.measuring.tables import as_markdown, grouped, table

DISCOUNT = "0.9"
COUNTS = (2, 3, 4, 5)
SMALLEST = 3
"""Problems of a domain, from its first."""

Goals = list[dict[str, Any]]


@dataclass(frozen=True, slots=True)
class Job:
    """A task and its possible goals.

    Attributes:
        family: the table's line.
        source: a building, a breakfast, or a problem with its roles.
        count: how many goals are possible.
        limit: seconds for each answer.
    """

    family: str
    source: Path | tuple[Problem, Roles]
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
    asked = (job for name in tables.split(",") for job in JOBS[name](stride, limit))
    rows = [(job.family, row) for job, row in measured(asked, done, Record(record), processes=jobs) if row]
    lines = {name: [row for _, row in of] for name, of in grouped(rows, lambda pair: pair[0]).items()}
    print(as_markdown([table(("family",), {(name,): of for name, of in lines.items()}, COLUMNS)]), flush=True)


def done(job: Job) -> dict[str, Any] | None:
    """What each kind of robots comes to; None where the person can reach none of the goals alone."""
    task = _task_of(job)
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


def _task_of(job: Job) -> Task:
    if isinstance(job.source, tuple):
        problem, who = job.source
        return problem.task(who)
    if job.source.is_dir():
        return serendipity.load(job.source, human="commx")
    return serendipity.load_pddl(job.source.with_name("domain.pddl"), job.source, human="ann")


def _goals_of(task: Task, job: Job) -> Goals:
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
    return [_goal(str(number), goal) for number, goal in enumerate(drawn)]


def _goal(name: str, literals: list[str]) -> dict[str, Any]:
    return {"name": name, "goal": literals}


def _buildings(stride: int, limit: float) -> Iterator[Job]:
    suite = PROBLEMS / "usar200"
    for number, folder in enumerate(folders(suite, stride) if suite.is_dir() else []):
        yield Job("buildings", folder, COUNTS[number % len(COUNTS)], limit)


def _domains(stride: int, limit: float) -> Iterator[Job]:
    suite = PROBLEMS / "codmap15"
    found = problems(suite) if suite.is_dir() else []
    for name, of in grouped(found, lambda problem: problem.domain).items():
        first = sorted(of, key=lambda problem: (len(problem.name), problem.name))[:SMALLEST]
        for number, problem in enumerate(first[::stride]):
            who = roles(problem, 2, can_alone)
            if who.alone:
                yield Job(name, (problem, who), COUNTS[number % len(COUNTS)], limit)


def _home(stride: int, limit: float) -> Iterator[Job]:
    found = sorted((PROBLEMS / "home").glob("p*.pddl"))
    for path in found[::stride]:
        for count in COUNTS[:3]:
            yield Job("home", path, count, limit)


JOBS = {"buildings": _buildings, "domains": _domains, "home": _home}


def _proved(policy: str, of: Sequence[dict[str, Any]]) -> str:
    number = sum(row[policy]["status"] == "optimal" for row in of)
    return f"{number} ({100 * number / len(of):.0f} %)"


def _seconds(of: Sequence[dict[str, Any]]) -> str:
    times = sorted(row["watching"]["seconds"] for row in of)
    return f"{median(times):.2f}, {times[-1]:.1f}"


def _closed(of: Sequence[dict[str, Any]]) -> str:
    """The share of what knowing saves beyond committed robots that those who watch save, too."""
    rows = [row for row in of if row["knowing"] is not None and row["watching"]["cost"] is not None]
    gap = sum(row["fixed"]["cost"] - row["knowing"] for row in rows)
    won = sum(row["fixed"]["cost"] - row["watching"]["cost"] for row in rows)
    return f"{won:.2f} of {gap:.2f} ({100 * won / gap:.0f} %)" if gap > 1e-9 else "-"


def _sum(name: str, of: Sequence[dict[str, Any]]) -> str:
    costs = [row[name]["cost"] if isinstance(row[name], dict) else row[name] for row in of]
    return f"{sum(cost for cost in costs if cost is not None):.1f}"


def _dearer(row: dict[str, Any]) -> bool:
    return (row["watching"]["cost"] or 0) > (row["idle"] or 0) + 1e-9


COLUMNS = {
    "calls": len,
    "idle": lambda of: _sum("idle", of),
    "committed": lambda of: _sum("fixed", of),
    "watching": lambda of: _sum("watching", of),
    "knowing": lambda of: _sum("knowing", of),
    "gap closed": _closed,
    "proved": lambda of: _proved("watching", of),
    "proved, committed": lambda of: _proved("fixed", of),
    "median, longest s": _seconds,
    "dearer than idle": lambda of: sum(
        (row["watching"]["cost"] or 0) > (row["idle"] or 0) + 1e-9 for row in of
    ),
}


if __name__ == "__main__":
    main.__doc__ = __doc__
    typer.run(main)
