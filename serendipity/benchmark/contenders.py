"""Who answers the calls of a benchmark."""

import time
from collections.abc import Callable
from dataclasses import dataclass
from typing import Final

from search import Clock, prepare, solve
from serendipity.benchmark import fast_downward
from serendipity.benchmark.answer import Answer
from serendipity.model.options import INFINITE, Options
from serendipity.model.task import Task


@dataclass(frozen=True, slots=True)
class Contender:
    """One way to answer calls.

    Attributes:
        answer: answers a call and times itself.
        accepts: whether it can answer a call with these options at all.
        absent: why it can't run here, or None.
    """

    answer: Callable[[Task, Options], Answer]
    accepts: Callable[[Options], bool] = lambda _: True
    absent: Callable[[], str | None] = lambda: None


def _search(task: Task, options: Options) -> Answer:
    """The first call on a packed task: every other table is built inside the time."""
    prepare(task, afresh=True)
    return _again(task, options)


def _again(task: Task, options: Options) -> Answer:
    """The same call again, as in a control loop: the warm-up has left its tables with the task."""
    start = time.process_time()
    *_, outcome = solve(task, options, clock=Clock(options.time_limit))
    seconds = time.process_time() - start
    return Answer(seconds, outcome.status, None if outcome.cost is None else float(outcome.cost))


def _program(encoding: str) -> Callable[[Task, Options], Answer]:
    def answer(task: Task, options: Options) -> Answer:
        from verify.solve import solve as by_program  # loads a solver

        start = time.process_time()
        result = by_program(task, options, encoding=encoding)
        return Answer(time.process_time() - start, result.status, result.cost)

    return answer


def _without_horizon(options: Options) -> bool:
    return options.horizon == INFINITE


def _with_horizon(options: Options) -> bool:
    return not _without_horizon(options)


CONTENDERS: Final[dict[str, Contender]] = {
    "search": Contender(_search),
    "again": Contender(_again),
    "automata": Contender(_program("automata")),
    "paper": Contender(_program("paper"), _with_horizon),  # its epochs are numbered
    "fast-downward": Contender(fast_downward.answer, _without_horizon, fast_downward.absent),
}
"""Our search, also when it is called again, our integer program, the paper's, and Fast Downward."""
