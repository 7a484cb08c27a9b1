"""A small corpus of calls, and how a planted bug fares in it."""

from collections.abc import Iterator
from dataclasses import dataclass

import pytest

import serendipity
from serendipity.facade.certify import verify
from serendipity.model import PlanError, UsageError
from serendipity_testing.builders import task as build
from serendipity_testing.cases import WORKED, case_4
from serendipity_testing.generator.calls import PlanCall, random_call
from tests.verify.planted.bug import Bug
from tests.verify.planted.hand_made import hand_made

_PATIENCE = "20"
"""Seconds for a call: a bug may make the search go on for ever."""

_EXAMPLES = (
    ("room2", {"discount": "0.6"}),
    ("room2", {"discount": "0.9", "mode": "communication"}),
    ("room5", {"discount": "0.9"}),
    ("room5", {"discount": "0.9", "window_weight": "0"}),
    ("room7", {"discount": "0.9"}),
    ("room7", {"discount": "0.9", "mode": "communication"}),
)


@dataclass(frozen=True, slots=True)
class Fate:
    """How a planted bug fared.

    Attributes:
        how: ``refuted``, ``undecided`` (never refuted, but some answer was not proved
            either), ``crash`` (of the planner) or ``survived``.
        calls: how many calls it took; for a survivor, how many it survived.
        reason: claim and reason of the certificate, or the error.
    """

    how: str
    calls: int
    reason: str = ""


def corpus(count: int) -> Iterator[PlanCall]:
    """semantics 9, calls by hand, ``count`` random ones, the paper's examples, case 4 again; tasks afresh."""
    for worked in WORKED:
        options = {name: str(value) for name, value in worked.options.items()}
        yield PlanCall(worked.task(), options, worked.human_plan)
    yield from _given_plans()
    yield from hand_made()
    yield from (random_call(seed) for seed in range(count))
    for name, options in _EXAMPLES:
        yield PlanCall(serendipity.example(name), options)
    for options in ({"ties": "expected"}, {"human_model": "local"}):
        yield PlanCall(case_4(), {"discount": "0.9", **options})


def _given_plans() -> Iterator[PlanCall]:
    """Plans that are not the human's best, with a robot that may help."""
    for horizon, mode in ((None, "serendipity"), ("4", "serendipity"), ("4", "communication")):
        task = build(
            init="a",
            goal="d",
            actions={
                "one h": "a -> b @ 2",
                "two h": "b -> c @ 2",
                "three h": "c -> d @ 2",
                "far h": "c -> e @ 2",
                "back h": "e -> d @ 2",
                "open r": "-> c @ 1",
            },
        )
        options = {"mode": mode, "discount": "0.5", **({"horizon": horizon} if horizon else {})}
        yield PlanCall(task, options, ("one h", "two h", "far h", "back h"))


def fate(bug: Bug | None, count: int) -> Fate:
    """Plant a bug (None: none) and certify answers until one is refuted.

    A call that is refused where it should not be is no wrong answer, so it counts for nothing;
    neither does one that takes too long.
    """
    calls, unproved = 0, ""
    for call in corpus(count):
        calls += 1
        with pytest.MonkeyPatch.context() as patch:
            if bug is not None:
                bug.plant(patch)
            try:
                result = serendipity.plan(
                    call.task, human_plan=call.human_plan, **{"time_limit": _PATIENCE, **call.keywords()}
                )
                certificate = verify(call.task, result)
                refuted = certificate.refuted
            except (UsageError, PlanError):
                continue
            except Exception as error:
                return Fate("crash", calls, f"{type(error).__name__}: {error}".strip(": "))
        if certificate.verdict == "undecided":
            unproved = next(c.reason for c in certificate.claims if c.verdict == "undecided")
        if refuted is not None:
            return Fate("refuted", calls, f"{refuted.claim}: {refuted.reason}")
    return Fate("undecided" if unproved else "survived", calls, unproved)
