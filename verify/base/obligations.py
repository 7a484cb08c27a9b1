"""What a certificate has to prove: the claims that each kind of answer makes, in one table.

A claim that the table asks for and that nobody examined leaves the certificate undecided, so that
no answer is ever proved by leaving something out.  ``docs/verification.md`` shows the same table.
"""

from collections.abc import Iterable, Iterator
from dataclasses import replace
from typing import Final

from serendipity.model import Claim, Result
from verify.base import wording

TIED_MODES: Final = ("serendipity", "communication")
"""Modes whose answer depends on which optimal ``pi_H`` the human follows."""

BEST: Final = "optimal or no_opportunity"
"""``optimal`` for opportunities and in modes without windows; ``no_opportunity`` where there is none."""

_PLAN: Final = {
    "optimal": ("replay", "cost", "window", BEST, "lower_bound"),
    "feasible": ("replay", "cost", "window", "lower_bound"),
    "infeasible": ("infeasible",),
    "unknown": ("lower_bound",),
}

NEEDED: Final[dict[str, dict[str, tuple[str, ...]]]] = {
    "a plan": _PLAN,
    "a plan for each scenario": _PLAN,
    "a plan for a human who replans": {
        status: tuple("realised" if claim == "window" else claim for claim in claims)
        for status, claims in _PLAN.items()
    },
    "a mean over ties": {"optimal": ("cost", BEST, "lower_bound"), "feasible": ("cost", "lower_bound")},
    "a policy": {
        "optimal": ("replay", "cost", "optimal", "lower_bound"),
        "feasible": ("replay", "cost", "lower_bound"),
        "infeasible": ("infeasible",),
        "unknown": ("lower_bound",),
    },
}
"""By kind of answer and status, the claims that a proof needs."""

BY_RULES: Final = ("replay", "cost", "window")
"""Claims that need no optimiser: all that the quick check answers for."""


def kind_of(result: Result) -> str:
    """Which row of :data:`NEEDED` an answer belongs to."""
    if result.mode == "assistance":
        return "a policy"
    if result.goals is not None and len(result.goals) > 1:
        return "a plan for each scenario"
    if is_mean(result):
        return "a mean over ties"
    if result.options.human_model != "omniscient":
        return "a plan for a human who replans"
    return "a plan"


def is_tied(result: Result) -> bool:
    """Whether an answer speaks for all optimal ``pi_H`` at once."""
    options = result.options
    tied = options.ties not in ("fixed", "watched")
    return tied and result.mode in TIED_MODES and result.human_plan is not None


def is_mean(result: Result) -> bool:
    """Whether it is the mean over several answers, with no plan of its own."""
    answered = result.status in ("optimal", "feasible")
    return answered and is_tied(result) and result.options.ties == "expected" and result.plan is None


def needed(result: Result) -> tuple[str, ...]:
    """The claims that a proof of the answer needs, in order."""
    if result.status == "unknown" and result.lower_bound is None:
        return ()
    claims = NEEDED[kind_of(result)].get(result.status, ())
    return tuple(one for claim in claims for one in (_best(result) if claim == BEST else (claim,)))


def complete(result: Result, claims: Iterable[Claim], *, by_rules: bool = False) -> tuple[Claim, ...]:
    """The claims that were examined, and an undecided one for each that is needed and was not.

    Args:
        by_rules: only what needs no optimiser is asked for.
    """
    known = list(claims)
    if any(claim.verdict == "refuted" for claim in known):
        return tuple(known)
    wanted = [name for name in needed(result) if name in BY_RULES or not by_rules]
    there = {claim.claim for claim in known}
    missing = (Claim(name, "undecided", wording.NOT_EXAMINED) for name in wanted if name not in there)
    for k, claim in enumerate(known):
        if claim.verdict == "not_in_scope" and claim.claim in wanted:
            known[k] = replace(claim, verdict="undecided")
    return (*known, *missing)


def _best(result: Result) -> Iterator[str]:
    if result.opportunity or not result.options.windowed:
        yield "optimal"
    predicted = result.human_plan is not None or kind_of(result) == "a plan for each scenario"
    if not result.opportunity and predicted and result.mode != "individual":
        yield "no_opportunity"
