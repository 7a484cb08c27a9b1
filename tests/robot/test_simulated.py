"""Simulated robots take the time that they were given, and fail as often as they should."""

from random import Random

import pytest

from serendipity.model import Task, UsageError
from serendipity.robot import Durations, Report, Simulated
from tests.robot.contract import LIFT, WALK, keeps_its_contract, told


def test_contract(room2: Task) -> None:
    run = keeps_its_contract(room2, Simulated(Random(1), Durations(others=(0.2, 1.0))))
    assert float(run.cost) == 12.6


@pytest.mark.long
@pytest.mark.parametrize("seed", range(5))
def test_contract_where_robots_fail_and_are_late(room2: Task, seed: int) -> None:
    keeps_its_contract(room2, Simulated(Random(seed), Durations(others=(0.5, 2.5)), fail=0.3, slow=0.2))


def test_what_takes_longer_than_an_epoch_goes_on(room2: Task) -> None:
    robot = Simulated(Random(0), Durations.parse("move=12,*=3"), epoch=5)
    assert [told(room2, robot, epoch, WALK) for epoch in (1, 2, 3)] == [
        [Report("running", 5.0)],
        [Report("running", 10.0)],
        [Report("done", 12.0)],
    ]
    assert told(room2, robot, 4, LIFT) == [Report("done", 3.0)]


def test_what_is_not_asked_for_again_is_given_up(room2: Task) -> None:
    robot = Simulated(Random(0), Durations.parse("move=8"), epoch=5)
    assert told(room2, robot, 1, WALK) == [Report("running", 5.0)]
    assert told(room2, robot, 2) == []
    assert told(room2, robot, 3, WALK) == [Report("running", 5.0)]


def test_failures_show_when_the_time_is_over(room2: Task) -> None:
    robot = Simulated(Random(0), Durations.parse("move=8"), epoch=5, fail=1)
    assert told(room2, robot, 1, WALK)[0].outcome == "running"
    assert told(room2, robot, 2, WALK) == [Report("failed", 8.0)]


def test_the_same_seed_gives_the_same_durations(room2: Task) -> None:
    drawn = [told(room2, Simulated(Random(s), Durations(others=(0, 1))), 1, WALK) for s in (1, 1, 2)]
    assert drawn[0] == drawn[1] != drawn[2]


def test_a_verb_is_a_word_or_the_beginning_of_one() -> None:
    spans, dice = Durations.parse("move=2,move_reverse=3,hand_over=4,*=1..1"), Random(0)
    names = ("move a b", "move_reverse a b", "MOVE_A_B".lower(), "hand_over_a_b_k", "lift k")
    assert [spans.draw(name, dice) for name in names] == [2, 3, 2, 4, 1]


@pytest.mark.parametrize(
    ("text", "complaint"),
    [
        ("move", "durations: expected some of VERB=SECONDS"),
        ("=3", "durations: expected some of"),
        ("move=1,move=2", "durations: expected some of"),
        ("move=soon", "durations: expected a finite number"),
        ("move=3..2", "durations: move: expected the least first"),
        ("move=-1", "durations: expected seconds, got '-1'"),
    ],
)
def test_wrong_durations_are_refused(text: str, complaint: str) -> None:
    with pytest.raises(UsageError, match=complaint):
        Durations.parse(text)


def test_an_epoch_has_a_length() -> None:
    with pytest.raises(UsageError, match="epoch_seconds: expected more than 0"):
        Simulated(Random(0), epoch=0)
