"""``serendipity league``: helpers of any kind on sealed cases, against the proved optimum."""

from collections.abc import Iterator
from itertools import islice
from pathlib import Path
from typing import Annotated, Final

import serendipity
from serendipity.cli.choices import option
from serendipity.cli.exit_codes import ExitCode
from serendipity.cli.streams import output, progress
from serendipity.cli.text.render import shown
from serendipity.model import InputError, Task

_FORMATS: Final = (*output.DATA, "html")
_EASY: Final = 2
"""Seconds in which a given task's person has to find what they do alone."""


def league(
    *,
    season: Annotated[
        str, option("--season NAME", "Cases are drawn by this name: the same name, the same cases.")
    ] = "open",
    helper: Annotated[
        list[str] | None,
        option(
            "--helper NAME",
            "Who plays, once for each: idle, random, greedy, ours:SECONDS, ours-fixed, ours-policy (all by "
            "default); command:LINE (JSON lines), http://... (POST), python:MODULE:FUNCTION, "
            "pettingzoo:MODULE:FUNCTION.",
        ),
    ] = None,
    families: Annotated[
        str,
        option("--families NAME,...", "Some of buildings, homes, competition; by default all, or --tasks."),
    ] = "",
    cases: Annotated[int, option("--cases N", "Cases of each family.", min=1)] = 10,
    tasks: Annotated[
        Path | None,
        option("--tasks FOLDER", "The N smallest problems of a suite in MA-PDDL, as of CoDMAP."),
    ] = None,
    deadline: Annotated[
        float, option("--deadline SECONDS", "For each decision; without one in time robots wait.", min=0)
    ] = 0.1,
    to: Annotated[
        output.Destination,
        output.formats(_FORMATS, "By default after -o's name, else text; html: a page with the table."),
    ],
) -> int:
    """Score helpers, yours too, against the proved optimum."""
    from serendipity_testing.league import SHIPPED
    from serendipity_testing.league import league as played

    form = to.prepare(_FORMATS)
    with progress.counting("cases") as on_progress:
        found = played(
            season,
            helper or SHIPPED,
            families=families.split(",") if families else None,
            cases=cases,
            tasks=() if tasks is None else islice(_given(tasks), cases),
            deadline=deadline,
            on_progress=on_progress,
        )
    output.write_answer(found.page() if form == "html" else shown(found, form), to.output_file)
    return ExitCode.ANSWERED


def _given(folder: Path) -> Iterator[Task]:
    """The tasks of a suite whose person soon finds something to do alone, the smallest first."""
    from serendipity.evaluation.measuring.suites import is_suite, may_alone, problems, roles
    from serendipity_testing.league.cases import LONGEST

    if not folder.is_dir() or not is_suite(folder):
        raise InputError(
            "expected a folder for each domain, with domain.pddl and problems in MA-PDDL", folder
        )
    for problem in sorted(problems(folder), key=lambda one: one.problem_file.stat().st_size):
        who = roles(problem, 1, may_alone)
        task = problem.task(who)
        alone = serendipity.plan(task, mode="individual", time_limit=_EASY)
        if not task.robot_goal and alone.status == "optimal" and 2 <= len(alone.human_plan or ()) <= LONGEST:
            yield task
