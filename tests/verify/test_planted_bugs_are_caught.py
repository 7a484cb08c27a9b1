"""Bugs planted in the planner make its certificates fall; without one, none does.

The slow test runs all of them, on a larger corpus.
"""

import pytest

from tests.verify.planted import PLANTED, Bug
from tests.verify.planted.judge import fate

QUICK = (
    "PackedTask._literals: a third condition is lost",
    "PackedTask._pack_action: deletes of single facts are lost",
    "PackedTask.compatible: none may",
    "PackedTask.own_mask: the key of the cache leaves out what they only ask for",
    "Successors.with_robots: nothing, ever",
    "Weights.__init__: epochs of the window are free",
    "Weights.team: communication is free",
    "ParetoFront.add: later but cheaper dominates",
    "ParetoFront.__init__: they don't count",
    "AnyOfPlan.options: joint actions before the window",
    "Windowed._open: it is said to start an epoch later",
    "Windowed.__init__: horizon: an epoch more",
    "human_plan._may_turn_at_once: whatever is asked",
    "pattern_database.backward: doubled",
    "FirstInteractionOnTheWay.opening: nobody helps",
    "TransitionGraph.__init__: robots can't walk",
    "Interactions.is_interaction: a joint action is none",
)
"""Those that the first calls of the corpus bring to light."""


_REMEDY = "if no call turns on it, write one that does (tests/verify/planted/hand_made.py)"

BY_NAME = {bug.name: bug for bug in PLANTED}


def test_names_are_unique() -> None:
    assert len(BY_NAME) == len(PLANTED) >= 25


@pytest.mark.parametrize("bug", PLANTED, ids=lambda bug: bug.name)
def test_bugs_can_be_planted_and_removed(bug: Bug) -> None:
    before = vars(bug.owner)[bug.attribute]
    with pytest.MonkeyPatch.context() as patch:
        bug.plant(patch)
        assert vars(bug.owner)[bug.attribute] is not before
    assert vars(bug.owner)[bug.attribute] is before


@pytest.mark.long
def test_without_a_bug_everything_is_proved() -> None:
    assert fate(None, 50).how == "survived"


@pytest.mark.long
@pytest.mark.parametrize("name", QUICK)
def test_planted_bugs_are_refuted(name: str) -> None:
    seen = fate(BY_NAME[name], 50)
    assert seen.how == "refuted", f"{seen}; {_REMEDY}"


@pytest.mark.long
@pytest.mark.parametrize("name", sorted(BY_NAME.keys() - {*QUICK}))
def test_no_planted_bug_is_a_crash(name: str) -> None:
    """As it would be where the code that it is planted in has changed."""
    seen = fate(BY_NAME[name], 0)
    assert seen.how != "crash", seen


@pytest.mark.slow
@pytest.mark.parametrize("name", BY_NAME)
def test_every_planted_bug_is_refuted(name: str) -> None:
    seen = fate(BY_NAME[name], 600)
    assert seen.how == "refuted", f"{seen}; {_REMEDY}"
