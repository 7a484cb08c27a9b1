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
from dataclasses import replace
from functools import lru_cache
from itertools import product
from pathlib import Path
from typing import Any, NamedTuple

import typer

import serendipity
from benchmarks.problems import (
    PROBLEMS,
    Source,
    can_some,
    candidates_in,
    load,
    of_suite,
    usar,
    with_two_goals,
)
from serendipity import Task
from serendipity.evaluation.measuring.figures import percentile
from serendipity.evaluation.measuring.record import measured
from serendipity.evaluation.measuring.tables import as_markdown, grouped, table
from serendipity.execution import Run
from serendipity.model.telling import Grid, Line

DISCOUNT = "0.9"
PEOPLE = ("observant", "local", "noisy:0.1", "omniscient")
DOMAINS = ("blocksworld", "driverlog", "rovers", "satellites", "zenotravel")

SMALLEST = 3
"""Problems of a domain, from its first."""

DRAWS = 200
"""Draws of two goals in each domain, problem after problem."""


class Job(NamedTuple):
    """Runs on one task.

    Attributes:
        line: of the table that they count for.
        source: the task.
        drawn: seed by which two of its goals are drawn; empty for all of them.
        human: who the person is.
        ties: which of their plans they follow.
        seeds: how many runs.
        goals: how many goals robots take for possible.
        deadline: seconds for each epoch.
    """

    line: tuple[str, ...]
    source: Source
    drawn: str
    human: str
    ties: str
    seeds: int
    goals: int
    deadline: float


class Of(NamedTuple):
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
    for name in tables.split(","):
        asked = JOBS[name](stride, seeds, deadline)
        lines: dict[tuple[str, ...], list[Of]] = {}
        for job, found in measured(asked, done, record, processes=jobs):
            if found is not None:
                rows = [Of(Run(**row), found["promised"]) for row in found["rows"]]
                lines.setdefault(job.line, []).extend(rows)
        slowest = [1000 * of.run.slowest for runs in lines.values() for of in runs]
        shares = " / ".join(f"{percentile(slowest, share):.3g}" for share in (0.5, 0.95, 1.0) if slowest)
        told = Line(f"Longest decision of a run: median, 95 % and longest {shares} ms.")
        print(as_markdown([_table(name, lines), told]), flush=True)


def done(job: Job) -> dict[str, Any] | None:
    """The paper's saving on the task, and a row a run; None where the person has no plan alone."""
    task, promised = _task(job.source, job.drawn), _promised(job.source, job.drawn)
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
def _promised(source: Source, drawn: str) -> float | None:
    """Saving of the paper's plan on a task; None where the person has no plan alone, or nobody knows."""
    result = serendipity.plan(_task(source, drawn), discount=DISCOUNT, time_limit=2)
    return None if result.human_plan is None else result.saving


def _task(source: Source, drawn: str) -> Task:
    return with_two_goals(load(source), drawn) if drawn else load(source)


def _people(stride: int, seeds: int, deadline: float) -> Iterator[Job]:
    """Jobs of different people, over the buildings."""
    for human, ties, source in product(PEOPLE, ("fixed", "drawn"), usar(stride)):
        runs = seeds if human.startswith("noisy") or ties == "drawn" else 1
        yield Job((human, ties), source, "", human, ties, runs, 1, deadline)


def _domains(stride: int, seeds: int, deadline: float) -> Iterator[Job]:
    """Jobs in other domains, on problems that somebody can do alone."""
    found = of_suite(PROBLEMS / "codmap15", can_some, domains=DOMAINS, smallest=SMALLEST)
    known = grouped((each for each in found if each[1].alone), lambda each: each[0].domain)
    for number, (name, able) in product(range(0, DRAWS, stride), known.items()):
        problem, _, source = able[number // stride % len(able)]
        for human, (ties, runs) in product(PEOPLE, (("fixed", 1), ("drawn", seeds))):
            drawn = f"{name} {problem.name} {number}"
            yield Job((name, human, ties), source, drawn, human, ties, runs, 1, deadline)


def _goals(stride: int, _seeds: int, deadline: float) -> Iterator[Job]:
    """Jobs with several possible goals, over the buildings."""
    for human, count, source in product(("observant", "omniscient"), range(1, 6), usar(stride)):
        yield Job((human, str(count)), source, "", human, "fixed", 1, count, deadline)


JOBS = {"people": _people, "domains": _domains, "goals": _goals}
NAMES = {
    "people": ("person", "plans"),
    "domains": ("domain", "person", "plans"),
    "goals": ("person", "goals"),
}


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


def _of_epochs(counts: Callable[[Run], int]) -> Callable[[Sequence[Of]], str]:
    """The share of the runs' epochs that are counted."""
    return lambda of: f"{100 * sum(counts(o.run) for o in of) / sum(o.run.epochs for o in of):.2f} %"


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
    "decided in time": _of_epochs(lambda run: run.epochs - run.late),
    "without a proof": _of_epochs(lambda run: run.open),
}


if __name__ == "__main__":
    main.__doc__ = __doc__
    typer.run(main)
