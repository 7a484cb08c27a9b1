"""``serendipity crosscheck``: search, integer programs, certificates and laws on the same calls."""

import secrets
from collections.abc import Callable, Iterable
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Final

from serendipity.cli.choices import option
from serendipity.cli.exit_codes import ExitCode
from serendipity.cli.options import naming
from serendipity.cli.streams import output, progress
from serendipity.model import Deadline, UsageError

if TYPE_CHECKING:
    from serendipity_testing.disagreement import Disagreement
    from serendipity_testing.generator import PlanCall

_MODES: Final = ("individual", "serendipity", "communication", "composite")
_DISCOUNTS: Final = ("0", "0.5", "0.9")
"""What a task of the user's is called with."""


def crosscheck(
    *,
    task: naming.TaskName,
    count: Annotated[int, option("--count N", "Random calls to check.", min=1)] = 100,
    seed: Annotated[int | None, option("--seed S", "Of the first random call; by default a new one.")] = None,
    in_time: Annotated[
        bool,
        option(
            "--in-time",
            "Random calls in time; judges that know it are search, automata, exhaustive, "
            "program, false-certificates.",
        ),
    ] = False,
    people: Annotated[
        int | None,
        option(
            "--people N",
            "Random calls among so many people, one of whom is helped, under rules of help, which search and "
            "brute force know; other judges answer where no rule is in force.",
            min=1,
            max=3,
        ),
    ] = None,
    judges: Annotated[
        str,
        option(
            "--judges NAME,...",
            "Who answers: search, automata, paper, cbc, program, exhaustive; or false-certificates. "
            "By default search, automata, and without time and people paper.",
        ),
    ] = "",
    judge: Annotated[
        list[str] | None,
        option(
            "--judge NAME", "A judge from outside: up:ENGINE (unified-planning) or package.module:function."
        ),
    ] = None,
    judge_command: Annotated[
        list[str] | None,
        option(
            "--judge-command COMMAND",
            "One as a command line; {domain}, {problem} and {plan} in it stand for files.",
        ),
    ] = None,
    time_limit: Annotated[
        float | None, option("--time-limit SECONDS", "Seconds for each answer and each certificate.", min=0)
    ] = None,
    memory_limit: Annotated[
        float | None, option("--memory-limit MIB", "MiB of memory for the process.", min=0)
    ] = None,
    folder: Annotated[Path, option("-o, --output DIR", "Where a disagreement is written.")] = Path(
        "disagreement"
    ),
) -> int:
    """Check that independent methods agree. On random tasks, or on one task in every mode.

    The search must also answer alike, and claim no more than is so, however it is asked: under limits,
    on the way to its answer, after other calls, in a session; that takes long, and is left out where
    a limit is set.

    With the judge false-certificates, answers to other tasks and calls are presented with each task, fitted
    to it and doctored, some hundred of them; those that brute force knows to be false must not be proved.

    Judges from outside are asked for the best plan of all agents: where there are any, every call is
    one in composite mode without a horizon.
    """
    from serendipity_testing import crosscheck as checking
    from serendipity_testing import shrinking
    from serendipity_testing.generator import PlanCall
    from serendipity_testing.judges import by_command, by_name
    from serendipity_testing.written_case import write_case

    kind, drawn = _drawn(in_time, people)
    names = (judges or ("search,automata" if kind else "search,automata,paper")).split(",")
    for name in names:
        if name not in (*checking.JUDGES, checking.FALSE_CERTIFICATES):
            known = ", ".join((*checking.JUDGES, checking.FALSE_CERTIFICATES))
            raise UsageError(f"judges: expected some of {known}, got '{name}'")
    chosen = {name: checking.JUDGES[name] for name in names if name in checking.JUDGES}
    forged = checking.FalseCertificates(time_limit) if checking.FALSE_CERTIFICATES in names else None

    outside = [*map(by_name, judge or ()), *map(by_command, judge_command or ())]
    compared = partial(
        checking.compare,
        judges=chosen,
        laws={} if kind else checking.LAWS,  # which are about sessions and limits without time
        outside=outside,
        time_limit=time_limit,
        memory_limit=memory_limit,
    )

    def judged(call: PlanCall) -> "Disagreement | None":
        found = compared(call) if chosen or outside else None
        return found or (forged(call) if forged else None)

    calls: Iterable[PlanCall]
    if not task.files and not task.agent and task.example is None:
        first = seed
        if first is None:
            first = secrets.randbelow(10**9)
            output.say(f"seed {first}\n")
        calls, total = (drawn(first + k) for k in range(count)), count
    else:
        given = task.load(Deadline(time_limit, memory_limit))
        modes = ("composite",) if outside else _MODES
        calls = [PlanCall(given, {"mode": mode, "discount": d}) for mode in modes for d in _DISCOUNTS]
        total = len(calls)
    with progress.counting("calls") as on_progress:
        for checked, call in enumerate(calls):
            on_progress(checked, total)
            found = judged(call)
            if found is not None:
                break
        else:
            names += [stranger.name for stranger in outside]
            output.say(f"{total} calls, {', '.join(names)}: 0 disagreements\n")
            output.say("".join(f"{line}\n" for line in forged.lines()) if forged else "")
            return ExitCode.ANSWERED
    again: Callable[[PlanCall], bool] = checking.FalseCertificates(time_limit).shows
    if found.law != checking.FALSE_CERTIFICATES:
        again = checking.shows_it_too(
            found, chosen, outside=outside, time_limit=time_limit, memory_limit=memory_limit
        )
    with progress.working("shrinking") as on_news:
        smallest = shrinking.shrink(found.call, again, on_try=lambda tried: on_news(f"{tried} calls"))
    found = judged(smallest) or found
    words = [word for name in judge or () for word in ("--judge", name)]
    words += [word for text in judge_command or () for word in ("--judge-command", text)]
    words += ["--judges", checking.FALSE_CERTIFICATES] if found.law == checking.FALSE_CERTIFICATES else []
    once_more = None
    if kind:
        once_more = " ".join(
            ["serendipity crosscheck", kind, "--count 1 --seed", str(found.call.seed), *words]
        )
    commands = write_case(found, folder, [] if kind else words, again=once_more)
    plans = "".join(f"{whose}: {steps}\n" for whose, steps in found.plans.items())
    output.say(f"after {checked} calls without, a disagreement: {found}\n{plans}reproduce: {commands}\n")
    return ExitCode.REFUTED


def _drawn(in_time: bool, people: int | None) -> tuple[str, Callable[[int], "PlanCall"]]:
    """The words that ask for a kind of random calls, and what draws them from a seed."""
    from serendipity_testing.generator import random_call, random_call_among, random_call_in_time

    if in_time and people is not None:
        raise UsageError("--people: goes without --in-time")
    if people is not None:
        return f"--people {people}", partial(random_call_among, people)
    return ("--in-time", random_call_in_time) if in_time else ("", random_call)
