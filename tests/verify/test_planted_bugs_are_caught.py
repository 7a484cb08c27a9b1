"""Bugs planted in the planner make its certificates fall; without one, none does.

The slow test runs all of them, on a larger corpus.
"""

import pytest

from tests.verify.planted import PLANTED
from tests.verify.planted.judge import fate

QUICK = (
    "packing conditions: a third condition is lost",
    "packing an action: deletes of single facts are lost",
    "whether two actions may share an epoch: none may",
    "variables of the human's own actions: the key of the cache leaves out what they only ask for",
    "what robots do beside the human: nothing, ever",
    "weights of operators: epochs of the window are free",
    "cost of a joint action: communication is free",
    "dominance between labels: later but cheaper dominates",
    "limits in dominance: they don't count",
    "prefix of actions of pi_H: joint actions before the window",
    "opening a window: it is said to start an epoch later",
    "limits of the window space: horizon: an epoch more",
    "whether a given plan can be improved: it is taken for optimal",
    "distances in the pattern database: doubled",
    "bound if the window opens now: nobody helps",
    "robots' walks in the transition graph: robots can't walk",
    "whether an action is an interaction: a joint action is none",
)
"""Those that the first calls of the corpus bring to light."""


_REMEDY = "if no call turns on it, write one that does (tests/verify/planted/hand_made.py)"

BY_NAME = {bug.name: bug for bug in PLANTED}


def test_names_are_unique() -> None:
    assert len(BY_NAME) == len(PLANTED) >= 25


def test_without_a_bug_everything_is_proved() -> None:
    assert fate(None, 50).how == "survived"


@pytest.mark.parametrize("name", QUICK)
def test_planted_bugs_are_refuted(name: str) -> None:
    seen = fate(BY_NAME[name], 50)
    assert seen.how == "refuted", f"{seen}; {_REMEDY}"


@pytest.mark.slow
@pytest.mark.parametrize("name", BY_NAME)
def test_every_planted_bug_is_caught_or_explained(name: str) -> None:
    bug = BY_NAME[name]
    seen = fate(bug, 600)
    expected = "survived" if bug.survives else "crash" if bug.crashes else "refuted"
    assert seen.how == expected, f"{seen}; {_REMEDY}"
    assert seen.reason.startswith(bug.crashes), seen
