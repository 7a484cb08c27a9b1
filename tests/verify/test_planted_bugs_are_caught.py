"""Bugs planted in the planner make its certificates fall; without one, none does.

``python -m benchmarks.mutations`` runs all of them on a larger corpus.
"""

import pytest

from tests.verify.planted import PLANTED, Bug
from tests.verify.planted.judge import fate

QUICK = (
    "encoding: Encoding.op: a third condition is lost",
    "encoding: Encoding.op: deletes of single facts are lost",
    "encoding: Encoding.compatible: nothing is",
    "encoding: own_mask: the key of the cache leaves out what he only asks for",
    "successors: with_robots: robots never act",
    "keys: Weights: epochs of the window are free",
    "keys: Weights.team: communication is free",
    "labels: add: later but cheaper dominates",
    "labels: no_worse: limits don't count in dominance",
    "windowed: AnyOfPlan: joint actions before the window",
    "windowed: _open: the window is said to start an epoch later",
    "windowed: horizon: an epoch more",
    "planner: _improve_alone: a given plan is taken for optimal",
    "projection: distances are doubled",
    "help: opening: nobody helps",
    "acts: walks: robots can't walk",
    "touches: is_touch: a joint action is none",
)
"""Those that the first calls of the corpus bring to light."""


def _named(bug: Bug) -> str:
    return f"{bug.where}: {bug.what}"


BY_NAME = {_named(bug): bug for bug in PLANTED}


def test_names_are_unique() -> None:
    assert len(BY_NAME) == len(PLANTED) >= 25


def test_without_a_bug_everything_is_proved() -> None:
    assert fate(None, 50).how == "survived"


@pytest.mark.parametrize("name", QUICK)
def test_planted_bugs_are_refuted(name: str) -> None:
    seen = fate(BY_NAME[name], 50)
    assert seen.how == "refuted", seen


@pytest.mark.slow
@pytest.mark.parametrize("name", BY_NAME)
def test_every_planted_bug_is_caught_or_explained(name: str) -> None:
    bug = BY_NAME[name]
    seen = fate(bug, 600)
    assert (seen.how == "survived") == bool(bug.survives), seen
