"""Each contender on each call of a suite, one after another."""

import subprocess
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from fractions import Fraction
from functools import partial
from typing import Final

from serendipity.evaluation.benchmark import contenders as every
from serendipity.evaluation.benchmark import fast_downward
from serendipity.evaluation.benchmark.child import in_child
from serendipity.evaluation.benchmark.contenders import Contender, Outcome, chosen
from serendipity.evaluation.measuring.suites import Problem, Roles, roles
from serendipity.model.errors import SerendipityError, told
from serendipity.model.numbers import Number, exact
from serendipity.pddl.classical import lifted_files

MODES: Final = {name: options for name, options in every.MODES.items() if name != "composite"}

CLASSICAL: Final = ("individual", "composite-inf")
"""Modes that planners for a single agent know; they need no plan of the human alone either."""

_SHORT: Final = 5.0
"""Seconds for each look whether an agent can do it alone."""

_START: Final = 10.0
"""Seconds for what no limit covers: starting, and leaving."""


@dataclass(frozen=True, slots=True)
class Call:
    """A planning call: a problem, its roles, a mode in :data:`MODES`, and seconds for an answer."""

    problem: Problem
    roles: Roles
    mode: str
    discount: Fraction
    time_limit: float


@dataclass(frozen=True, slots=True)
class Row:
    """A call and a contender's answer.

    Attributes:
        domain: of the problem.
        task: its name.
        human: who is the human.
        robots: who are robots, with blanks between them.
        alone: whether the human is known to have a plan alone.
        mode: as the benchmark calls it.
        discount: of what robots do.
        contender: who answers.
        outcome: the answer, and what it took.
    """

    domain: str
    task: str
    human: str
    robots: str
    alone: bool
    mode: str
    discount: float
    contender: str
    outcome: Outcome


def _search(call: Call) -> Outcome:
    most = 2 * call.time_limit + _START
    try:
        said = in_child(
            "suite",
            most=most,
            domain=str(call.problem.domain_file),
            problem=str(call.problem.problem_file),
            human=call.roles.human,
            robots=call.roles.robots,
            options={**MODES[call.mode], "discount": str(call.discount)},
            time_limit=call.time_limit,
        )
    except subprocess.TimeoutExpired:
        return Outcome("failed", seconds=most, reason=f"ended after {most:g} s")
    except SerendipityError as error:
        return Outcome("failed", reason=str(error))
    return Outcome(**said)


def _fast_downward(search: str, call: Call) -> Outcome:
    shares = {call.roles.human: Fraction(1)}
    if call.mode != "individual":
        shares |= dict.fromkeys(call.roles.robots, 1 - call.discount)
    try:
        return fast_downward.run(lifted_files(call.problem.unit(), shares), search, call.time_limit)
    except SerendipityError as error:
        return Outcome("failed", reason=str(error))


def _classical(search: str) -> Contender:
    return Contender(partial(_fast_downward, search), CLASSICAL, fast_downward.absent)


CONTENDERS: Final[dict[str, Contender]] = {
    "search": Contender(_search),
    "fast-downward": _classical(fast_downward.LMCUT),
    "fast-downward-ipdb": _classical(fast_downward.IPDB),
}
"""Our search, and Fast Downward with two heuristics."""


def can_alone(problem: Problem, who: Roles, time_limit: float) -> bool:
    """True if the human is found to have a plan alone: by the search, else by Fast Downward.

    Args:
        who: who it is about.
        time_limit: seconds for each of them.
    """
    call = Call(problem, who, "individual", Fraction(0), time_limit)
    found = _search(call).status
    if found in ("unknown", "failed") and fast_downward.absent() is None:
        found = _fast_downward(fast_downward.ANY_PLAN, call).status
    return found in ("optimal", "feasible")


def measure(
    problems: Iterable[Problem],
    modes: Iterable[str],
    contenders: Iterable[str],
    *,
    discount: Number = "0.9",
    robots: int = 2,
    time_limit: float = 20.0,
) -> Iterator[Row]:
    """Ask each contender each call that it knows.

    Where the human is not known to have a plan alone, nothing is asked that is about that plan.

    Args:
        problems: of a suite.
        modes: names in ``MODES``.
        contenders: names in ``CONTENDERS``; those that are absent must be left out before.
        discount: of what robots do.
        robots: how many there are at most.
        time_limit: seconds for each call, and as many for reading it.

    A problem that can't be read is one row for each contender, with status ``error``.

    Raises:
        UsageError: a mode, a contender or the discount is unknown.
    """
    asked = [*chosen(modes, MODES, "modes", " for a suite of domains")]
    who_answers = chosen(contenders, CONTENDERS, "contenders", " for a suite of domains")
    share = exact(discount, "discount")
    short = min(_SHORT, time_limit)
    for problem in problems:
        try:
            who = roles(problem, robots, lambda problem, who: can_alone(problem, who, short))
        except Exception as error:  # one broken task does not end a suite
            broken = Call(problem, Roles("", ()), asked[0], share, time_limit)
            yield from (_row(broken, name, Outcome("error", reason=told(error))) for name in who_answers)
            continue
        calls = [
            Call(problem, who, mode, share, time_limit) for mode in asked if who.alone or mode in CLASSICAL
        ]
        for call in calls:
            for name, contender in who_answers.items():
                if call.mode in contender.modes:
                    yield _row(call, name, contender.answer(call))


def _row(call: Call, contender: str, outcome: Outcome) -> Row:
    return Row(
        domain=call.problem.domain,
        task=call.problem.name,
        human=call.roles.human,
        robots=" ".join(call.roles.robots),
        alone=call.roles.alone,
        mode=call.mode,
        discount=float(call.discount),
        contender=contender,
        outcome=outcome,
    )
