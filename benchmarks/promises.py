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

import json
import time
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cache, lru_cache
from itertools import product
from pathlib import Path
from typing import Any

import typer

import serendipity
from benchmarks.execution import DISCOUNT, Source, buildings, on_processor_time, smallest, task_of
from serendipity import Task
from serendipity.evaluation.measuring.record import Record
from serendipity.evaluation.measuring.running import measured
from serendipity.evaluation.measuring.tables import as_markdown, grouped, table
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
    source: Source
    human: str
    faults: str | None
    seed: int
    deadline: float

    @property
    def line(self) -> tuple[str, str, str]:
        """The line of the table that it counts for."""
        return self.domain, self.human, "yes" if self.faults else "no"


def jobs(runs: int, deadline: float) -> Iterator[Job]:
    """As many runs as are wanted, the same number on each line; the lines come again and again."""
    drawn = {domain: smallest(domain) for domain in DOMAINS[1:]}
    folders = buildings(1)
    cells = len(DOMAINS) * len(PEOPLE) * len(FAULTS)
    for seed in range(-(-runs // cells)):
        for domain, human, faults in product(DOMAINS, PEOPLE, FAULTS):
            source: Source
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
def _task(source: Source) -> Task:
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


Found = dict[str, Any]
"""What came of a run."""


def _count(holds: Callable[[Found], bool]) -> Callable[[Sequence[Found]], int]:
    """How many runs are so."""
    return lambda of: sum(map(holds, of))


def _total(name: str) -> Callable[[Sequence[Found]], int]:
    """A figure over all runs."""
    return lambda of: sum(one[name] for one in of)


def _beyond(one: Found) -> float:
    """What somebody who got there paid more than alone."""
    return one["paid"] - one["least"] if one["arrived"] else 0.0


COLUMNS: dict[str, Callable[[Sequence[Found]], object]] = {
    "runs": len,
    "arrived": _total("arrived"),
    "nobody could": _total("out of reach"),
    "missed": _count(lambda one: not one["arrived"] and not one["out of reach"]),
    "less than alone": _count(lambda one: _beyond(one) < -1e-9),
    "more": _count(lambda one: _beyond(one) > 1e-9),
    "saved": lambda of: f"{sum(one['least'] - one['cost'] for one in of if one['arrived']):.1f}",
    "helped": _total("helped"),
    "stopped": _total("stopped"),
    "late epochs": _total("late"),
    "epochs": _total("epochs"),
    "logs replay": _total("replays"),
    "reasons untrue": lambda of: sum(len(one["untrue"]) for one in of),
}


def main(
    runs: int = 2000,
    deadline: float = 0.1,
    seconds: float | None = None,
    processor_time: bool = False,
    record: Path | None = None,
    only_print: bool = False,
) -> None:
    """Run, and print the table."""
    if processor_time:
        on_processor_time()
    started, rows = time.perf_counter(), []
    for job, found in measured(jobs(runs, deadline), done, Record(record), begin=not only_print):
        if found is not None:
            rows.append((job.line, found))
            for complaint in _complaints(found):
                print(f"{' '.join(job.line)} {job.seed}: {complaint}", flush=True)
        if seconds is not None and time.perf_counter() - started > seconds:
            break
    rows.sort(key=lambda pair: DOMAINS.index(pair[0][0]))
    lines = {line: [found for _, found in of] for line, of in grouped(rows, lambda pair: pair[0]).items()}
    lines["all", "", ""] = [found for _, found in rows]
    print(as_markdown([table(("domain", "person", "faults"), lines, COLUMNS)]), end="")


def _complaints(found: Found) -> Iterator[str]:
    """What is wrong about a run."""
    yield from found["untrue"]
    if not (found["replays"] and (found["arrived"] or found["out of reach"])):
        yield str(found)
    if _beyond(found) > 1e-9:
        yield f"paid {found['paid']} instead of {found['least']}"


if __name__ == "__main__":
    main.__doc__ = __doc__
    typer.run(main)
