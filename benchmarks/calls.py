"""Random calls of ``serendipity crosscheck``: what comes of them, or what judges from outside say of them.

    python -m benchmarks.calls [--count N] [--seed S]
    python -m benchmarks.calls up:fast-downward-opt up:symk-opt [--count N] [--seed S]
        [--time-limit S] [-o FOLDER]

Without judges, a table of outcomes by family and mode; families are those of ``crosscheck``, and all other
tasks are ``random``.  Judges are named as for ``crosscheck --judge``.  Each has calls of its own, since one
that counts actions only is asked about tasks of unit costs.  A disagreement is printed, shrunk, and written.
"""

import warnings
from collections import Counter
from collections.abc import Sequence
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Annotated

import typer

import serendipity
from serendipity import Deadline, UsageError
from serendipity.evaluation.crosscheck import (
    JUDGES,
    PlanCall,
    compare,
    random_call,
    shows_it_too,
    shrink,
    write_case,
)
from serendipity.evaluation.measuring.tables import as_markdown, grouped, table
from serendipity.model.telling import Grid, Line
from serendipity.testing.judges import OutsideJudge, Proposal, by_name

SEARCH = {"search": JUDGES["search"]}
OUTCOMES = ("opportunity", "optimal, none", "no-human-plan", "infeasible", "refused")
STATUSES = ("optimal", "feasible", "infeasible", "unknown")


def main(
    judges: Annotated[list[str] | None, typer.Argument()] = None,
    count: int = 1000,
    seed: int = 0,
    time_limit: float = 60,
    output: Annotated[Path, typer.Option("-o", "--output")] = Path("build/outside"),
) -> None:
    """Print the table, and what judges could not say."""
    warnings.simplefilter("ignore")
    calls = map(random_call, range(seed, seed + count))
    if not judges:
        print(
            as_markdown([_drawn([(call.task.name, call.options["mode"], outcome(call)) for call in calls])])
        )
        return
    seen = {name: Counter(calls=count) for name in judges}
    for name, of in seen.items():
        judge = counted(by_name(name), of)
        of["disagreements"] = sum(
            asked(each, judge, time_limit, output) for each in range(seed, seed + count)
        )
    columns = ("calls", *STATUSES, "disagreements")
    rows = [[name, *(str(of[column]) for column in columns)] for name, of in seen.items()]
    others = [
        Line(f"{name}: {of[words]} {words}") for name, of in seen.items() for words in {*of} - {*columns}
    ]
    print(as_markdown([Grid(["judge", *columns], rows), *others]), end="")


def _drawn(rows: Sequence[tuple[str, str, str]]) -> Grid:
    def number(of: Sequence[tuple[str, str, str]], how: str) -> int:
        return sum(row[-1] == how for row in of)

    groups = grouped(sorted(rows), lambda row: row[:2])
    return table(
        ("family", "mode"), groups, {"calls": len, **{how: partial(number, how=how) for how in OUTCOMES}}
    )


def outcome(call: PlanCall) -> str:
    """One of ``OUTCOMES``."""
    try:
        answer = serendipity.plan(call.task, human_plan=call.human_plan, **call.keywords())
    except UsageError:
        return "refused"
    if answer.status == "infeasible":
        return "no-human-plan" if answer.reason == "no-human-plan" else "infeasible"
    return "opportunity" if answer.opportunity else "optimal, none"


def counted(judge: OutsideJudge, seen: Counter[str]) -> OutsideJudge:
    """A judge whose answers are counted, and its reasons for none."""

    def answer(call: PlanCall, deadline: Deadline) -> Proposal:
        claim = judge.answer(call, deadline)
        seen.update([claim.status] if claim.status != "unknown" else [claim.status, claim.words])
        return claim

    return replace(judge, answer=answer)


def asked(seed: int, judge: OutsideJudge, time_limit: float, folder: Path) -> bool:
    """True if a judge and the search disagree on a call."""
    found = compare(random_call(seed), SEARCH, outside=[judge], time_limit=time_limit)
    if found is None:
        return False
    print(f"seed {seed}: {found}", flush=True)
    silent = by_name(judge.name)
    differs = shows_it_too(found, SEARCH, outside=[silent], time_limit=time_limit)
    smallest = shrink(found.call, differs, most=300)
    case = compare(smallest, SEARCH, outside=[silent], time_limit=time_limit) or found
    print(f"  {write_case(case, folder / f'{seed}', ['--judge', judge.name])}: {case}", flush=True)
    return True


if __name__ == "__main__":
    main.__doc__ = __doc__
    typer.run(main)
