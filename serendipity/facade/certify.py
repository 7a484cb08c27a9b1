"""The facade over the verifier: a result in, a certificate out."""

from collections.abc import Iterable, Iterator
from time import perf_counter
from typing import Final

from serendipity.model import Certificate, Claim, Deadline, Result, Task
from serendipity.model.collection import no_collection
from serendipity.model.limits import limits_from
from verify.base.obligations import complete
from verify.rules import RuleReport
from verify.rules import check as check_rules
from verify.rules.header import require_same_task

_REPLAYED: Final = {
    "replay": "every step follows the rules and the goals hold at the end",
    "cost": "every cost is the sum of its actions'",
    "window": "prefix, window and suffix are as the mode demands",
}
"""Claims that following the rules proves, and how the certificate says so."""

_A_MOMENT: Final = 1.0
"""Seconds for working out what the human would do in a policy's states."""

_NEEDS_SOLVER: Final = "not examined: the rules alone can't prove it"


def check(
    task: Task, result: Result, *, time_limit: float | None = None, deadline: Deadline | None = None
) -> Certificate:
    """Replay a result rule by rule; quick, and asks no solver.

    A policy of mode ``assistance`` is walked through: every state that it can meet, its actions,
    its values and that every run ends.

    Args:
        task: the task that was asked.
        result: the answer.
        time_limit: seconds, or None.
        deadline: one that other work shares, such as planning; it holds beside ``time_limit``.

    Returns:
        A certificate that refutes what breaks a rule; what only an optimiser can prove is not
        in its scope, and what there was no time for is undecided.

    Raises:
        InputError: the result is for another task.
    """
    start = perf_counter()
    limits = limits_from(time_limit, None, deadline)
    result = result.checked()
    require_same_task(task, result)
    with no_collection():
        claims = complete(result, _by_rules(task, result, limits), by_rules=True)
    return Certificate(claims, perf_counter() - start)


def _by_rules(task: Task, result: Result, deadline: Deadline) -> Iterable[Claim]:
    if "goals" in result.statistics:
        from verify.goals import check_goals  # with what proves single goals

        def one_goal(about: Task, answer: Result) -> tuple[Claim, ...]:
            return tuple(_claims(answer, check_rules(about, answer, deadline)))

        return check_goals(task, result, one_goal, deadline)
    if result.mode == "assistance":
        from verify.policy import check_policy

        # a walk through the policy's states, as far as it gets within a moment (semantics 7)
        return check_policy(task, result, deadline.within(_A_MOMENT), replay_only=True)
    return _claims(result, check_rules(task, result, deadline))


def verify(
    task: Task,
    result: Result,
    *,
    solver: str = "highs",
    encoding: str = "automata",
    time_limit: float | None = None,
    memory_limit: float | None = None,
    deadline: Deadline | None = None,
) -> Certificate:
    """Check a result claim by claim, by code that shares nothing with the search.

    The limits hold for everything: what they keep from being examined is ``undecided``, with the
    reason, and what was decided before stays so.

    Args:
        task: the task that was asked.
        result: the answer, from :func:`serendipity.plan` or read from JSON.
        solver: ``highs``, or ``cbc`` as a cross-check.
        encoding: ``automata``, or ``paper`` for the paper's own equations.
        time_limit: seconds for the whole certificate, or None.
        memory_limit: what this process and a solver's may have in memory, in MiB, or None.
        deadline: one that other work shares, such as loading the task; it holds beside the limits.

    Returns:
        The certificate; ``verdict`` is ``proved``, ``refuted`` or ``undecided``.

    Raises:
        InputError: the result is for another task.
        UsageError: there is no such solver or encoding, or a limit has no legal value.
    """
    limits = limits_from(time_limit, memory_limit, deadline)
    from verify.certificate.certify import certify  # loads the solvers

    return certify(task, result, encoding=encoding, solver=solver, deadline=limits)


def _claims(result: Result, report: RuleReport) -> Iterator[Claim]:
    for name in ("replay", "cost", "window", "lower_bound"):
        violation = report.of(name)
        if violation is not None:
            yield Claim(name, "refuted", str(violation), seconds=report.seconds)
        elif name in report.unchecked:
            yield Claim(name, "not_in_scope", report.unchecked[name])
        elif name in report.undecided and (name == "replay" or result.plan is not None):
            yield Claim(name, "undecided", report.undecided[name], seconds=report.seconds)
        elif name in _REPLAYED and result.plan is not None:
            yield Claim(name, "proved", _REPLAYED[name], seconds=report.seconds)
        elif name == "lower_bound" and result.lower_bound is not None:
            yield Claim(name, "not_in_scope", _NEEDS_SOLVER)
    if result.status == "infeasible":
        yield Claim("infeasible", "not_in_scope", _NEEDS_SOLVER)
    elif result.status == "optimal":
        yield Claim("optimal" if result.opportunity else "no_opportunity", "not_in_scope", _NEEDS_SOLVER)
