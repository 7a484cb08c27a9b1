"""Contenders of a benchmark, and their answers to its calls."""

import time
from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass
from typing import Any, Final

from search import prepare, solve
from serendipity.classical import fast_downward
from serendipity.evaluation.measuring.figures import children_seconds, peak_memory, timed
from serendipity.model.answers.answer import Answer
from serendipity.model.errors import LIMITS
from serendipity.model.options import INFINITE, Options
from serendipity.model.resources.collection import no_collection
from serendipity.model.resources.deadline import Deadline
from serendipity.model.task.task import Task
from serendipity.pddl.classical import ClassicalFiles

MODES: Final[dict[str, dict[str, Any]]] = {
    "individual": {"mode": "individual"},
    "serendipity": {"mode": "serendipity"},
    "serendipity-k0": {"mode": "serendipity", "window_weight": 0},
    "communication": {"mode": "communication"},
    "composite": {"mode": "composite"},
    "composite-inf": {"mode": "composite", "horizon": INFINITE},
}
"""Modes by the names that benchmarks have for them; ``k0`` is for ``K`` = 0, ``inf`` for no horizon."""


@dataclass(frozen=True, slots=True)
class Outcome:
    """A contender's answer, and the time and memory it took.

    Attributes:
        status: as in results; ``failed`` where it could not be asked, ``error`` where the task is broken.
        cost: of its plan, for the team, in the domain's unit; None without one.
        lower_bound: of the objective; None where none is known.
        expanded: nodes.
        seconds: until the answer, once the files are read and ground; a median where it was asked again.
        plan_seconds: likewise until the first plan; None without one.
        read_seconds: of reading, grounding, and looking for variables.
        prepare_seconds: of ``seconds``, what is done once for a task.
        again_seconds: of the same call once more, where it was asked again after all.
        process_seconds: processor time of all that it did, where that is looked at.
        memory: its peak in MiB, where that is known.
        actions: ground actions of the task; ``length`` is that of the human's plan.
        fastest: the least seconds of several calls, ``slowest`` the greatest, ``repeats`` their number.
        reason: why it failed, or what is broken.
    """

    status: str
    cost: float | None = None
    lower_bound: float | None = None
    expanded: int = 0
    seconds: float = 0.0
    plan_seconds: float | None = None
    read_seconds: float = 0.0
    prepare_seconds: float = 0.0
    again_seconds: float | None = None
    process_seconds: float = 0.0
    memory: float | None = None
    actions: int = 0
    length: int = 0
    fastest: float | None = None
    slowest: float | None = None
    repeats: int = 1
    reason: str = ""

    @property
    def proved(self) -> bool:
        """True if no limit came before the proof."""
        return self.status in ("optimal", "infeasible")


@dataclass(frozen=True, slots=True)
class Contender:
    """One way to answer calls.

    Attributes:
        answer: answers a call and times itself.
        modes: what it can be asked.
        absent: why it can't run here, or None.
        afresh: whether the task is prepared anew before each pass, without anything that earlier
            calls have found out.
        in_turn: whether a pass is all calls on a task, one after another; else it is one call.
    """

    answer: Callable[..., Outcome]
    modes: Sequence[str] = tuple(MODES)
    absent: Callable[[], str | None] = lambda: None
    afresh: bool = False
    in_turn: bool = False


def searched(
    load: Callable[..., Task],
    options: Mapping[str, Any],
    time_limit: float,
    *,
    reading: float | None = None,
    again: bool = False,
) -> Outcome:
    """The search's answer, for a process of its own: no other call warms it up, and all memory is its own.

    ``load`` reads the task within a ``deadline`` of ``reading`` seconds; the limit is by the clock, for
    preparing and planning.  With ``again`` the same call is asked once more.
    """
    asked = Options(**options)
    try:
        task, read_seconds = timed(lambda: load(deadline=Deadline(reading)))
    except LIMITS:
        return Outcome("unknown", process_seconds=time.process_time(), memory=peak_memory())
    answer, prepared, packed, first, repeated = Answer("unknown"), None, 0.0, None, None
    deadline, began = Deadline(time_limit), time.process_time()
    with suppress(*LIMITS), no_collection():  # as `plan` does
        prepared = prepare(task, deadline)
        packed = time.process_time() - began
        for answer in solve(prepared, asked, deadline=deadline):
            if first is None and answer.cost is not None:
                first = time.process_time() - began
    seconds = time.process_time() - began
    if again and prepared is not None:
        _, repeated = timed(lambda: [*solve(prepared, asked, deadline=Deadline(time_limit))])
    return Outcome(
        answer.status,
        None if answer.cost is None else float(answer.cost),
        None if answer.lower_bound is None else float(answer.lower_bound),
        answer.expanded or 0,
        seconds=seconds,
        plan_seconds=first,
        read_seconds=read_seconds,
        prepare_seconds=packed,
        again_seconds=repeated,
        process_seconds=time.process_time(),
        memory=peak_memory(),
        actions=len(task.actions),
        length=len(answer.human_plan or ()),
    )


def outside(
    files: ClassicalFiles, search: fast_downward.Search, time_limit: float | None, *, ground: bool = False
) -> Outcome:
    """A planner for a single agent's answer; ``seconds`` are of its search process, by its own clock.

    Where nothing is left to be ground, they are its search time, or all processor time until the limit.

    Raises:
        SerendipityError: it fails, with what it says.
    """
    before = children_seconds()
    found = fast_downward.run(files, search, time_limit, invariants=not ground)
    used, seconds = children_seconds() - before, found.seconds
    if ground:
        seconds = used if found.status == "unknown" else found.search_seconds
    same = ("status", "cost", "lower_bound", "expanded", "read_seconds", "memory")
    first = None if found.cost is None else found.seconds
    about = {name: getattr(found, name) for name in same}
    return Outcome(**about, seconds=seconds, plan_seconds=first, process_seconds=used)
