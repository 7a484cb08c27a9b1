"""What becomes of help while it happens: many executions with people who do as they like.

    python -m benchmarks.execution [--tables people,domains,goals] [--stride N] [--seeds N] [--jobs N]
        [--processor-time] [--record FILE [--only-print]]

``people``: the 200 buildings, with people who follow the canonical one of their optimal plans, or any.
*Alone* is for ``noisy`` what the same person, with the same dice, pays where robots do nothing.
``domains``: five domains of CoDMAP 2015, each problem with two of its goals, drawn again and again.
With ``--stride 3 --seeds 7`` that is about 1,000 runs of each person whose plans are drawn, in half an
hour of one core.
``goals``: the buildings, where robots do not know in which of 2 to 5 rooms triage is to be conducted.
With ``--record`` what is done is written down at once, and not done again; ``--only-print`` prints what
is there.
Prints tables in Markdown.  Problems that are not there are left out (see ``benchmarks.problems``).
"""

import argparse
import time
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field, replace
from functools import lru_cache
from itertools import product
from multiprocessing import get_context
from pathlib import Path
from random import Random
from typing import Any

import serendipity
from benchmarks.problems import PROBLEMS
from benchmarks.record import Record
from serendipity import SerendipityError, Task
from serendipity.evaluation.benchmark.coverage.suite import Problem, Roles, problems, roles
from serendipity.execution import Run
from serendipity.model import Condition

DISCOUNT = "0.9"
PEOPLE = ("observant", "local", "noisy:0.1", "omniscient")
DOMAINS = ("blocksworld", "driverlog", "rovers", "satellites", "zenotravel")
MOST_GOALS = 5


@dataclass
class Tally:
    """What the runs of one line of a table come to; savings are the team's, summed."""

    promised: float = 0.0
    rows: list[Run] = field(default_factory=list)
    known_from: list[float] = field(default_factory=list)

    def share(self, counts: Callable[[Run], bool]) -> str:
        """The share of the runs for which something holds."""
        number = sum(map(counts, self.rows))
        return f"{100 * number / len(self.rows):.1f} % ({number})" if number else "0"

    @property
    def saved(self) -> float:
        """What the team saved, where the person got there."""
        return sum((row.alone or 0) - row.cost for row in self.rows if row.reached)

    @property
    def in_time(self) -> str:
        """The share of the epochs that had a decision in time."""
        epochs, late = sum(row.epochs for row in self.rows), sum(row.late for row in self.rows)
        return f"{100 * (1 - late / epochs):.2f} % of {epochs}"

    @property
    def open(self) -> str:
        """The share of the epochs with the best plan that was found in time, and no proof."""
        epochs, unproved = sum(row.epochs for row in self.rows), sum(row.open for row in self.rows)
        return f"{100 * unproved / epochs:.1f} %"

    def cells(self) -> list[object]:
        """What all tables have in common."""
        kept = f"{100 * self.saved / self.promised:.0f} %" if self.promised else "-"
        return [
            len(self.rows),
            self.share(lambda row: row.reached),
            *(self.share(better) for better in (_less, _same, _more)),
            f"{self.saved:.1f} of {self.promised:.1f} ({kept})",
            sum(row.spoilt for row in self.rows),
            self.in_time,
            self.open,
        ]


HEAD = (
    "runs",
    "goal reached",
    "less than alone",
    "the same",
    "more",
    "saved of what the paper's plans save",
    "plans spoilt",
    "decided in time",
    "without a proof",
)


def _less(row: Run) -> bool:
    return row.reached and row.human_cost < (row.alone or 0)


def _same(row: Run) -> bool:
    return row.reached and row.human_cost == row.alone


def _more(row: Run) -> bool:
    return row.reached and row.human_cost > (row.alone or 0)


@dataclass(frozen=True)
class Job:
    """Runs on one task.

    Attributes:
        line: of the table that they count for.
        source: a folder; or a problem with its roles, and the seed of its goals.
        human: who the person is.
        ties: which of their plans they follow.
        seeds: how many runs.
        goals: how many goals robots take for possible.
        deadline: seconds.
    """

    line: tuple[str, ...]
    source: Path | tuple[Problem, Roles, int]
    human: str
    ties: str
    seeds: int
    goals: int
    deadline: float

    @property
    def key(self) -> str:
        """What it is found by in a record."""
        if isinstance(self.source, Path):
            what = self.source.name
        else:
            what = f"{self.source[0].domain} {self.source[0].name} {self.source[2]}"
        return (
            f"{'/'.join(self.line)} {what} {self.ties} x{self.seeds} of {self.goals} in {self.deadline:g} s"
        )


def done(job: Job) -> tuple[Job, dict[str, Any] | None]:
    """The paper's saving on the task, and a row a run; None where the person has no plan alone."""
    task, promised = task_of(job.source), _promised(job.source)
    if promised is None:
        return job, None
    candidates = _candidates(task, job.goals) if job.goals > 1 else None
    common = {"runs": job.seeds, "ties": job.ties, "discount": DISCOUNT, "goals": candidates}
    rows = serendipity.execute(task, job.human, deadline=job.deadline, **common).rows
    if job.human.startswith("noisy"):
        idle = serendipity.execute(task, job.human, deadline=0, setup=0, **common).rows
        rows = tuple(replace(row, alone=other.human_cost) for row, other in zip(rows, idle, strict=True))
    return job, {"promised": promised, "rows": [row.to_dict() for row in rows]}


@lru_cache(maxsize=1)
def _promised(source: Path | tuple[Problem, Roles, int]) -> float | None:
    """What the paper's plan saves on a task; None where the person has no plan alone, or nobody knows."""
    result = serendipity.plan(task_of(source), discount=DISCOUNT, time_limit=2)
    return None if result.human_plan is None else result.saving


def task_of(source: Path | tuple[Problem, Roles, int]) -> Task:
    """A building; or a problem with its roles, and two of its goals."""
    if isinstance(source, Path):
        return serendipity.load(source, human="commx")
    problem, who, seed = source
    task = serendipity.load_pddl(
        problem.domain_file, problem.problem_file, human=who.human, robots=who.robots
    )
    wanted = sorted(Random(f"{problem.domain} {problem.name} {seed}").sample(task.goal.positive, 2))
    return task.with_goal(Condition(tuple(wanted), ()))


def _candidates(task: Task, count: int) -> list[dict[str, object]]:
    """The person's goal and others of its form, each as probable as any."""
    (own,) = task.goal.positive
    form = task.facts[own].replace("_", " ").split()[:-1]
    others = [f for f in task.facts if f.replace("_", " ").split()[:-1] == form and f != task.facts[own]]
    chosen = [task.facts[own], *Random(f"{task.name} {count}").sample(others, count - 1)]
    return [{"name": fact, "goal": [fact]} for fact in sorted(chosen)]


def people(stride: int, seeds: int, deadline: float) -> Iterator[Job]:
    """Who the person is, over the buildings."""
    for human in PEOPLE:
        for ties, runs in (("fixed", seeds if human.startswith("noisy") else 1), ("drawn", seeds)):
            for folder in buildings(stride):
                yield Job((human, ties), folder, human, ties, runs, 1, deadline)


def domains(stride: int, seeds: int, deadline: float) -> Iterator[Job]:
    """Other domains."""
    known = {name: smallest(name) for name in DOMAINS}
    for number, name in product(range(0, DRAWS, stride), filter(known.get, DOMAINS)):
        problem, able = known[name][number // stride % len(known[name])]
        for human in PEOPLE:
            for ties, runs in (("fixed", 1), ("drawn", seeds)):
                yield Job((name, human, ties), (problem, able, number), human, ties, runs, 1, deadline)


SMALLEST = 3
"""Problems of a domain, from its first."""

DRAWS = 200
"""Draws of two goals in each domain, problem after problem."""


def smallest(domain: str) -> list[tuple[Problem, Roles]]:
    """A domain's smallest problems that somebody can do alone; none where the domain is not there."""
    suite = PROBLEMS / "codmap15"
    found = problems(suite, [domain]) if suite.is_dir() else []
    first = sorted(found, key=lambda problem: (len(problem.name), problem.name))[:SMALLEST]
    return [(problem, able) for problem in first if (able := _who(problem)) is not None]


def _who(problem: Problem) -> Roles | None:
    """The human who can do it alone, with two of its goals, and two robots."""

    def can_alone(problem: Problem, who: Roles) -> bool:
        try:
            task = task_of((problem, who, 0))
            return serendipity.plan(task, mode="individual", time_limit=60).cost is not None
        except (SerendipityError, ValueError):
            return False

    who = roles(problem, 2, can_alone)
    return who if who.alone else None


def goals(stride: int, _seeds: int, deadline: float) -> Iterator[Job]:
    """How many goals are possible, over the buildings."""
    for count in range(1, MOST_GOALS + 1):
        for folder in buildings(stride):
            yield Job((str(count),), folder, "observant", "fixed", 1, count, deadline)


TABLES = {"people": people, "domains": domains, "goals": goals}
HEADS = {"people": ("person", "plans"), "domains": ("domain", "person", "plans"), "goals": ("goals",)}


def buildings(stride: int) -> list[Path]:
    """Every so many of the 200."""
    suite = PROBLEMS / "usar200"
    named = [path for path in suite.iterdir() if path.is_dir()] if suite.is_dir() else []
    return sorted(named, key=lambda path: (len(path.name), path.name))[::stride]


def main() -> None:
    """Measure and print the tables."""
    arguments = _arguments()
    record = Record(arguments.record)
    for name in arguments.tables.split(","):
        jobs = list(TABLES[name](arguments.stride, arguments.seeds, arguments.deadline))
        if not arguments.only_print:
            clock = on_processor_time if arguments.processor_time else None
            open_jobs = [job for job in jobs if job.key not in record]
            for job, found in _worked_on(open_jobs, arguments.jobs, clock):
                record.add(job.key, found)
        _print(name, _tallied(jobs, record))


def _tallied(jobs: Sequence[Job], record: Record) -> dict[tuple[str, ...], Tally]:
    """The lines of a table."""
    tallies = {job.line: Tally() for job in jobs}
    for job in jobs:
        found = record.get(job.key)
        if found is not None:
            tally = tallies[job.line]
            tally.promised += found["promised"] * len(found["rows"])
            tally.rows += [Run(**row) for row in found["rows"]]
    return tallies


def on_processor_time() -> None:
    """Have deadlines of this process read another clock."""
    time.perf_counter = time.process_time


def _worked_on(
    jobs: Sequence[Job], processes: int, clock: Callable[[], None] | None
) -> Iterator[tuple[Job, dict[str, Any] | None]]:
    if processes == 1:
        if clock is not None:
            clock()
        yield from map(done, jobs)
        return
    with get_context("spawn").Pool(processes, clock) as pool:
        yield from pool.imap_unordered(done, jobs, chunksize=2 * len(PEOPLE))


def _print(name: str, tallies: dict[tuple[str, ...], Tally]) -> None:
    about = name == "goals"
    more = ("most probable from epoch", "0.9 from epoch", "acted on a wrong guess") if about else ()
    print()
    _row(*HEADS[name], *HEAD, *more)
    _row(*("---" for _ in (*HEADS[name], *HEAD, *more)))
    for line, tally in tallies.items():
        if tally.rows:
            _row(*line, *tally.cells(), *(_recognised(tally.rows) if about else ()))
    slowest = sorted(row.slowest for tally in tallies.values() for row in tally.rows)
    if slowest:
        median, last = (1000 * slowest[int(share * (len(slowest) - 1))] for share in (0.5, 1))
        print(f"\nLongest decision of a run: median {median:.1f} ms, longest {last:.1f} ms.")


def _recognised(rows: Sequence[Run]) -> tuple[str, str, str]:
    wrong = sum(row.wrong for row in rows)
    return (
        _mean([row.leads for row in rows]),
        _mean([row.known for row in rows]),
        f"{wrong} epochs, {sum(row.wrong > 0 for row in rows)} runs",
    )


def _mean(epochs: Sequence[int | None]) -> str:
    found = [epoch for epoch in epochs if epoch is not None]
    return f"{sum(found) / len(found):.1f} ({len(found)} runs)" if found else "-"


def _row(*cells: object) -> None:
    print(f"| {' | '.join(str(cell) for cell in cells)} |", flush=True)


def _arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else None)
    parser.add_argument("--tables", default=",".join(TABLES), help=f"some of {','.join(TABLES)}")
    parser.add_argument("--stride", type=int, default=1, help="every N-th building, or draw of goals")
    parser.add_argument("--seeds", type=int, default=5, help="runs of each task, where dice decide")
    parser.add_argument("--deadline", type=float, default=0.1, help="seconds for each decision")
    parser.add_argument("--jobs", type=int, default=1, help="processes")
    parser.add_argument(
        "--processor-time",
        action="store_true",
        help="deadlines are of processor time, which other programs do not take part of",
    )
    parser.add_argument("--record", type=Path, help="a file of what is done, which is not done again")
    parser.add_argument("--only-print", action="store_true", help="what is in the record")
    return parser.parse_args()


if __name__ == "__main__":
    main()
