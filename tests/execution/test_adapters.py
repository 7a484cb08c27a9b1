"""Robots' bodies in the loop: late and failed actions are planned around, and stand in the log."""

from collections.abc import Sequence

import pytest

import serendipity
from serendipity.execution import Execution, Moment, Replanner
from serendipity.model import Task, UsageError
from serendipity.robot import Adapter, Epoch, Report
from tests.execution.living import lived, told, verdicts


class Scripted:
    """Robots that report what is written down, epoch by epoch, then that all is done."""

    def __init__(self, *reports: Report) -> None:
        self.left = list(reports)
        self.asked: list[Epoch] = []

    def execute(self, epoch: Epoch) -> Sequence[Report]:
        self.asked.append(epoch)
        return [self.left.pop(0) if self.left else Report("done") for _ in epoch.orders]

    def close(self) -> None:
        pass


def live(task: Task, adapter: Adapter) -> Execution:
    return lived(Execution(task, discount="0.6", adapter=adapter), Replanner(task))


def test_an_adapter_sees_the_person_and_what_is_true(room2: Task) -> None:
    robot = Scripted()
    assert float(live(room2, robot).cost) == 12.6
    assert [epoch.number for epoch in robot.asked] == list(range(1, 12))
    assert robot.asked[0].state == room2.init and robot.asked[0].human == "move commx room13 hall8"
    (hand_over,) = robot.asked[5].orders
    assert hand_over.agents == ("commx", "robot") and robot.asked[5].human is None


def test_a_late_robot_is_noticed_and_the_person_gets_there(room2: Task) -> None:
    late = Scripted(*[Report("running", 5.0 * n, "the door is stuck") for n in range(1, 6)])
    run = live(room2, late)
    first = run.passed[1]
    assert [missed.why for missed in first.unfinished] == ["running"]
    assert first.lines("commx")[1].endswith("(it takes longer): 5 s, the door is stuck")
    assert run.human_cost == 13, "it is too late to meet him"


def test_what_took_longer_is_the_reason_once_it_is_over(room2: Task) -> None:
    run = live(room2, Scripted(*[Report("running")] * 3))
    assert verdicts(run)[1:6] == ["helps"] * 4 + ["stopped"] and "helps" not in verdicts(run)[7:]
    said = "stopped because move_reverse robot room4 room3 took longer than epoch 4: no help pays"
    assert {passed.decided.reason for passed in run.passed[5:]} == {said}


def test_a_failed_action_is_tried_again_while_it_pays(room2: Task) -> None:
    first, second, *_ = told(room2, discount="0.6", adapter=Scripted(Report("failed"))).passed
    assert first.unfinished[0].why == "failed"
    assert first.decided.actions[0].action == second.decided.actions[0].action


def test_what_always_fails_is_given_up(room2: Task) -> None:
    robot = Scripted(*[Report("done")] * 4, *[Report("failed")] * 30)  # all but the hand-over
    run = told(room2, discount="0.6", adapter=robot)
    tried = [passed.epoch for passed in run.passed if "hand_over" in (passed.human or "")]
    assert run.done and tried == [6, 7, 8], "a person who is told waits for no hand-over for ever"


def test_a_report_for_each_order(room2: Task) -> None:
    class Mute(Scripted):
        def execute(self, epoch: Epoch) -> Sequence[Report]:
            return []

    with pytest.raises(UsageError, match="adapter: expected 1 reports, got 0"):
        told(room2, discount="0.6", adapter=Mute())


def test_runs_have_an_adapter_each(room2: Task) -> None:
    made: list[Scripted] = []

    def make(task: Task, dice: object) -> Scripted:
        made.append(Scripted())
        return made[-1]

    serendipity.execute(room2, runs=2, discount="0.6", adapter=make)
    assert [len(robot.asked) for robot in made] == [11, 11]


def test_slow_robots_help_less(room2: Task) -> None:
    durations = ("move=0.5..0.9", "move=0.5..9")
    runs = [serendipity.execute(room2, discount="0.6", durations=each) for each in durations]
    assert [each.rows[0].human_cost for each in runs] == [11, 13]


def test_with_a_word_the_person_leaves_their_own_plan() -> None:
    room7 = serendipity.example("room7")  # the paper's III-D
    silent = serendipity.execute(room7, "omniscient", discount="0.6").rows[0]
    spoken = serendipity.execute(room7, "omniscient", discount="0.6", mode="communication").rows[0]
    assert (silent.cost, spoken.cost, spoken.human_cost) == (13, 12.6, 11)


def test_somebody_in_two_places_at_once_goes_on_from_one_of_them(room2: Task) -> None:
    state = room2.init | {room2.facts.index("at commx hall4")}
    chosen = Replanner(room2).choose(Moment(state, (), planned=False, wish=None))
    assert any(action.name == chosen and action.applicable(state) for action in room2.actions)
