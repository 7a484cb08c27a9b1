"""Side by side: each contender on each call, one after another, warmed up."""

import gc
import statistics
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Final

from search import PreparedTask, prepare, solve
from serendipity.evaluation.benchmark import contenders as every
from serendipity.evaluation.benchmark import fast_downward
from serendipity.evaluation.benchmark.contenders import Contender, Outcome, chosen
from serendipity.evaluation.measuring.figures import timed
from serendipity.evaluation.measuring.tables import Proved
from serendipity.model.errors import DisagreementError, told
from serendipity.model.options import Options
from serendipity.model.resources.deadline import Deadline
from serendipity.model.task.task import Task
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
    """``seconds`` is the search time that it prints, or all that it took until the limit."""
    files = composite_files(prepared.task, options.discount)
    found = fast_downward.run(files, fast_downward.LMCUT, options.time_limit, invariants=False)
    return replace(
        found, seconds=found.process_seconds if found.status == "unknown" else found.search_seconds
    )


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


@dataclass(frozen=True, slots=True)
class MeasuredCall(Proved):
    """One contender's answer to one call.

    Attributes:
        task: its name.
        mode: a key of ``MODES``.
        seconds: median of the repetitions.
        fastest: the least of them; ``slowest`` the greatest.
        repeats: how many there were.
        cost: None where there is none, or the limit came first.
        process_seconds: median for contenders that are processes, from files to answer.
        memory: peak memory of such a process, in MiB.
        reason: of an ``error``, which stands for all calls of a task.
    """

    task: str
    mode: str
    discount: str
    contender: str
    seconds: float
    fastest: float
    slowest: float
    repeats: int
    status: str
    cost: float | None
    process_seconds: float | None
    memory: float | None
    reason: str | None = None


def measure(
    tasks: Iterable[Task],
    modes: Iterable[str],
    discounts: Iterable[str],
    contenders: Iterable[str],
    *,
    repeat: int = 5,
    time_limit: float | None = None,
) -> Iterator[MeasuredCall]:
    """Time each contender on each call of a mode that it knows.

    Args:
        modes: names in ``MODES``.
        discounts: as texts, so that they stay exact.
        contenders: names in ``CONTENDERS``; those that are absent must be left out before.
        repeat: calls per figure, after a warm-up; for contenders that answer the discounts in
            turn, passes through all of them.  What takes over a second is done once.
        time_limit: seconds for each call.

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
                for i, discount in enumerate(discounts):
                    found = [
                        _timing((task.name, mode, discount, name), of[i]) for name, of in answers.items()
                    ]
                    _compare(found)
                    yield from found
    finally:
        gc.unfreeze()


def broken(task: str, error: Exception) -> MeasuredCall:
    """The row that stands for all calls of a task that can't be read."""
    return MeasuredCall(task, "", "", "", 0.0, 0.0, 0.0, 0, "error", None, None, None, told(error))


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


def _timing(call: tuple[str, str, str, str], answers: Sequence[Outcome]) -> MeasuredCall:
    seconds = [answer.seconds for answer in answers]
    last = answers[-1]
    return MeasuredCall(
        *call,
        seconds=statistics.median(seconds),
        fastest=min(seconds),
        slowest=max(seconds),
        repeats=len(answers),
        status=last.status,
        cost=last.cost,
        process_seconds=statistics.median(answer.process_seconds for answer in answers) or None,
        memory=last.memory,
    )


def _compare(found: list[MeasuredCall]) -> None:
    costs = {timing.contender: timing.cost for timing in found if timing.proved}
    if len(set(costs.values())) > 1:
        told = ", ".join(f"{name} {cost}" for name, cost in costs.items())
        call = found[0]
        raise DisagreementError(
            f"{call.task}, {call.mode} at {call.discount}: the proved optima differ: {told}"
        )
