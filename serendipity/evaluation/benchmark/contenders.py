"""Who answers the calls of a benchmark."""

import time
from collections.abc import Callable
from dataclasses import dataclass
from typing import Final

from search import PreparedTask, solve
from serendipity.evaluation.benchmark import fast_downward
from serendipity.evaluation.benchmark.answer import Answer
from serendipity.evaluation.benchmark.usage import children_seconds
from serendipity.model.options import INFINITE, Options
from serendipity.model.resources.collection import no_collection
from serendipity.model.resources.deadline import Deadline
from serendipity.pddl.write import composite_files


@dataclass(frozen=True, slots=True)
class Contender:
    """One way to answer calls.

    Attributes:
        answer: answers a call and times itself.
        accepts: whether it can answer a call with these options at all.
        absent: why it can't run here, or None.
        afresh: whether the task is prepared anew before each pass, without anything that earlier
            calls have found out.
        in_turn: whether a pass is all calls on a task, one after another; else it is one call.
    """

    answer: Callable[[PreparedTask, Options], Answer]
    accepts: Callable[[Options], bool] = lambda _: True
    absent: Callable[[], str | None] = lambda: None
    afresh: bool = False
    in_turn: bool = False


def _search(prepared: PreparedTask, options: Options) -> Answer:
    """Every table that is not there yet is built inside the time."""
    with no_collection():  # as `plan` does
        start = time.process_time()
        *_, outcome = solve(prepared, options, deadline=Deadline(options.time_limit))
        seconds = time.process_time() - start
    return Answer(seconds, outcome.status, None if outcome.cost is None else float(outcome.cost))


def _program(encoding: str) -> Callable[[PreparedTask, Options], Answer]:
    def answer(prepared: PreparedTask, options: Options) -> Answer:
        from verify.calls.solve import solve as by_program  # loads a solver

        with no_collection():
            start = time.process_time() + children_seconds()  # solvers are processes of their own
            result = by_program(prepared.task, options, encoding=encoding)
            seconds = time.process_time() + children_seconds() - start
        return Answer(seconds, result.status, result.cost)

    return answer


def _fast_downward(prepared: PreparedTask, options: Options) -> Answer:
    """``seconds`` is the search time that it prints, or all that it took until the limit."""
    files = composite_files(prepared.task, options.discount)
    found = fast_downward.run(files, fast_downward.LMCUT, options.time_limit, invariants=False)
    return Answer(
        found.process_seconds if found.status == "unknown" else found.search_seconds,
        found.status,
        None if found.cost is None else float(found.cost),
        process_seconds=found.process_seconds,
        memory=found.memory,
    )


def _without_horizon(options: Options) -> bool:
    return options.horizon == INFINITE


def _with_horizon(options: Options) -> bool:
    return not _without_horizon(options)


CONTENDERS: Final[dict[str, Contender]] = {
    "search": Contender(_search, afresh=True),
    "in-turn": Contender(_search, afresh=True, in_turn=True),
    "again": Contender(_search),
    "automata": Contender(_program("automata")),
    "paper": Contender(_program("paper"), _with_horizon),  # its epochs are numbered
    "fast-downward": Contender(_fast_downward, _without_horizon, fast_downward.absent),
}
"""Our search: first calls, one discount after another, the same call again; our integer program,
the paper's, and Fast Downward."""

SEARCHES: Final = ("search", "in-turn", "again")
"""Ways to call our search: what the others are compared with."""
