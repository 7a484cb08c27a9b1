"""Coverage of a suite's tasks over time: the search and others beside it; who decides what, and when.

Every call is a process of its own, under a limit by the clock; times leave out reading and grounding on both
sides, and contain everything else.  In a cell, figures stand in the order of :func:`contenders_in`.
"""

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import partial
from pathlib import Path
from statistics import median
from typing import Final

from serendipity.classical import fast_downward
from serendipity.evaluation.benchmark import contenders as every
from serendipity.evaluation.benchmark.contenders import Contender, Outcome, outside, searched
from serendipity.evaluation.benchmark.rows import BenchRow
from serendipity.evaluation.measuring.record import apart
from serendipity.evaluation.measuring.suites import Roles, SuiteProblem, chosen, roles
from serendipity.evaluation.measuring.tables import grouped, table
from serendipity.model.errors import SerendipityError, told
from serendipity.model.numbers import Number, exact
from serendipity.model.telling import Grid, Line
from serendipity.pddl import read_pddl
from serendipity.pddl.classical import lifted_files

MODES: Final = {name: options for name, options in every.MODES.items() if name != "composite"}

CLASSICAL: Final = ("individual", "composite-inf")
"""Modes that planners for a single agent know; they need no plan of the human alone either."""

MOMENTS: Final = (0.1, 1.0, 2.0, 5.0, 20.0)
"""Seconds at which coverage is told."""

_SHORT: Final = 5.0
"""Seconds for each look whether an agent can do it alone."""

_OURS: Final = "search"


@dataclass(frozen=True, slots=True)
class Call:
    """A planning call: a problem, its roles, a mode in :data:`MODES`, and seconds for an answer."""

    problem: SuiteProblem
    roles: Roles
    mode: str
    discount: Fraction
    time_limit: float


def _search(call: Call) -> Outcome:
    problem, who = call.problem, call.roles
    load = partial(read_pddl, problem.domain_file, problem.problem_file, who.human, who.robots)
    options = {**MODES[call.mode], "discount": call.discount}
    try:
        return apart(partial(searched, reading=call.time_limit), load, options, call.time_limit)
    except Exception as error:  # whatever it is, the others are asked
        return Outcome("failed", reason=told(error))


def _fast_downward(search: fast_downward.Search, call: Call) -> Outcome:
    shares = {call.roles.human: Fraction(1)}
    if call.mode != "individual":
        shares |= dict.fromkeys(call.roles.robots, 1 - call.discount)
    try:
        return outside(lifted_files(call.problem.unit(), shares), search, call.time_limit)
    except SerendipityError as error:
        return Outcome("failed", reason=str(error))


def _classical(search: fast_downward.Search) -> Contender:
    return Contender(partial(_fast_downward, search), CLASSICAL, partial(fast_downward.absent, search))


CONTENDERS: Final[dict[str, Contender]] = {
    _OURS: Contender(_search),
    "fast-downward": _classical(fast_downward.LMCUT),
    "fast-downward-ipdb": _classical(fast_downward.IPDB),
    "symk": _classical(fast_downward.SYMK),
}
"""Our search, Fast Downward with two heuristics, and SymK."""


def contenders_with(scorpion: Path | None) -> Mapping[str, Contender]:
    """:data:`CONTENDERS`, and Scorpion where its program is given; a UsageError where it is not there."""
    if scorpion is None:
        return CONTENDERS
    return {**CONTENDERS, "scorpion": _classical(fast_downward.scorpion(scorpion))}


def can_alone(problem: SuiteProblem, who: Roles, time_limit: float) -> bool:
    """True if the human is found to have a plan alone: by the search, else by Fast Downward."""
    call = Call(problem, who, "individual", Fraction(0), time_limit)
    found = _search(call).status
    if found in ("unknown", "failed") and fast_downward.absent() is None:
        found = _fast_downward(fast_downward.ANY_PLAN, call).status
    return found in ("optimal", "feasible")


def measure(
    problems: Iterable[SuiteProblem],
    modes: Iterable[str],
    contenders: Iterable[str],
    *,
    discount: Number = "0.9",
    robots: int = 2,
    time_limit: float = 20.0,
    known: Mapping[str, Contender] = CONTENDERS,
) -> Iterator[BenchRow]:
    """Ask each contender each call that it knows, with as many seconds for reading it as for the call.

    Contenders are some of the ``known``; those that are absent must be left out before.  Where the human is
    not known to have a plan alone, nothing is asked that is about that plan.  A problem that can't be read
    is one row for each contender, with status ``error``.

    Raises:
        UsageError: a mode, a contender or the discount is unknown.
    """
    asked = [*chosen(modes, MODES, "modes", " for a suite of domains")]
    who_answers = chosen(contenders, known, "contenders", " for a suite of domains")
    share = exact(discount, "discount")
    short = min(_SHORT, time_limit)
    for problem in problems:
        try:
            who = roles(problem, robots, lambda problem, who: can_alone(problem, who, short))
        except Exception as error:  # one broken task does not end a suite
            broken = Call(problem, Roles("", ()), asked[0], share, time_limit)
            yield from (_row(broken, name, Outcome("error", reason=told(error))) for name in who_answers)
            continue
        for mode in asked:
            call = Call(problem, who, mode, share, time_limit)
            for name, contender in who_answers.items():
                if mode in contender.modes and (who.alone or mode in CLASSICAL):
                    yield _row(call, name, contender.answer(call))


def _row(call: Call, contender: str, outcome: Outcome) -> BenchRow:
    problem, who = call.problem, call.roles
    about = (problem.domain, problem.name, who.human, " ".join(who.robots), who.alone)
    return BenchRow(*about, call.mode, float(call.discount), contender, outcome)


_Cell = Callable[[Sequence[BenchRow]], str]


def contenders_in(rows: Iterable[BenchRow]) -> list[str]:
    """Names of contenders, in the order of the rows."""
    return list(dict.fromkeys(row.contender for row in rows))


def tables(rows: Sequence[BenchRow]) -> Iterator[Line | Grid]:
    """All tables, with their titles."""
    order = " / ".join(contenders_in(rows))
    titled = {
        f"Calls decided: {order}": decided(rows),
        f"Median seconds until the answer, reading left out: {order}": seconds(rows),
        "Median expansions where both have decided": expansions(rows),
        "Calls decided, and calls with a plan, after some seconds": over_time(rows),
    }
    for number, (title, grid) in enumerate(titled.items()):
        yield from [Line()] * (number > 0)
        yield from (Line(f"{title}."), Line(), grid)


def decided(rows: Sequence[BenchRow]) -> Grid:
    """To how many calls each contender proves the answer; of how many where not all tasks are asked."""
    return _by_domain(rows, {"tasks": _tasks, "human's plan": _alone, **_each(rows, _decided)})


def seconds(rows: Sequence[BenchRow]) -> Grid:
    """Median seconds until the answer; a call without a proof takes longer than any other."""
    return _by_domain(rows, _each(rows, _median_seconds))


def expansions(rows: Sequence[BenchRow]) -> Grid:
    """Median expansions of the search and of each other contender, over calls that both have decided."""
    columns = {
        f"{mode}: {_OURS} : {other}": partial(_beside, mode=mode, other=other)
        for mode, of in grouped(rows, lambda row: row.mode).items()
        for other in contenders_in(of)
        if other != _OURS
    }
    return _by_domain(rows, columns)


def over_time(rows: Sequence[BenchRow]) -> Grid:
    """Numbers of calls that are decided after some seconds, and that have a plan by then; peak memory."""
    header = ("mode", "contender", "calls", "", *(f"{moment:g} s" for moment in MOMENTS), "most MiB")
    lines: list[tuple[str, ...]] = []
    for (mode, name), of in grouped(rows, lambda row: (row.mode, row.contender)).items():
        memory = [row.outcome.memory for row in of if row.outcome.memory is not None]
        most = f"{max(memory):.0f}" if memory else ""
        lines.append((mode, name, str(len(of)), "decided", *_counts(decision_times(of)), most))
        lines.append(("", "", "", "a plan", *_counts(plan_times(of)), ""))
    return Grid(header, lines)


def decision_times(rows: Iterable[BenchRow]) -> list[float]:
    """When the calls that are decided were."""
    return [row.outcome.seconds for row in rows if row.outcome.proved]


def plan_times(rows: Iterable[BenchRow]) -> list[float]:
    """When the calls that have a plan had the first one."""
    return [row.outcome.plan_seconds for row in rows if row.outcome.plan_seconds is not None]


def failures(rows: Iterable[BenchRow]) -> list[str]:
    """Calls that could not be asked, and why, once for each reason."""
    failed = (row for row in rows if row.outcome.status == "failed")
    told = (
        f"{row.contender} fails on {row.domain} {row.task}, {row.mode}: {row.outcome.reason}"
        for row in failed
    )
    return list(dict.fromkeys(told))


def errors(rows: Iterable[BenchRow]) -> dict[str, str]:
    """By task what is broken in it."""
    broken = (row for row in rows if row.outcome.status == "error")
    return {f"{row.domain} {row.task}".strip(): row.outcome.reason for row in broken}


def _counts(times: Sequence[float]) -> Iterable[str]:
    return (str(sum(time <= moment for time in times)) for moment in MOMENTS)


def _by_domain(rows: Sequence[BenchRow], columns: Mapping[str, _Cell]) -> Grid:
    groups = grouped(rows, lambda row: (row.domain,))
    if len(groups) > 1:
        groups[("all",)] = list(rows)
    return table(("domain",), groups, columns)


def _tasks(rows: Iterable[BenchRow]) -> str:
    return str(len({(row.domain, row.task) for row in rows}))


def _alone(rows: Iterable[BenchRow]) -> str:
    return _tasks(row for row in rows if row.alone)


def _each(rows: Sequence[BenchRow], figure: _Cell) -> dict[str, _Cell]:
    """A column for each mode, with a figure for each contender."""

    def cell(of: Sequence[BenchRow], mode: str) -> str:
        asked = (row for row in of if row.mode == mode)
        return " / ".join(map(figure, grouped(asked, lambda row: row.contender).values()))

    return {mode: partial(cell, mode=mode) for mode in dict.fromkeys(row.mode for row in rows)}


def _decided(rows: Sequence[BenchRow]) -> str:
    return str(sum(row.outcome.proved for row in rows))


def _median_seconds(rows: Sequence[BenchRow]) -> str:
    times = sorted(decision_times(rows))
    middle = len(rows) // 2
    return f"{times[middle]:.2g}" if middle < len(times) else "-"


def _beside(rows: Sequence[BenchRow], mode: str, other: str) -> str:
    proved = [row for row in rows if row.outcome.proved and row.mode == mode]
    ours, theirs = (
        {(row.domain, row.task): row.outcome.expanded for row in proved if row.contender == name}
        for name in (_OURS, other)
    )
    both = ours.keys() & theirs.keys()
    if not both:
        return "-"
    own, others = (median(of[task] for task in both) for of in (ours, theirs))
    return f"{own:,.0f} : {others:,.0f} ({len(both)})"
