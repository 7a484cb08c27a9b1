"""Each contender on each call, one after another, warmed up."""

import gc
import statistics
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Final, TypeVar

from search import PreparedTask, prepare
from serendipity.evaluation.benchmark.answer import Answer
from serendipity.evaluation.benchmark.contenders import CONTENDERS, Contender
from serendipity.model.errors import DisagreementError, UsageError, told
from serendipity.model.options import INFINITE, Options
from serendipity.model.task.task import Task

T = TypeVar("T")

MODES: Final[dict[str, dict[str, Any]]] = {
    "individual": {"mode": "individual"},
    "serendipity": {"mode": "serendipity"},
    "communication": {"mode": "communication"},
    "composite": {"mode": "composite"},
    "composite-inf": {"mode": "composite", "horizon": INFINITE},
}
"""Modes by the names that a benchmark has for them: composite also without a horizon."""

_SLOW: Final = 1.0
"""Seconds; a first pass that takes longer is no warm-up but the figure itself."""


@dataclass(frozen=True, slots=True)
class Timing:
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

    @property
    def solved(self) -> bool:
        """Whether it is proved."""
        return self.status in ("optimal", "infeasible")


def measure(
    tasks: Iterable[Task],
    modes: Iterable[str],
    discounts: Iterable[str],
    contenders: Iterable[str],
    *,
    repeat: int = 5,
    time_limit: float | None = None,
) -> Iterator[Timing]:
    """Time each contender on each call that it accepts: it is asked all discounts of a mode, or none.

    Args:
        tasks: the tasks.
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
    chosen = {name: _known(name, CONTENDERS, "contenders") for name in contenders}
    kinds = {name: _known(name, MODES, "modes") for name in modes}
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
                    for name, contender in chosen.items()
                    if all(map(contender.accepts, asked))
                }
                for i, discount in enumerate(discounts):
                    found = [
                        _timing((task.name, mode, discount, name), of[i]) for name, of in answers.items()
                    ]
                    _compare(found)
                    yield from found
    finally:
        gc.unfreeze()


def broken(task: str, error: Exception) -> Timing:
    """What stands for all calls of a task that can't be read."""
    return Timing(task, "", "", "", 0.0, 0.0, 0.0, 0, "error", None, None, None, told(error))


def _known(name: str, known: Mapping[str, T], what: str) -> T:
    if name not in known:
        raise UsageError(f"{what}: expected some of {', '.join(known)}, got '{name}'")
    return known[name]


def _answers(
    contender: Contender, prepared: PreparedTask, calls: Sequence[Options], repeat: int
) -> list[tuple[Answer, ...]]:
    """All answers to each call."""
    passes = [calls] if contender.in_turn else [[call] for call in calls]
    return [answers for one in passes for answers in _repeated(contender, prepared, one, repeat)]


def _repeated(
    contender: Contender, prepared: PreparedTask, calls: Sequence[Options], repeat: int
) -> list[tuple[Answer, ...]]:
    warm_up = _pass(contender, prepared, calls)
    slow = sum(max(answer.seconds, answer.process_seconds or 0) for answer in warm_up) > _SLOW
    passes = [warm_up] if slow else [_pass(contender, prepared, calls) for _ in range(repeat)]
    return list(zip(*passes, strict=True))


def _pass(contender: Contender, prepared: PreparedTask, calls: Sequence[Options]) -> list[Answer]:
    if contender.afresh:
        prepared = prepare(prepared.task)
    return [contender.answer(prepared, options) for options in calls]


def _timing(call: tuple[str, str, str, str], answers: Sequence[Answer]) -> Timing:
    seconds = [answer.seconds for answer in answers]
    last = answers[-1]
    of_processes = [answer.process_seconds for answer in answers if answer.process_seconds is not None]
    return Timing(
        *call,
        seconds=statistics.median(seconds),
        fastest=min(seconds),
        slowest=max(seconds),
        repeats=len(answers),
        status=last.status,
        cost=last.cost,
        process_seconds=statistics.median(of_processes) if of_processes else None,
        memory=last.memory,
    )


def _compare(found: list[Timing]) -> None:
    costs = {timing.contender: timing.cost for timing in found if timing.solved}
    if len(set(costs.values())) > 1:
        told = ", ".join(f"{name} {cost}" for name, cost in costs.items())
        call = found[0]
        raise DisagreementError(
            f"{call.task}, {call.mode} at {call.discount}: the proved optima differ: {told}"
        )
