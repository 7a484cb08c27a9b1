"""The facade over the verifier: a result in, a certificate out."""

from collections.abc import Iterable, Iterator
from dataclasses import replace
from time import perf_counter
from typing import Final

from serendipity.model import Certificate, Claim, Deadline, InputError, Result, Task
from verify.obligations import complete
from verify.rules import RuleReport
from verify.rules import check as check_rules

_REPLAYED: Final = {
    "replay": "every step follows the rules and the goals hold at the end",
    "cost": "every cost is the sum of its actions'",
    "window": "prefix, window and suffix are as the mode demands",
}
"""Claims that following the rules proves, and how the certificate says so."""

_A_MOMENT: Final = 1.0
"""Seconds for working out what the human would do in a policy's states."""

_NEEDS_SOLVER: Final = "not examined: the rules alone can't prove it"


def check(task: Task, result: Result) -> Certificate:
    """Replay a result rule by rule; quick, and asks no solver.

    A policy of mode ``assistance`` is walked through: every state that it can meet, its actions,
    its values and that every run ends.

    Args:
        task: the task that was asked.
        result: the answer.

    Returns:
        A certificate that refutes what breaks a rule; what only an optimiser can prove
        is not in its scope.

    Raises:
        InputError: the result is for another task.
    """
    start = perf_counter()
    result = result.checked()
    _require_same_task(task, result)
    if result.mode == "assistance":
        claims: Iterable[Claim] = _by_walking(task, result)
    elif "goals" in result.statistics:
        from verify.goals import check_goals  # with what proves single goals

        claims = check_goals(task, result, _by_rules, None)
    else:
        claims = _by_rules(task, result)
    return Certificate(complete(result, claims, by_rules=True), perf_counter() - start)


def _by_walking(task: Task, result: Result) -> Iterator[Claim]:
    """Claims of a policy (SPEC 7): what a walk through its states shows within a moment."""
    from verify.policy import check_policy

    for claim in check_policy(task, result, Deadline(_A_MOMENT), replay_only=True):
        late = claim.verdict == "undecided"
        yield (
            replace(claim, verdict="not_in_scope", reason=f"not examined: {claim.reason}") if late else claim
        )


def _by_rules(task: Task, result: Result) -> tuple[Claim, ...]:
    return tuple(_claims(result, check_rules(task, result)))


def verify(
    task: Task,
    result: Result,
    *,
    solver: str = "highs",
    encoding: str = "automata",
    time_limit: float | None = None,
) -> Certificate:
    """Check a result claim by claim, by code that shares nothing with the search.

    Args:
        task: the task that was asked.
        result: the answer, from :func:`serendipity.plan` or read from JSON.
        solver: ``highs``, or ``cbc`` as a cross-check.
        encoding: ``automata``, or ``paper`` for the paper's own equations.
        time_limit: seconds for the whole certificate, or None.

    Returns:
        The certificate; ``verdict`` is ``proved``, ``refuted`` or ``undecided``.

    Raises:
        InputError: the result is for another task.
        UsageError: there is no such solver or encoding.
    """
    from verify.certify import certify  # loads the solvers

    return certify(task, result, encoding=encoding, solver=solver, time_limit=time_limit)


def _require_same_task(task: Task, result: Result) -> None:
    human = task.agents[task.human]
    if result.human != human:
        raise InputError(f"result: is for another task: its human is '{result.human}', not '{human}'")
    stranger = next((name for name in result.human_plan or () if name not in task.named), None)
    if stranger is not None:
        raise InputError(
            f"result: is for another task: this one has no action '{stranger}' of its human plan"
        )


def _claims(result: Result, report: RuleReport) -> Iterator[Claim]:
    for name in ("replay", "cost", "window", "lower_bound"):
        violation = report.of(name)
        if violation is not None:
            yield Claim(name, "refuted", str(violation), seconds=report.seconds)
        elif name in report.unchecked:
            yield Claim(name, "not_in_scope", report.unchecked[name])
        elif name in _REPLAYED and result.plan is not None:
            yield Claim(name, "proved", _REPLAYED[name], seconds=report.seconds)
        elif name == "lower_bound" and result.lower_bound is not None:
            yield Claim(name, "not_in_scope", _NEEDS_SOLVER)
    if result.status == "infeasible":
        yield Claim("infeasible", "not_in_scope", _NEEDS_SOLVER)
    elif result.status == "optimal":
        yield Claim("optimal" if result.opportunity else "no_opportunity", "not_in_scope", _NEEDS_SOLVER)
