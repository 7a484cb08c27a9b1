"""Reports on a planner that is wrong, in words and as files."""

import re
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any, Final

from serendipity_testing.checking import Check, Draw, Probed, checks, run
from serendipity_testing.disagreement import Disagreement
from serendipity_testing.in_python import in_python
from serendipity_testing.judges import OutsideJudge, by_function
from serendipity_testing.written_case import command_line, write_case

_USUAL: Final = Draw()


class PlannerError(AssertionError):
    """A planner is wrong; the text has the smallest case."""

    def __init__(self, text: str) -> None:
        super().__init__(text)


def check_planner(
    planner: Callable[..., Any],
    *,
    modes: Sequence[str] = _USUAL.modes,
    options: Sequence[str] = _USUAL.options,
    actions: int = _USUAL.actions,
    seed: int = _USUAL.seed,
    count: int = _USUAL.count,
    cases: str | Path | None = None,
    call_limit: float = _USUAL.call_limit,
) -> None:
    """Ask a planner random calls; hold its answers against brute force and against the laws.

    Args:
        planner: a function of ``(task, discount)``, which is asked for joint plans, or of
            ``(task, options, human_plan)``.
        modes: what one of three arguments is asked.
        options: names of the options that calls differ in, and ``human_plan``.
        actions: the most ground actions of a task.
        seed: of the first call.
        count: of calls in each check.
        cases: a folder for the smallest case, in PDDL; None writes none.
        call_limit: seconds for each call: a planner that takes longer is ended, and wrong.

    Raises:
        PlannerError: the first check that it fails, with the smallest case.
        UsageError: an unknown mode or option.
        OSError: the case can't be written.
    """
    judge = by_function(planner)
    scope = Draw(tuple(modes), tuple(options), actions, seed, count, call_limit)
    for check in checks(judge, scope):
        outcome = run(judge, check, scope)
        if outcome.found is not None:
            folder = None if cases is None else Path(cases)
            again = f"check_planner({judge.name}, seed={outcome.seed}, count=1, ...)"
            raise PlannerError(report(judge, check, outcome, outcome.found, folder, again))


def report(
    judge: OutsideJudge,
    check: Check,
    outcome: Probed,
    found: Disagreement,
    folder: Path | None,
    again: str,
) -> str:
    """The smallest case: who says what, the task in Python and in PDDL, the call, and how to see it again.

    Args:
        folder: for its files, which get a folder of their own there; None writes none.
        again: the command that finds it again.
    """
    call = found.call
    what = f"breaks the law '{found.law}'" if found.law else "is wrong"
    lines = [f"{judge.name} {what}, in call {outcome.calls} (seed {outcome.seed}); the smallest case:", ""]
    lines += [f"  {line}" for line in in_python(call.task).splitlines()]
    asked = ", ".join(f"{name}={value}" for name, value in call.options.items())
    lines += ["", f"  asked: {asked}"]
    if call.human_plan is not None:
        lines.append(f"  human plan: {'; '.join(map(str, call.human_plan))}")
    lines += [f"  {who}: {words}" for who, words in (*found.said.items(), *found.plans.items())]
    lines.append("")
    if folder is not None:
        place = folder / re.sub(r"[^\w.-]+", "-", f"{judge.name}-{check}").strip("-")
        commands = write_case(found, place, again=again)
        lines += [
            f"in PDDL: {place} ({commands.name} has what to call)",
            f"ours: {command_line(call, place)}",
        ]
    return "\n".join([*lines, f"again: {again}"])
