"""Savings of sessions with a short deadline for each epoch, beside one long call, over whole executions.

    python -m benchmarks.sessions [--tasks 20] [--long 5] [--limits 0.05,0.1,0.5] [--only WORD]

Tasks are of CoDMAP 2015, in turn from each domain; the human is the first agent that has a plan alone, two
others are robots.  For each limit a session is asked in every epoch, and everybody does what its answer
says.  It begins with a call of ``--long`` seconds (``long``), or with a short one (``cold``).
``worse`` counts the epochs in which an answer came to more than the rest of the one before; ``over`` is the
most by which a call has missed its limit.
"""

import time
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import zip_longest

import typer

from benchmarks.problems import PROBLEMS, can_alone
from serendipity import Result, Session, Task
from serendipity.evaluation.measuring.suites import problems, roles
from serendipity.evaluation.measuring.tables import as_markdown, grouped, table

DISCOUNT = 0.9

MOST_EPOCHS = 400
"""After which somebody is taken to go round in circles."""


@dataclass(frozen=True, slots=True)
class Row:
    """One execution.

    Attributes:
        task: its name.
        start: how it began.
        limit: seconds for each call.
        alone: what the human pays alone, by the first answer; None without a plan alone.
        known: what the first answer promises.
        paid: what the team has paid in the end; None where it did not arrive.
        epochs: how many it took.
        worse: answers that came to more than the rest of the one before.
        over: seconds by which a call has missed its limit at most.
    """

    task: str
    start: str
    limit: float
    alone: float | None
    known: float | None
    paid: float | None
    epochs: int
    worse: int
    over: float

    def saving(self, cost: float | None) -> float:
        """Saving of a cost, where the execution has arrived and all of it is known."""
        if self.alone is None or self.known is None or self.paid is None or cost is None:
            return 0.0
        return self.alone - cost


def main(tasks: int = 20, long: float = 5, limits: str = "0.05,0.1,0.5", only: str = "") -> None:
    """Measure and print two tables."""
    rows: list[Row] = []
    for name, task in _tasks(tasks, only):
        for limit in map(float, limits.split(",")):
            for start in ("long", "cold"):
                rows.append(executed(name, task, start, long if start == "long" else limit, limit))
        print(name, flush=True)
    figures = ("alone", "known", "paid", "epochs", "worse", "over")
    single = table(
        ("task", "start", "limit"),
        grouped(rows, lambda row: (row.task, row.start, f"{row.limit:g}")),
        {name: lambda of, name=name: _shown(getattr(of[0], name)) for name in figures},
    )
    print(as_markdown([single, _summary(rows)]), end="")


def _tasks(count: int, only: str) -> Iterator[tuple[str, Task]]:
    """Problems in which the human has a plan alone, domain after domain, their first ones first."""
    every = [p for p in problems(PROBLEMS / "codmap15") if only in f"{p.domain} {p.name}"]
    by_domain = grouped(every, lambda problem: problem.domain).values()
    taken = 0
    for problem in (p for turn in zip_longest(*by_domain) for p in turn if p is not None):
        who = roles(problem, 2, can_alone)
        if who.alone:
            yield f"{problem.domain} {problem.name}", problem.task(who)
            taken += 1
        if taken == count:
            return


def executed(name: str, task: Task, start: str, first: float, limit: float) -> Row:
    """One execution in which everybody does what the session says."""
    session = Session(task, discount=DISCOUNT)
    answer, over = _asked(session, first)
    alone, known, worse, paid = answer.human_cost, _value(answer), 0, 0.0
    for epoch in range(MOST_EPOCHS):
        steps = answer.plan if answer.plan is not None else session.rest
        if session.task.goal.holds(session.task.init):
            return Row(name, start, limit, alone, known, paid, epoch, worse, over)
        if steps is None:
            break
        now = [step for step in steps if step.epoch == 1]
        rest = sum(step.cost for step in steps if step.epoch > 1)
        paid += sum(step.cost for step in now)
        session.execute([step.action for step in now])
        answer, missed = _asked(session, limit)
        value = _value(answer)
        worse += value is not None and value > rest + 1e-9
        over = max(over, missed)
    return Row(name, start, limit, alone, known, None, epoch, worse, over)


def _asked(session: Session, limit: float) -> tuple[Result, float]:
    begun = time.perf_counter()
    answer = session.plan(time_limit=limit)
    return answer, time.perf_counter() - begun - limit


def _value(answer: Result) -> float | None:
    """Cost of an answer: a human whose plan is not optimal may yet find a better one alone."""
    return None if answer.cost is None else answer.cost - (answer.saving_alone or 0)


def _summary(rows: Sequence[Row]) -> object:
    return table(
        ("start", "limit"),
        grouped(
            sorted(rows, key=lambda row: (row.start, row.limit)), lambda row: (row.start, f"{row.limit:g} s")
        ),
        {
            "arrived": lambda of: f"{sum(row.paid is not None for row in of)} of {len(of)}",
            "promised at first": lambda of: f"{sum(row.saving(row.known) for row in of):g}",
            "saved": lambda of: f"{sum(row.saving(row.paid) for row in of):g}",
            "worse": lambda of: f"{sum(row.worse for row in of)} of {sum(row.epochs for row in of)} epochs",
            "missed by at most": lambda of: f"{max(row.over for row in of):.3f} s",
        },
    )


def _shown(figure: float | None) -> str:
    return "-" if figure is None else f"{figure:.4g}"


if __name__ == "__main__":
    main.__doc__ = __doc__
    typer.run(main)
