"""What robots have taken on the way to help is given, or they say why they have stopped."""

from random import Random

import pytest
from hypothesis import given
from hypothesis import strategies as st

import serendipity
from serendipity.execution import Execution, Faults, Omniscient, Replanner, moment_of
from serendipity.model import Task
from serendipity.robot import Report, Simulated
from serendipity_testing.builders import task as build
from serendipity_testing.builders import usar
from serendipity_testing.generator import random_call
from serendipity_testing.strategies import tasks
from tests.execution.living import MOST_EPOCHS, lived, told
from tests.execution.test_adapters import Scripted


def _only_kit() -> Task:
    """A corridor with the only kit at its far end, beside the robot: on the way to help, it takes it."""
    return usar("g-a-b-c-d", human="a", robots={"r": "d"}, kits={"k": "d"}, triage="g")


def test_who_counts_on_the_only_kit_gets_it() -> None:
    run = told(_only_kit())
    assert run.done and float(run.human_cost) < serendipity.plan(_only_kit(), mode="individual").cost
    assert "only-way" in {passed.decided.because.kind for passed in run.passed if passed.decided.because}


@pytest.mark.parametrize("outcome", ["failed", "running"])
def test_what_goes_wrong_on_the_way_is_done_again(outcome: str) -> None:
    wrong = [Report(outcome)] * 5  # type: ignore[arg-type]
    run = told(_only_kit(), adapter=Scripted(Report("done"), *wrong))
    assert run.done, "what has failed too often is tried again where there is no other way"


def _robot_drops_out(task: Task) -> Execution:
    """The robot has taken the kit."""
    run = Execution(task, discount="0.9", told=True)
    run.step(Omniscient(task).choose(moment_of(run)))
    assert "has r k" in run.facts
    run.drop(["r"])
    return run


def test_what_nobody_can_finish_is_said() -> None:
    run = _robot_drops_out(_only_kit())
    assert run.decided.verdict == "stopped" and run.decided.because is not None
    assert run.decided.because.cause is not None and run.decided.because.cause.kind == "out-of-order"
    said = "stopped because r is out of order: nothing that anybody could do gets h there"
    assert run.decided.reason == said


@given(tasks(), st.sampled_from(["0.5", "0.9", "1"]))
def test_who_is_told_arrives_and_never_pays_more(task: Task, discount: str) -> None:
    (row,) = serendipity.execute(task, "omniscient", discount=discount, epochs=MOST_EPOCHS).rows
    if row.alone is not None:
        assert row.reached and row.human_cost <= row.alone


@given(tasks(), st.integers(0, 2**32))
def test_who_is_told_arrives_beside_robots_that_fail(task: Task, seed: int) -> None:
    run = told(task, adapter=Simulated(Random(seed), fail=0.3, slow=0.3))
    assert run.done or serendipity.plan(task, mode="composite", horizon="inf").cost is None


@pytest.mark.parametrize("seed", [106, 252, 659])
def test_what_was_finished_by_a_robot_that_is_not_there_any_more(seed: int) -> None:
    task = random_call(seed).task  # with goals of the robots' own; one of them is slow, then drops out
    faults = Faults(slow=0.4, drop=0.2)
    (row,) = serendipity.execute(task, "omniscient", seed=seed, discount="0.9", faults=faults, epochs=30).rows
    assert row.reached


def test_who_never_arrives_has_saved_nothing() -> None:
    runs = serendipity.execute(
        _only_kit(), "omniscient", discount="0.9", epochs=9, runs=6, faults=Faults(drop=0.3)
    )
    arrived = [row for row in runs.rows if row.reached]
    assert 0 < len(arrived) < 6
    found, lines = runs.summary(), list(runs.summary_lines())
    assert found["human_cost"] == sum(row.human_cost for row in arrived) / len(arrived)
    assert lines[1] == (
        f"not reached in {6 - len(arrived)} of 6 runs; what was paid is counted in the others only"
    )
    nobody = serendipity.execute(_only_kit(), "omniscient", epochs=1)
    assert nobody.summary()["less"] is None and len(list(nobody.summary_lines())) == 3


def _tool(put: str) -> Task:
    """The robot takes a tool for a short cut; somebody who turns off after the first step needs that tool."""
    return build(
        init="a tool",
        goal="done",
        actions={
            "walk h": "a -> b !a",
            "climb h": "b -> d !b",
            "long h": "d -> done @ 3",
            "quick h": "d short -> done",
            "stray h": "b -> c !b @ 4",
            "near h": "c -> e !c",
            "use h": "e tool -> done",
            "round h": "e -> done @ 5",
            "take r": "tool -> holds !tool @ 1/10",
            "give r": "holds -> short !holds @ 1/10",
            "fetch r": put,
        },
    )


@pytest.mark.parametrize("pays", [True, False])
def test_what_was_taken_is_given_back_to_who_strays(pays: bool) -> None:
    task = _tool("!tool -> tool @ 1" if pays else "!tool -> tool @ 20")
    run = Execution(task)
    verdicts = [run.step(action).decided.verdict for action in ("walk h", "stray h")]
    assert verdicts == ["helps", "helps"]
    why = run.decided.because
    assert why is not None and why.kind == ("pays" if pays else "owed") and run.decided.actions
    if not pays:
        assert (why.owed, why.alone) == (4, 6)
        assert run.decided.reason == "makes up for the 4 more that h would pay by what it has done"
    assert lived(run, Replanner(run.task.at(run.state))).done


def test_what_cannot_be_given_back_is_said() -> None:
    run = Execution(_tool("never -> tool"))
    for action in ("walk h", "stray h"):
        run.step(action)
    assert run.decided.verdict == "stopped"
    assert run.decided.reason == (
        "stopped because h did not climb h in epoch 2: no help pays; "
        "h pays 4 more by what it has done, which can't be made up for"
    )


def test_who_has_gone_out_of_their_way_is_told_what_that_costs() -> None:
    task = usar("g-a-b-c-d a-e-f-i-j-l", human="a", robots={"r": "d"}, kits={"k": "d", "m": "l"}, triage="g")
    run = _robot_drops_out(task)
    untouched = task.at(run.state - {task.facts.index("has r k")} | {task.facts.index("at k d")})
    now, before = (serendipity.plan(t, mode="individual").cost for t in (task.at(run.state), untouched))
    why = run.decided.because
    assert why is not None and now is not None and before is not None
    assert why.owed == now - before > 0


def test_two_robots_do_at_once_only_what_one_of_them_may_fail_in() -> None:
    task = build(
        agents="h r s",
        init="a tool",
        goal="done",
        actions={
            "walk h": "a -> b !a",
            "use h": "b tool -> done @ 3",
            "round h": "b -> done @ 5",
            "quick h": "b left right -> done",
            "take r": "tool -> left !tool @ 1/10",
            "bring s": "!right -> right @ 1/10",
        },
    )
    assert len(Execution(task).decided.actions) == 2, "where nothing fails"
    run = lived(Execution(task, adapter=Scripted(Report("done"), Report("failed"))), Replanner(task))
    assert run.done and run.human_cost <= 4


def test_who_has_arrived_has_their_goal_back_when_robots_have_theirs() -> None:
    """The person needs nothing; the robot needs the door open for a moment, and shuts it again."""
    task = build(
        agents="hum rob",
        human="hum",
        init="shut",
        goal="shut",
        robot_goal="aired",
        actions={"air rob": "-> aired !shut", "close rob": "-> shut", "shut hum": "!shut -> shut"},
    )
    (row,) = serendipity.execute(task, "omniscient", discount="0").rows
    assert row.reached and row.human_cost == 0


def test_who_has_arrived_does_themselves_what_robots_leave_undone() -> None:
    """Robots meant to light it again; then the person could do so for less, who was gone: it stayed dark."""
    task = build(
        agents="hum rob bot",
        human="hum",
        init="lit shut",
        goal="lit shut",
        robot_goal="aired",
        actions={
            "air rob": "lit -> aired !lit @ 2.5",
            "light rob": "ready -> lit !shut",
            "shut bot": "!shut -> shut @ 0.1",
            "prepare bot": "shut -> ready",
            "light hum": "aired -> lit !ready",
        },
    )
    (row,) = serendipity.execute(task, "omniscient", discount="0").rows
    assert row.reached and row.epochs == 2
