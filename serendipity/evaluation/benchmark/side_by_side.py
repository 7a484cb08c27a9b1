"""Side by side: each contender on each call, one after another, warmed up; and what the others take over the
search.

``>=`` marks figures that would be, or might be, larger if calls had not met their limit.
"""

import gc
import statistics
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import replace
from typing import Final

from search import PreparedTask, prepare, solve
from serendipity.classical import fast_downward
from serendipity.evaluation.benchmark import contenders as every
from serendipity.evaluation.benchmark.contenders import Contender, Outcome, outside
from serendipity.evaluation.benchmark.rows import BenchRow, disagreements
from serendipity.evaluation.measuring.figures import percentile, timed
from serendipity.evaluation.measuring.suites import chosen
from serendipity.evaluation.measuring.tables import grouped
from serendipity.model.errors import DisagreementError
from serendipity.model.options import Options
from serendipity.model.resources.deadline import Deadline
from serendipity.model.task.task import Task
from serendipity.model.telling import Grid
from serendipity.pddl.write import composite_files

MODES: Final = {name: options for name, options in every.MODES.items() if name != "serendipity-k0"}

_SLOW: Final = 1.0
"""Seconds; a first pass that takes longer is no warm-up but the figure itself."""


def _search(prepared: PreparedTask, options: Options) -> Outcome:
    """Every table that is not there yet is built inside the time."""
    answers, seconds = timed(lambda: list(solve(prepared, options, deadline=Deadline(options.time_limit))))
    cost = answers[-1].cost
    return Outcome(answers[-1].status, None if cost is None else float(cost), seconds=seconds)


def _program(encoding: str) -> Callable[[PreparedTask, Options], Outcome]:
    def answer(prepared: PreparedTask, options: Options) -> Outcome:
        from verify.calls.solve import solve as by_program  # loads a solver

        result, seconds = timed(lambda: by_program(prepared.task, options, encoding=encoding))
        return Outcome(result.status, result.cost, seconds=seconds)

    return answer


def _fast_downward(prepared: PreparedTask, options: Options) -> Outcome:
    files = composite_files(prepared.task, options.discount)
    return outside(files, fast_downward.LMCUT, options.time_limit, ground=True)


CONTENDERS: Final[dict[str, Contender]] = {
    "search": Contender(_search, afresh=True),
    "in-turn": Contender(_search, afresh=True, in_turn=True),
    "again": Contender(_search),
    "automata": Contender(_program("automata")),
    "paper": Contender(_program("paper"), [*MODES][:-1]),  # its epochs are numbered
    "fast-downward": Contender(_fast_downward, ["composite-inf"], fast_downward.absent),
}
"""Our search: first calls, one discount after another, the same call again; our integer program,
the paper's, and Fast Downward."""

SEARCHES: Final = ("search", "in-turn", "again")
"""Ways to call our search: what the others are compared with."""


def measure(
    tasks: Iterable[Task],
    modes: Iterable[str],
    discounts: Iterable[str],
    contenders: Iterable[str],
    *,
    repeat: int = 5,
    time_limit: float | None = None,
) -> Iterator[BenchRow]:
    """Time each contender on each call of a mode that it knows; who is absent must be left out before.

    A figure is of ``repeat`` calls after a warm-up, or, where discounts are answered in turn, of as many
    passes through all of them.  What takes over a second is done once.

    Raises:
        UsageError: a mode or contender is unknown.
        DisagreementError: two that proved an answer disagree.
    """
    who, kinds = chosen(contenders, CONTENDERS, "contenders"), chosen(modes, MODES, "modes")
    discounts = list(discounts)
    gc.collect()
    gc.freeze()  # a caller has one task in memory, not all of these
    try:
        for task in tasks:
            prepared = prepare(task)
            for mode, fixed in kinds.items():
                asked = [Options(discount=text, time_limit=time_limit, **fixed) for text in discounts]
                answers = {
                    name: _answers(contender, prepared, asked, repeat)
                    for name, contender in who.items()
                    if mode in contender.modes
                }
                for i, options in enumerate(asked):
                    call = ("", task.name, "", "", True, mode, float(options.discount))
                    rows = [BenchRow(*call, name, _median(of[i])) for name, of in answers.items()]
                    for told in disagreements(rows):
                        raise DisagreementError(told)
                    yield from rows
    finally:
        gc.unfreeze()


def _answers(
    contender: Contender, prepared: PreparedTask, calls: Sequence[Options], repeat: int
) -> list[tuple[Outcome, ...]]:
    """All answers to each call."""
    passes = [calls] if contender.in_turn else [[call] for call in calls]
    return [answers for one in passes for answers in _repeated(contender, prepared, one, repeat)]


def _repeated(
    contender: Contender, prepared: PreparedTask, calls: Sequence[Options], repeat: int
) -> list[tuple[Outcome, ...]]:
    warm_up = _pass(contender, prepared, calls)
    slow = sum(max(answer.seconds, answer.process_seconds) for answer in warm_up) > _SLOW
    passes = [warm_up] if slow else [_pass(contender, prepared, calls) for _ in range(repeat)]
    return list(zip(*passes, strict=True))


def _pass(contender: Contender, prepared: PreparedTask, calls: Sequence[Options]) -> list[Outcome]:
    if contender.afresh:
        prepared = prepare(prepared.task)
    return [contender.answer(prepared, options) for options in calls]


def _median(answers: Sequence[Outcome]) -> Outcome:
    seconds = [answer.seconds for answer in answers]
    return replace(
        answers[-1],
        seconds=statistics.median(seconds),
        fastest=min(seconds),
        slowest=max(seconds),
        repeats=len(answers),
        process_seconds=statistics.median(answer.process_seconds for answer in answers),
    )


Figure = tuple[float, bool]
"""A time or a ratio, and whether a limit made it too small."""


def ratios(rows: Sequence[BenchRow]) -> Grid:
    """Times of each contender as multiples of each way to call the search, on the same calls.

    First the ratios of medians and of 95th percentiles, then percentiles of the ratios of single calls.  What
    met the limit counts with what it had taken by then; what the search itself did not prove is left out:
    ``calls`` says how many are counted, of how many.
    """
    groups = _groups(rows)
    header = ["mode", "contender", "over", "calls", "of medians", "of 95 %", "call by call: 50 %", "95 %"]
    lines = [
        [mode, contender, search, *_ratios(of, groups[mode, search])]
        for (mode, contender), of in groups.items()
        for search in (SEARCHES if contender not in SEARCHES else ())
        if (mode, search) in groups
    ]
    return Grid([*header, "least"], lines)


def _ratios(of: Sequence[BenchRow], searches: Sequence[BenchRow]) -> Iterator[str]:
    base = {(row.task, row.discount): row.outcome.seconds for row in searches if row.outcome.proved}
    pairs = [(_seconds(row), base[row.task, row.discount]) for row in of if (row.task, row.discount) in base]
    yield str(len(of)) if len(pairs) == len(of) else f"{len(pairs)} of {len(of)}"
    if not pairs:
        yield from ("",) * 5
        return
    for share in (0.5, 0.95):
        value, cut = _percentile([theirs for theirs, _ in pairs], share)
        yield _ratio(value / percentile([ours for _, ours in pairs], share), cut)
    single = [(value / ours, cut) for (value, cut), ours in pairs]
    yield from (_ratio(*_percentile(single, share)) for share in (0.5, 0.95, 0.0))


def times(rows: Sequence[BenchRow]) -> Grid:
    """A row for each mode and contender: of the median times of each call, but for min-max."""
    header = ["mode", "contender", "calls", "proved", "median", "95 %", "longest", "min-max"]
    return Grid(header, [[*key, *_times(of)] for key, of in _groups(rows).items()])


def _times(rows: Sequence[BenchRow]) -> Iterator[str]:
    outcomes = [row.outcome for row in rows]
    yield from (str(len(rows)), str(sum(outcome.proved for outcome in outcomes)))
    for share in (0.5, 0.95, 1.0):
        value, cut = _percentile([*map(_seconds, rows)], share)
        yield f"{'>= ' * cut}{value * 1000:.2f} ms"
    least, most = (min(o.fastest or 0 for o in outcomes), max(o.slowest or 0 for o in outcomes))
    yield f"{least * 1000:.2f}-{most * 1000:.2f} ms"


def _groups(rows: Sequence[BenchRow]) -> dict[tuple[str, str], list[BenchRow]]:
    """Rows by mode and contender; an outside process is a contender beside what it says of itself."""
    return grouped(_with_processes(rows), lambda row: (row.mode, row.contender))


def _with_processes(rows: Sequence[BenchRow]) -> Iterator[BenchRow]:
    for row in rows:
        yield row
        if seconds := row.outcome.process_seconds:
            outcome = replace(row.outcome, seconds=seconds, fastest=seconds, slowest=seconds)
            yield replace(row, contender=f"{row.contender}, process", outcome=outcome)


def _seconds(row: BenchRow) -> Figure:
    return row.outcome.seconds, not row.outcome.proved


def _percentile(figures: Sequence[Figure], share: float) -> Figure:
    """The figure below which a share of them lies; cut if it could be larger without a limit."""
    value = percentile([figure for figure, _ in figures], share)
    return value, any(cut and figure <= value for figure, cut in figures)


def _ratio(value: float, cut: bool) -> str:
    return f"{'>= ' * cut}{value:,.{2 if value < 10 else 0}f} x"
