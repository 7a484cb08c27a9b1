"""Who answers the calls of a suite, each in processes of its own."""

import json
import subprocess
import sys
from collections.abc import Callable
from dataclasses import dataclass
from fractions import Fraction
from functools import partial
from typing import Any, Final

from serendipity.evaluation.benchmark import fast_downward
from serendipity.evaluation.benchmark.coverage.suite import Problem, Roles
from serendipity.model.errors import SerendipityError
from serendipity.model.options import INFINITE
from serendipity.pddl.classical import lifted_files

MODES: Final[dict[str, dict[str, Any]]] = {
    "individual": {"mode": "individual"},
    "serendipity": {"mode": "serendipity"},
    "serendipity-k0": {"mode": "serendipity", "window_weight": 0},
    "communication": {"mode": "communication"},
    "composite-inf": {"mode": "composite", "horizon": INFINITE},
}
"""Modes by the names that the benchmark has for them."""

CLASSICAL: Final = ("individual", "composite-inf")
"""Those that planners for a single agent know; they need no plan of the human alone either."""

_CHILD: Final = "serendipity.evaluation.benchmark.coverage.child"
_START: Final = 10.0
"""Seconds for what no limit covers: starting, and leaving."""


@dataclass(frozen=True, slots=True)
class Call:
    """What is asked: a problem, who is who, a mode in :data:`MODES`, and seconds for an answer."""

    problem: Problem
    roles: Roles
    mode: str
    discount: Fraction
    time_limit: float


@dataclass(frozen=True, slots=True)
class Outcome:
    """What a contender says, and what it took.

    Attributes:
        status: ``optimal``, ``feasible``, ``infeasible``, ``unknown``, or ``failed``.
        cost: of its plan, for the team; None without one.
        lower_bound: of the objective; None where none is known.
        expanded: nodes.
        seconds: until the answer, by the clock, once the files are read and ground.
        plan_seconds: likewise until the first plan; None without one.
        read_seconds: of reading, grounding, and looking for variables, by the clock.
        process_seconds: processor time of all that it did.
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
        answer: answers a call.
        modes: what it can be asked.
        absent: why it can't run here, or None.
    """

    answer: Callable[[Call], Outcome]
    modes: tuple[str, ...] = tuple(MODES)
    absent: Callable[[], str | None] = lambda: None


def _search(call: Call) -> Outcome:
    asked = {
        "domain": str(call.problem.domain_file),
        "problem": str(call.problem.problem_file),
        "human": call.roles.human,
        "robots": call.roles.robots,
        "options": {**MODES[call.mode], "discount": str(call.discount)},
        "time_limit": call.time_limit,
    }
    most = 2 * call.time_limit + _START
    try:
        done = subprocess.run(
            [sys.executable, "-m", _CHILD, json.dumps(asked)],
            capture_output=True,
            text=True,
            check=False,
            timeout=most,
        )
    except subprocess.TimeoutExpired:
        return Outcome("failed", seconds=most, reason=f"ended after {most:g} s")
    if done.returncode:
        last = done.stderr.strip().rpartition("\n")[2]
        return Outcome("failed", reason=last or f"exit code {done.returncode}")
    return Outcome(**json.loads(done.stdout))


def _fast_downward(search: str, call: Call) -> Outcome:
    shares = {call.roles.human: Fraction(1)}
    if call.mode != "individual":
        shares |= dict.fromkeys(call.roles.robots, 1 - call.discount)
    try:
        files = lifted_files(call.problem.unit(), shares)
        found = fast_downward.run(files, search, call.time_limit)
    except SerendipityError as error:
        return Outcome("failed", reason=str(error))
    return Outcome(
        status=found.status,
        cost=None if found.cost is None else float(found.cost),
        lower_bound=None if found.lower_bound is None else float(found.lower_bound),
        expanded=found.expanded,
        seconds=found.seconds,
        plan_seconds=None if found.cost is None else found.seconds,
        read_seconds=found.translate_seconds,
        process_seconds=found.process_seconds,
        memory=found.memory,
    )


def _classical(search: str) -> Contender:
    return Contender(partial(_fast_downward, search), CLASSICAL, fast_downward.absent)


CONTENDERS: Final[dict[str, Contender]] = {
    "search": Contender(_search),
    "fast-downward": _classical(fast_downward.LMCUT),
    "fast-downward-ipdb": _classical(fast_downward.IPDB),
}
"""Our search, and Fast Downward with two heuristics."""


def can_alone(problem: Problem, roles: Roles, time_limit: float) -> bool:
    """Whether the human is found to have a plan alone: by the search, else by Fast Downward.

    Args:
        problem: the problem.
        roles: who it is about.
        time_limit: seconds for each of them.
    """
    call = Call(problem, roles, "individual", Fraction(0), time_limit)
    found = _search(call).status
    if found in ("unknown", "failed") and fast_downward.absent() is None:
        found = _fast_downward(fast_downward.ANY_PLAN, call).status
    return found in ("optimal", "feasible")
