"""Each contender on each call of a suite, one after another."""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Final, TypeVar

from serendipity.evaluation.benchmark.coverage.contenders import (
    CLASSICAL,
    CONTENDERS,
    MODES,
    Call,
    Outcome,
    can_alone,
)
from serendipity.evaluation.benchmark.coverage.suite import Problem, Roles, roles
from serendipity.model.errors import UsageError, told
from serendipity.model.numbers import Number, exact

T = TypeVar("T")

_SHORT: Final = 5.0
"""Seconds for each look whether an agent can do it alone."""


@dataclass(frozen=True, slots=True)
class Row:
    """What a contender says to a call.

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

    @property
    def decided(self) -> bool:
        """Whether it is proved."""
        return self.outcome.status in ("optimal", "infeasible")


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
    asked = [name for name in modes if _known(name, MODES, "modes")]
    chosen = {name: _known(name, CONTENDERS, "contenders") for name in contenders}
    share = exact(discount, "discount")
    short = min(_SHORT, time_limit)
    for problem in problems:
        try:
            who = roles(problem, robots, lambda problem, who: can_alone(problem, who, short))
        except Exception as error:  # one broken task does not end a suite
            broken = Call(problem, Roles("", ()), asked[0], share, time_limit)
            yield from (_row(broken, name, Outcome("error", reason=told(error))) for name in chosen)
            continue
        calls = [
            Call(problem, who, mode, share, time_limit) for mode in asked if who.alone or mode in CLASSICAL
        ]
        for call in calls:
            for name, contender in chosen.items():
                if call.mode in contender.modes:
                    yield _row(call, name, contender.answer(call))


def _known(name: str, known: Mapping[str, T], what: str) -> T:
    if name not in known:
        raise UsageError(f"{what}: expected some of {', '.join(known)} for a suite of domains, got '{name}'")
    return known[name]


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


def disagreements(rows: Sequence[Row]) -> list[str]:
    """Calls of which contenders have proved what can't all be true, in words."""
    calls: dict[tuple[str, str, str], list[Row]] = {}
    for row in rows:
        calls.setdefault((row.domain, row.task, row.mode), []).append(row)
    return [
        f"{domain} {task}, {mode}: {told}"
        for (domain, task, mode), of in calls.items()
        if (told := _told(of))
    ]


def _told(rows: Sequence[Row]) -> str:
    proved = {row.contender: row.outcome.cost for row in rows if row.decided}
    if len(set(proved.values())) > 1:
        told = (f"{name} {'no plan' if cost is None else cost}" for name, cost in proved.items())
        return f"the proved optima differ: {', '.join(told)}"
    costs = [(row.outcome.cost, row.contender) for row in rows if row.outcome.cost is not None]
    bounds = [(row.outcome.lower_bound, row.contender) for row in rows if row.outcome.lower_bound is not None]
    if len({name for _, name in (*costs, *bounds)}) > 1 and costs and bounds:
        (cost, who), (bound, other) = min(costs), max(bounds)
        if cost < bound:
            return f"a plan of {who} costs {cost}, and {other} says at least {bound}"
    return ""
