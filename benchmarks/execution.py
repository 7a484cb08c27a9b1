"""Outcomes of help while it happens: many executions with people who do as they like.

    python -m benchmarks.execution [--tables people,domains,goals] [--stride N] [--seeds N] [--jobs N]
        [--deadline S] [--record FILE]

``people``: the 200 buildings, with people who follow the canonical one of their optimal plans, or any.
*Alone* is for ``noisy`` what the same person, with the same dice, pays where robots do nothing.
``domains``: five domains of CoDMAP 2015, each problem with two of its goals, drawn again and again.
With ``--stride 3 --seeds 7`` that is about 1,000 runs of each person whose plans are drawn, in half an
hour of one core.
``goals``: the buildings, where robots do not know in which of 2 to 5 rooms triage is to be conducted.
With ``--record`` what is done is written down at once, and not done again.  Problems that are not there are
left out (see ``benchmarks.problems``).
"""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import lru_cache
from itertools import product
from pathlib import Path
from random import Random
from typing import Any

import typer

import serendipity
from benchmarks.problems import PROBLEMS
from serendipity import SerendipityError, Task
from serendipity.evaluation.measuring.figures import milliseconds
from serendipity.evaluation.measuring.record import Record
from serendipity.evaluation.measuring.running import measured
from serendipity.evaluation.measuring.suites import Problem, Roles, folders, problems, roles
from serendipity.evaluation.measuring.tables import as_markdown, grouped, table
from serendipity.execution import Run
from serendipity.model import Condition
from serendipity.model.telling import Grid, Line

DISCOUNT = "0.9"
PEOPLE = ("observant", "local", "noisy:0.1", "omniscient")
DOMAINS = ("blocksworld", "driverlog", "rovers", "satellites", "zenotravel")
MOST_GOALS = 5

SMALLEST = 3
"""Problems of a domain, from its first."""

DRAWS = 200
"""Draws of two goals in each domain, problem after problem."""

Source = Path | tuple[Problem, Roles, int]
"""A building; or a problem with its roles, and the seed of its goals."""


@dataclass(frozen=True, slots=True)
class Job:
    """Runs on one task.

    Attributes:
        line: of the table that they count for.
        source: the task.
        human: who the person is.
        ties: which of their plans they follow.
        seeds: how many runs.
        goals: how many goals robots take for possible.
        deadline: seconds for each epoch.
    """

    line: tuple[str, ...]
    source: Source
    human: str
    ties: str
    seeds: int
    goals: int
    deadline: float


@dataclass(frozen=True, slots=True)
class Of:
    """A run, and what the paper's plan saves on its task; savings are the team's."""

    run: Run
    promised: float

    @property
    def saved(self) -> float:
        """Saving of the team, where the person got there."""
        return (self.run.alone or 0) - self.run.cost if self.run.reached else 0


def main(
    tables: str = "people,domains,goals",
    stride: int = 1,
    seeds: int = 5,
    deadline: float = 0.1,
    jobs: int = 1,
    record: Path | None = None,
) -> None:
    """Measure and print the tables."""
    kept = Record(record)
    for name in tables.split(","):
        asked = JOBS[name](stride, seeds, deadline)
        runs: list[tuple[tuple[str, ...], Of]] = []
        for job, found in measured(asked, done, kept, processes=jobs):
            if found is not None:
                runs += [(job.line, Of(Run(**row), found["promised"])) for row in found["rows"]]
        lines = {line: [run for _, run in of] for line, of in grouped(runs, lambda pair: pair[0]).items()}
        slowest = milliseconds([of.run.slowest for _, of in runs])
        told = Line(f"Longest decision of a run: median, 95 % and longest {slowest} ms.")
        print(as_markdown([_table(name, lines), told]), flush=True)


def done(job: Job) -> dict[str, Any] | None:
    """The paper's saving on the task, and a row a run; None where the person has no plan alone."""
    task, promised = _task_of(job.source), _promised(job.source)
    if promised is None:
        return None
    candidates = candidates_in(task, job.goals) if job.goals > 1 else None
    common = {"runs": job.seeds, "ties": job.ties, "discount": DISCOUNT, "goals": candidates}
    rows = serendipity.execute(task, job.human, deadline=job.deadline, **common).rows
    if job.human.startswith("noisy"):
        idle = serendipity.execute(task, job.human, deadline=0, setup=0, **common).rows
        rows = tuple(replace(row, alone=other.human_cost) for row, other in zip(rows, idle, strict=True))
    return {"promised": promised, "rows": [row.to_dict() for row in rows]}


@lru_cache(maxsize=1)
def _promised(source: Source) -> float | None:
    """Saving of the paper's plan on a task; None where the person has no plan alone, or nobody knows."""
    result = serendipity.plan(_task_of(source), discount=DISCOUNT, time_limit=2)
    return None if result.human_plan is None else result.saving


def _task_of(source: Source) -> Task:
    """A building; or a problem with its roles, and two of its goals."""
    if isinstance(source, Path):
        return serendipity.load(source, human="commx")
    problem, who, seed = source
    task = problem.task(who)
    wanted = sorted(Random(f"{problem.domain} {problem.name} {seed}").sample(task.goal.positive, 2))
    return task.with_goal(Condition(tuple(wanted), ()))


def candidates_in(task: Task, count: int) -> list[dict[str, Any]]:
    """The person's goal and others of its form, each as probable as any."""
    (own,) = task.goal.positive
    form = task.facts[own].replace("_", " ").split()[:-1]
    others = [f for f in task.facts if f.replace("_", " ").split()[:-1] == form and f != task.facts[own]]
    chosen = [task.facts[own], *Random(f"{task.name} {count}").sample(others, count - 1)]
    return [{"name": fact, "goal": [fact]} for fact in sorted(chosen)]


def _people(stride: int, seeds: int, deadline: float) -> Iterator[Job]:
    """Jobs of different people, over the buildings."""
    for human, ties, folder in product(PEOPLE, ("fixed", "drawn"), _buildings(stride)):
        runs = seeds if human.startswith("noisy") or ties == "drawn" else 1
        yield Job((human, ties), folder, human, ties, runs, 1, deadline)


def _domains(stride: int, seeds: int, deadline: float) -> Iterator[Job]:
    """Jobs in other domains."""
    known = {name: _smallest(name) for name in DOMAINS}
    for number, name in product(range(0, DRAWS, stride), filter(known.get, DOMAINS)):
        problem, able = known[name][number // stride % len(known[name])]
        for human, (ties, runs) in product(PEOPLE, (("fixed", 1), ("drawn", seeds))):
            yield Job((name, human, ties), (problem, able, number), human, ties, runs, 1, deadline)


def _goals(stride: int, _seeds: int, deadline: float) -> Iterator[Job]:
    """Jobs with several possible goals, over the buildings."""
    people = "observant", "omniscient"
    for human, count, folder in product(people, range(1, MOST_GOALS + 1), _buildings(stride)):
        yield Job((human, str(count)), folder, human, "fixed", 1, count, deadline)


JOBS = {"people": _people, "domains": _domains, "goals": _goals}
NAMES = {
    "people": ("person", "plans"),
    "domains": ("domain", "person", "plans"),
    "goals": ("person", "goals"),
}


def _buildings(stride: int) -> list[Path]:
    """Every so many of the 200."""
    suite = PROBLEMS / "usar200"
    return folders(suite, stride) if suite.is_dir() else []


def _smallest(domain: str) -> list[tuple[Problem, Roles]]:
    """A domain's smallest problems that somebody can do alone; none where the domain is not there."""
    suite = PROBLEMS / "codmap15"
    found = problems(suite, [domain]) if suite.is_dir() else []
    first = sorted(found, key=lambda problem: (len(problem.name), problem.name))[:SMALLEST]
    able = [(problem, roles(problem, 2, can_alone)) for problem in first]
    return [(problem, who) for problem, who in able if who.alone]


def can_alone(problem: Problem, who: Roles) -> bool:
    """True if a human can reach two of the goals alone."""
    try:
        return (
            serendipity.plan(_task_of((problem, who, 0)), mode="individual", time_limit=60).cost is not None
        )
    except (SerendipityError, ValueError):
        return False


def _table(name: str, lines: dict[tuple[str, ...], list[Of]]) -> Grid:
    about = {
        "most probable from epoch": lambda of: _mean([each.run.leads for each in of]),
        "0.9 from epoch": lambda of: _mean([each.run.known for each in of]),
        "acted on a wrong guess": lambda of: f"{sum(o.run.wrong for o in of)} epochs",
    }
    return table(NAMES[name], lines, COLUMNS | (about if name == "goals" else {}))


def _share(counts: Callable[[Run], bool]) -> Callable[[Sequence[Of]], str]:
    """The share of the runs for which something holds."""

    def cell(of: Sequence[Of]) -> str:
        number = sum(counts(each.run) for each in of)
        return f"{100 * number / len(of):.1f} % ({number})" if number else "0"

    return cell


def _kept(of: Sequence[Of]) -> str:
    saved, promised = sum(each.saved for each in of), sum(each.promised for each in of)
    return f"{saved:.1f} of {promised:.1f} ({f'{100 * saved / promised:.0f} %' if promised else '-'})"


def _in_time(of: Sequence[Of]) -> str:
    epochs, late = sum(each.run.epochs for each in of), sum(each.run.late for each in of)
    return f"{100 * (1 - late / epochs):.2f} % of {epochs}"


def _mean(epochs: Sequence[int | None]) -> str:
    found = [epoch for epoch in epochs if epoch is not None]
    return f"{sum(found) / len(found):.1f} ({len(found)} runs)" if found else "-"


COLUMNS: dict[str, Callable[[Sequence[Of]], object]] = {
    "runs": len,
    "goal reached": _share(lambda run: run.reached),
    "less than alone": _share(lambda run: run.reached and run.human_cost < (run.alone or 0)),
    "the same": _share(lambda run: run.reached and run.human_cost == run.alone),
    "more": _share(lambda run: run.reached and run.human_cost > (run.alone or 0)),
    "saved of what the paper's plans save": _kept,
    "plans spoilt": lambda of: sum(each.run.spoilt for each in of),
    "decided in time": _in_time,
    "without a proof": lambda of: (
        f"{100 * sum(o.run.open for o in of) / sum(o.run.epochs for o in of):.1f} %"
    ),
}


if __name__ == "__main__":
    main.__doc__ = __doc__
    typer.run(main)
