"""Whether the loop keeps what it promises: six domains, five kinds of people, with and without faults.

    python -m benchmarks.promises [--runs N] [--deadline S] [--seconds S] [--processor-time]
        [--record FILE [--only-print]]

Buildings, and draws of two goals of five domains of CoDMAP 2015 (see ``benchmarks.execution``); problems
that are not there are left out.  ``recorded`` does without looking what somebody did who followed one of
their optimal plans.  Of each run is asked: whether the person gets there, or it is proved that nobody can
get them there any more; whether they pay more than alone (``noisy``: than with the same
dice where robots do nothing); whether its log replays; and whether each reason of each epoch is true
(see ``tests.execution.reasons``).  Prints a table in Markdown, and what is wrong.
"""

import argparse
import json
import time
from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import cache, lru_cache
from itertools import product
from pathlib import Path
from typing import Any

import serendipity
from benchmarks.execution import DISCOUNT, buildings, on_processor_time, smallest, task_of
from benchmarks.record import Record
from serendipity import Task
from serendipity.evaluation.benchmark.coverage.suite import Problem, Roles
from serendipity.execution import LogLine, replay
from serendipity.model import Condition
from tests.execution.reasons import untrue

DOMAINS = ("buildings", "blocksworld", "driverlog", "rovers", "satellites", "zenotravel")
PEOPLE = ("recorded", "observant", "local", "noisy:0.1", "omniscient")
FAULTS = (None, "fail=0.1,slow=0.1,drop=0.02")

ASKING = 2.0
"""Seconds for each question about a reason."""


@dataclass(frozen=True)
class Job:
    """A run: which task, who the person is, what goes wrong, and the seed of its dice."""

    domain: str
    source: Path | tuple[Problem, Roles, int]
    human: str
    faults: str | None
    seed: int
    deadline: float

    @property
    def line(self) -> tuple[str, str, str]:
        """The line of the table that it counts for."""
        return self.domain, self.human, "yes" if self.faults else "no"

    @property
    def key(self) -> str:
        """What it is found by in a record."""
        return f"{'/'.join(self.line)} {self.seed} in {self.deadline:g} s"


def jobs(runs: int, deadline: float) -> Iterator[Job]:
    """As many runs as are wanted, the same number on each line; the lines come again and again."""
    drawn = {domain: smallest(domain) for domain in DOMAINS[1:]}
    folders = buildings(1)
    cells = len(DOMAINS) * len(PEOPLE) * len(FAULTS)
    for seed in range(-(-runs // cells)):
        for domain, human, faults in product(DOMAINS, PEOPLE, FAULTS):
            source: Path | tuple[Problem, Roles, int]
            if domain == "buildings":
                if not folders:
                    continue
                source = folders[7 * seed % len(folders)]
            elif drawn[domain]:
                source = *drawn[domain][seed % len(drawn[domain])], seed
            else:
                continue
            yield Job(domain, source, human, faults, seed, deadline)


@lru_cache(maxsize=2)
def _task(source: Path | tuple[Problem, Roles, int]) -> Task:
    return task_of(source)


def done(job: Job) -> dict[str, Any] | None:
    """What came of a run; None where the person has no plan alone."""
    task = _task(job.source)
    person: str | list[str] = job.human
    common = {"seed": job.seed, "discount": DISCOUNT, "ties": "drawn"}
    if job.human == "recorded":
        alone = serendipity.execute(task, deadline=0, setup=0, **common)
        person = [event["human"] or "noop" for event in alone.logs[0][1:]]
    runs = serendipity.execute(task, person, deadline=job.deadline, faults=job.faults, **common)
    (row,), (log,) = runs.rows, runs.logs
    if row.alone is None:
        return None
    least = row.alone
    if job.human.startswith("noisy"):
        least = serendipity.execute(task, person, deadline=0, setup=0, **common).rows[0].human_cost
    lines = json.loads(json.dumps(log))
    again = replay(task, [LogLine(number, line) for number, line in enumerate(lines, start=1)])

    @cache
    def alone_from(state: frozenset[int]) -> float | None:
        return serendipity.plan(task.at(state), mode="individual", time_limit=60).cost

    return {
        "arrived": row.reached,
        "out of reach": not row.reached and _out_of_reach(task, log, again.state),
        "paid": row.human_cost,
        "least": least,
        "cost": row.cost,
        "helped": row.helped > 0,
        "stopped": row.stopped > 0,
        "late": row.late,
        "epochs": row.epochs,
        "replays": (again.done, float(again.cost)) == (row.reached, row.cost),
        "untrue": list(untrue(task, lines, alone_from, ASKING)),
    }


def _out_of_reach(task: Task, log: tuple[dict[str, Any], ...], state: frozenset[int]) -> bool:
    """Whether it is proved that nobody who is left can get the person there."""
    gone = {robot for event in log for robot in event.get("drop", ())}
    out = {task.agents.index(robot) for robot in gone}
    kept = tuple(action for action in task.actions if not out.intersection(action.participants))
    left = replace(task.with_goal(task.goal, Condition()), actions=kept).at(state)
    return serendipity.plan(left, mode="composite", horizon="inf", time_limit=60).status == "infeasible"


HEAD = ("domain", "person", "faults", "runs", "arrived", "nobody could", "missed", "less than alone", "more")
MORE = ("saved", "helped", "stopped", "late epochs", "epochs", "logs replay", "reasons untrue")


def cells(found: list[dict[str, Any]]) -> list[object]:
    """What the runs of a line come to."""
    arrived = [one for one in found if one["arrived"]]
    missed = sum(not one["arrived"] and not one["out of reach"] for one in found)
    return [
        len(found),
        len(arrived),
        sum(one["out of reach"] for one in found),
        missed,
        sum(one["paid"] < one["least"] - 1e-9 for one in arrived),
        sum(one["paid"] > one["least"] + 1e-9 for one in arrived),
        f"{sum(one['least'] - one['cost'] for one in arrived):.1f}",
        sum(one["helped"] for one in found),
        sum(one["stopped"] for one in found),
        sum(one["late"] for one in found),
        sum(one["epochs"] for one in found),
        sum(one["replays"] for one in found),
        sum(len(one["untrue"]) for one in found),
    ]


def main() -> None:
    """Run, and print the table."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else None)
    parser.add_argument("--runs", type=int, default=2000, help="at least so many, the same number a line")
    parser.add_argument("--deadline", type=float, default=0.1, help="seconds for each decision")
    parser.add_argument("--seconds", type=float, help="begin no run after so many")
    parser.add_argument("--record", type=Path, help="a file of what is done, which is not done again")
    parser.add_argument("--only-print", action="store_true", help="what is in the record")
    parser.add_argument(
        "--processor-time",
        action="store_true",
        help="deadlines are of processor time, which other programs do not take part of",
    )
    asked = parser.parse_args()
    if asked.processor_time:
        on_processor_time()
    record, started = Record(asked.record), time.perf_counter()
    lines: dict[tuple[str, ...], list[dict[str, Any]]] = {}
    for job in jobs(asked.runs, asked.deadline):
        if job.key not in record and not asked.only_print:
            if asked.seconds is not None and time.perf_counter() - started > asked.seconds:
                break
            record.add(job.key, done(job))
        found = record.get(job.key)
        if found is not None:
            lines.setdefault(job.line, []).append(found)
            for complaint in found["untrue"]:
                print(f"{job.key}: {complaint}", flush=True)
            if not (found["replays"] and (found["arrived"] or found["out of reach"])):
                print(f"{job.key}: {found}", flush=True)
            if found["arrived"] and found["paid"] > found["least"] + 1e-9:
                print(f"{job.key}: paid {found['paid']} instead of {found['least']}", flush=True)
    print(f"\n| {' | '.join((*HEAD, *MORE))} |\n|{'---|' * len((*HEAD, *MORE))}")
    for line, runs in sorted(lines.items(), key=lambda pair: DOMAINS.index(pair[0][0])):
        print(f"| {' | '.join(map(str, (*line, *cells(runs))))} |")
    everything = [run for runs in lines.values() for run in runs]
    print(f"| all | | | {' | '.join(map(str, cells(everything)))} |")


if __name__ == "__main__":
    main()
