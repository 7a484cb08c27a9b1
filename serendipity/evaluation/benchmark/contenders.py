"""Contenders of a benchmark, and their answers to its calls."""

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Final, TypeVar

from serendipity.evaluation.measuring.tables import Proved
from serendipity.model.errors import UsageError
from serendipity.model.options import INFINITE

T = TypeVar("T")

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
class Outcome(Proved):
    """A contender's answer, and the time and memory it took.

    Attributes:
        status: as in results; ``failed`` where it could not be asked, ``error`` where the task is broken.
        cost: of its plan, for the team, in the domain's unit; None without one.
        lower_bound: of the objective; None where none is known.
        expanded: nodes.
        seconds: until the answer, once the files are read and ground.
        plan_seconds: likewise until the first plan; None without one.
        read_seconds: of reading, grounding, and looking for variables.
        process_seconds: processor time of all that it did, where that is looked at.
        memory: its peak in MiB, where that is known.
        reason: why it failed, or what is broken.
    """

    status: str
    cost: float | None = None
    lower_bound: float | None = None
    expanded: int = 0
    seconds: float = 0.0
    plan_seconds: float | None = None
    read_seconds: float = 0.0
    process_seconds: float = 0.0
    memory: float | None = None
    reason: str = ""


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


def chosen(names: Iterable[str], known: Mapping[str, T], what: str, where: str = "") -> dict[str, T]:
    """Values by their names, in the order in which they are named.

    Raises:
        UsageError: for nothing; it says ``what`` they are names of, and ``where``.
    """
    found = {}
    for name in names:
        if name not in known:
            raise UsageError(f"{what}: expected some of {', '.join(known)}{where}, got '{name}'")
        found[name] = known[name]
    return found
