"""Help for a person of whom two to five goals are possible, by robots that watch, or commit themselves.

    python -m benchmarks.scenarios [--tables buildings,domains,home] [OPTIONS]
    python -m benchmarks.scenarios --tables runs [--limit 0.1] [OPTIONS]

Beside both stands what it would be worth to know the goal from the start: the mean of the answers for each.
Where a policy is proved, no robots that watch close more of the gap (*by the best*).
``buildings``: the 200 buildings, in each two to five rooms, in turn, where triage may be wanted.
``domains``: the smallest problems of each domain of CoDMAP 2015, with two of their goals at a time.
``home``: breakfasts, of which all is wanted, or all but one thing.
``runs``: what help comes to while it happens (``execute``) in the buildings, for one to five goals; the limit
is for each epoch then.  Problems that are not there are left out.
"""

from collections.abc import Callable, Iterator, Sequence
from itertools import product
from random import Random
from statistics import fmean, median
from time import perf_counter
from typing import Any, NamedTuple

import serendipity
from benchmarks.problems import PROBLEMS, Record, Source, can_some, load, of_suite, run, usar
from serendipity import Task
from serendipity.evaluation.measuring.record import measured
from serendipity.evaluation.measuring.tables import Cell, Row, as_markdown, counted, grouped, table, total

DISCOUNT = "0.9"
COUNTS = (2, 3, 4, 5)
SMALLEST = 5
"""Problems of a domain, from its first."""


class Job(NamedTuple):
    """A task of a family, the table's line; how many goals are possible; and seconds for each answer.

    ``person``: who executes it; empty where it is planned only.
    """

    family: str
    source: Source
    count: int
    limit: float
    person: str


def main(
    tables: str = "buildings,domains,home",
    stride: int = 1,
    limit: float | None = None,
    jobs: int = 1,
    record: Record = None,
) -> None:
    """Measure and print the table."""
    runs = tables == "runs"
    seconds = limit or (0.1 if runs else 10)
    asked = (
        Job(family, source, count, seconds, person)
        for name in tables.split(",")
        for family, source, count, person in JOBS[name](stride)
    )
    found = measured(asked, executed if runs else planned, record, processes=jobs)
    rows = [{"family": job.family, "goals": str(job.count), **row} for job, row in found if row]
    names = ("family", "goals")[: 1 + runs]
    lines = grouped(rows, lambda row: tuple(row[name] for name in names))
    print(as_markdown([table(names, lines, RUNS if runs else COLUMNS)]), flush=True)


def planned(job: Job) -> Row | None:
    """What each kind of robots comes to; None where the person can reach none of the goals alone."""
    task = load(job.source)
    goals = _goals_of(task, job)
    asked = {"discount": DISCOUNT, "time_limit": job.limit}
    found: dict[str, Any] = {}
    for policy in ("watching", "fixed"):
        begun = perf_counter()
        result = serendipity.plan(task, goals=goals, policy=policy, **asked)
        if result.status == "infeasible":
            return None
        took = perf_counter() - begun
        found[policy] = {"status": result.status, "cost": result.cost, "seconds": took}
        found["idle"] = None if result.cost is None else result.cost + (result.saving or 0)
    shares = {served.name: served.probability for served in result.goals or ()}
    possible = [goal for goal in goals if goal["name"] in shares]
    singles = {goal["name"]: serendipity.plan(task, goals=[goal], **asked) for goal in possible}
    known = all(single.status == "optimal" for single in singles.values())
    costs = (shares[name] * (single.cost or 0) for name, single in singles.items())
    return found | {"knowing": sum(costs) if known else None}


def executed(job: Job) -> Row | None:
    """A run, and what the paper's plan saves on its task; None where the person has no plan alone."""
    task = load(job.source)
    paper = serendipity.plan(task, discount=DISCOUNT, time_limit=2)
    if paper.human_plan is None:
        return None
    goals = _goals_of(task, job) if job.count > 1 else None
    (run,) = serendipity.execute(task, job.person, deadline=job.limit, discount=DISCOUNT, goals=goals).rows
    saved = (run.alone or 0) - run.cost if run.reached else 0
    return {"promised": paper.saving, "saved": saved, **run.to_dict()}


def _goals_of(task: Task, job: Job) -> list[dict[str, Any]]:
    """The goals that are possible, the same for the same job."""
    dice = Random(f"{task.name} {job.count}")
    positive = sorted(task.facts[i] for i in task.goal.positive)
    others = [f"!{task.facts[i]}" for i in task.goal.negative]
    if job.family == "home":
        left_out = [None, *dice.sample([fact for fact in positive if fact.startswith("on ")], job.count - 1)]
        return [
            {"name": f"without {one}", "goal": [*(f for f in positive if f != one), *others]}
            for one in left_out
        ]
    if len(positive) > 1:
        drawn = [sorted(dice.sample(positive, 2)) for _ in range(job.count)]
        return [{"name": str(number), "goal": goal} for number, goal in enumerate(drawn)]
    form = positive[0].replace("_", " ").split()[:-1]
    like = [f for f in task.facts if f.replace("_", " ").split()[:-1] == form and f != positive[0]]
    return [{"name": fact, "goal": [fact]} for fact in sorted([*positive, *dice.sample(like, job.count - 1)])]


Asked = Iterator[tuple[str, Source, int, str]]


def _buildings(stride: int) -> Asked:
    for number, source in enumerate(usar(stride)):
        yield "buildings", source, COUNTS[number % len(COUNTS)], ""


def _domains(stride: int) -> Asked:
    found = of_suite(PROBLEMS / "codmap15", can_some, smallest=SMALLEST)
    for name, of in grouped(found, lambda each: each[0].domain).items():
        for number, (_, who, source) in enumerate(of[::stride]):
            if who.alone:
                yield name, source, COUNTS[number % len(COUNTS)], ""


def _home(stride: int) -> Asked:
    found = sorted((PROBLEMS / "home").glob("p*.pddl"))
    for path, count in product(found[::stride], COUNTS[:3]):
        yield "home", (str(path.with_name("domain.pddl")), str(path), "ann"), count, ""


def _runs(stride: int) -> Asked:
    for person, count, source in product(("observant", "omniscient"), (1, *COUNTS), usar(stride)):
        yield person, source, count, person


JOBS = {"buildings": _buildings, "domains": _domains, "home": _home, "runs": _runs}


def _share(holds: Callable[[Row], bool]) -> Cell:
    """For how many rows something holds, and the share of them."""

    def cell(of: Sequence[Row]) -> str:
        found = sum(map(holds, of))
        return f"{found} ({100 * found / len(of):.0f} %)"

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


def _mean(name: str) -> Cell:
    def cell(of: Sequence[Row]) -> str:
        found = [row[name] for row in of if row[name] is not None]
        return f"{fmean(found):.1f} ({len(found)} runs)" if found else "-"

    return cell


COLUMNS: dict[str, Cell] = {
    "calls": len,
    "idle": total(lambda row: row["idle"]),
    "committed": total(lambda row: row["fixed"]["cost"]),
    "watching": total(lambda row: row["watching"]["cost"]),
    "knowing": total(lambda row: row["knowing"]),
    "gap closed": _closed,
    "by the best": lambda of: _closed([row for row in of if row["watching"]["status"] == "optimal"]),
    "proved": _share(lambda row: row["watching"]["status"] == "optimal"),
    "proved, committed": _share(lambda row: row["fixed"]["status"] == "optimal"),
    "median, longest s": _seconds,
    "dearer than idle": counted(lambda row: (row["watching"]["cost"] or 0) > (row["idle"] or 0) + 1e-9),
}

RUNS: dict[str, Cell] = {
    "runs": len,
    "goal reached": _share(lambda row: row["reached"]),
    "paid more than alone": _share(lambda row: row["reached"] and row["human_cost"] > (row["alone"] or 0)),
    "saved": total(lambda row: row["saved"]),
    "of what the paper's plans save": total(lambda row: row["promised"]),
    "plans spoilt": counted(lambda row: row["spoilt"]),
    "late epochs": lambda of: f"{sum(row['late'] for row in of)} of {sum(row['epochs'] for row in of)}",
    "without a proof": counted(lambda row: row["open"]),
    "most probable from epoch": _mean("leads"),
    "0.9 from epoch": _mean("known"),
    "acted on a wrong guess": lambda of: f"{sum(row['wrong'] for row in of)} epochs",
}


if __name__ == "__main__":
    run(main, __doc__)
