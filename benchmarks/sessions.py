"""What a session with a short deadline for each epoch keeps of one long call, over whole executions.

    python -m benchmarks.sessions [--tasks 20] [--long 5] [--limits 0.05 0.1 0.5] [--only WORD]

Tasks are of CoDMAP 2015, in turn from each domain; the human is the first agent that has a plan alone, two
others are robots.  For each limit a session is asked in every epoch, and everybody does what its answer
says.  It begins with a call of ``--long`` seconds (``long``), or with a short one (``cold``).
``worse`` counts the epochs in which an answer came to more than the rest of the one before; ``over`` is the
most by which a call has missed its limit.
"""

import argparse
import time
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import groupby, zip_longest

import serendipity
from benchmarks.problems import PROBLEMS
from serendipity import Result, SerendipityError, Session, Task
from serendipity.evaluation.benchmark.coverage.suite import Problem, Roles, problems, roles

DISCOUNT = 0.9

MOST_EPOCHS = 400
"""After which somebody is taken to go round in circles."""


@dataclass(frozen=True, slots=True)
class Row:
    """One execution.

    Attributes:
        start: how it began.
        limit: seconds for each call.
        alone: what the human pays alone, by the first answer; None without a plan alone.
        known: what the first answer promises.
        paid: what the team has paid in the end; None where it did not arrive.
        epochs: how many it took.
        worse: answers that came to more than the rest of the one before.
        over: seconds by which a call has missed its limit at most.
    """

    start: str
    limit: float
    alone: float | None
    known: float | None
    paid: float | None
    epochs: int
    worse: int
    over: float


def main() -> None:
    """Measure and print a table."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("--tasks", type=int, default=20, help="how many")
    parser.add_argument("--long", type=float, default=5, help="seconds of the long call")
    parser.add_argument("--limits", type=float, nargs="+", default=[0.05, 0.1, 0.5], help="of the others")
    parser.add_argument("--only", default="", help="problems with this word in their names")
    arguments = parser.parse_args()
    print("| task | start | limit | alone | promised | paid | epochs | worse | over |")
    print("|---|---|---|---|---|---|---|---|---|")
    rows: list[Row] = []
    for problem, task in _tasks(arguments.tasks, arguments.only):
        for limit in arguments.limits:
            for start in ("long", "cold"):
                row = executed(task, start, arguments.long if start == "long" else limit, limit)
                rows.append(row)
                figures = " | ".join(map(_shown, (row.alone, row.known, row.paid)))
                ends = f"{row.epochs} | {row.worse} | {row.over:.3f}"
                print(
                    f"| {problem.domain} {problem.name} | {start} | {limit:g} | {figures} | {ends} |",
                    flush=True,
                )
    for start in ("long", "cold"):
        for limit in arguments.limits:
            print(_summary([row for row in rows if (row.start, row.limit) == (start, limit)]))


def _tasks(count: int, only: str) -> Iterator[tuple[Problem, Task]]:
    """Problems in which the human has a plan alone, domain after domain, their first ones first."""
    every = [p for p in problems(PROBLEMS / "codmap15") if only in f"{p.domain} {p.name}"]
    by_domain = [list(group) for _, group in groupby(every, lambda p: p.domain)]
    taken = 0
    for problem in (p for turn in zip_longest(*by_domain) for p in turn if p is not None):
        who = roles(problem, 2, _can_alone)
        if who.alone:
            yield problem, _task(problem, who)
            taken += 1
        if taken == count:
            return


def _task(problem: Problem, who: Roles) -> Task:
    return serendipity.load_pddl(problem.domain_file, problem.problem_file, who.human, who.robots)


def _can_alone(problem: Problem, who: Roles) -> bool:
    try:
        return serendipity.plan(_task(problem, who), mode="individual", time_limit=3).cost is not None
    except SerendipityError:
        return False


def executed(task: Task, start: str, first: float, limit: float) -> Row:
    """One execution in which everybody does what the session says."""
    session = Session(task, discount=DISCOUNT)
    answer, over = _asked(session, first)
    alone, known, worse, paid = answer.human_cost, _value(answer), 0, 0.0
    for epoch in range(MOST_EPOCHS):
        steps = answer.plan if answer.plan is not None else session.rest
        if session.task.goal.holds(session.task.init):
            return Row(start, limit, alone, known, paid, epoch, worse, over)
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
    return Row(start, limit, alone, known, None, epoch, worse, over)


def _asked(session: Session, limit: float) -> tuple[Result, float]:
    begun = time.perf_counter()
    answer = session.plan(time_limit=limit)
    return answer, time.perf_counter() - begun - limit


def _value(answer: Result) -> float | None:
    """What an answer comes to: a human whose plan is not optimal may yet find a better one alone."""
    return None if answer.cost is None else answer.cost - (answer.saving_alone or 0)


def _summary(rows: Sequence[Row]) -> str:
    figures = [(r.alone, r.known, r.paid) for r in rows if None not in (r.alone, r.known, r.paid)]
    promised = sum(alone - known for alone, known, _ in figures if alone is not None and known is not None)
    saved = sum(alone - paid for alone, _, paid in figures if alone is not None and paid is not None)
    worse, epochs, over = sum(r.worse for r in rows), sum(r.epochs for r in rows), max(r.over for r in rows)
    return (
        f"{rows[0].start}, {rows[0].limit:g} s: {len(figures)} of {len(rows)} arrived; saved {saved:g}, "
        f"promised at first {promised:g}; worse in {worse} of {epochs} epochs; missed by at most {over:.3f} s"
    )


def _shown(cost: float | None) -> str:
    return "-" if cost is None else f"{cost:g}"


if __name__ == "__main__":
    main()
