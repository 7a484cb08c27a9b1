"""Executions in time: actions go on, a script goes by, and nobody pays for help (semantics 10.6)."""

import json
from dataclasses import replace
from itertools import islice
from pathlib import Path
from random import Random

import pytest
from hypothesis import given
from hypothesis import strategies as st

import serendipity
from serendipity.execution import Execution, log_lines, moment_of, person_of
from serendipity.model import Condition, InputError, Script, Task
from serendipity.robot import Report, Simulated
from serendipity_testing.builders import Builder
from serendipity_testing.oracle import human_plans
from serendipity_testing.strategies.time import tasks_in_time
from tests.execution.living import arrives, lived_short_of_a_robot, replayed, verdicts
from tests.execution.test_adapters import Scripted

DISCOUNTS = st.sampled_from(["0", "0.5", "0.9", "1"])
SEEDS = st.integers(0, 2**32)


def _without_robot_goals(task: Task) -> Task:
    return task.with_goal(task.goal, Condition())


@pytest.mark.long
@given(tasks_in_time(), DISCOUNTS)
def test_who_follows_the_plan_that_robots_expect_never_pays_more(task: Task, discount: str) -> None:
    task = _without_robot_goals(task)
    arrives(task, Execution(task, discount=discount), person_of(task))


@pytest.mark.long
@given(tasks_in_time(), DISCOUNTS, SEEDS)
def test_who_follows_any_optimal_plan_never_pays_more(task: Task, discount: str, seed: int) -> None:
    task = _without_robot_goals(task)
    arrives(task, Execution(task, discount=discount), person_of(task, dice=Random(seed)))


@pytest.mark.long
@given(tasks_in_time(), DISCOUNTS)
def test_who_is_told_and_the_team_never_pay_more(task: Task, discount: str) -> None:
    task = _without_robot_goals(task)
    run = Execution(task, discount=discount, told=True)
    arrives(task, run, person_of(task, "omniscient"))
    for plan in islice(human_plans(task), 1):
        assert run.cost <= task.cost_of(plan)


@pytest.mark.long
@given(tasks_in_time(), DISCOUNTS, SEEDS)
def test_a_log_of_robots_that_fail_replays(task: Task, discount: str, seed: int) -> None:
    task, dice = _without_robot_goals(task), Random(seed)
    run = Execution(task, discount=discount, adapter=Simulated(dice, fail=0.3, slow=0.3))
    replayed(task, lived_short_of_a_robot(task, run, person_of(task, "noisy:0.2", dice)))


@pytest.mark.parametrize("human", ["observant", "omniscient"])
@pytest.mark.parametrize(("name", "team", "hers"), [("morning", 35, 28), ("office", 30, 26)])
def test_the_days_of_the_guide_happen(name: str, team: int, hers: int, human: str) -> None:
    runs = serendipity.execute(serendipity.example(name), human, discount="0.5")
    (row,) = runs.rows
    assert (row.reached, row.cost, row.human_cost, row.spoilt) == (True, team, hers, 0)
    told = "\n".join(runs.story())
    assert "goes on with" in told and "helps:" in told


def _box(script: Script | None = None) -> Task:
    """Ann needs a box that she may carry up in 4 epochs, or that a robot brings within 3."""
    made = Builder(("ann", "bot", "carol"))
    made.named("carry ann", (0,), "below free / below / ", "above !below", "4", 4)
    made.named("bring bot", (1,), "below free / free / free", "above !below", "2", 3)
    made.named("rest ann", (0,), "", "rested", "0")
    made.named("block ann", (0,), "free", "!free", "0")
    made.named("sweep carol", (2,), "free / free /", "clean", "1", 3)
    made.named("leave carol", (2,), "clean", "gone", "1")
    built = made.task("below free", "above")
    return built if script is None else built.with_script(script)


def _brought(*outcomes: str) -> Execution:
    """A run in which the robot brings the box, as it reports, and Ann is told so."""
    adapter = Scripted(*map(Report, outcomes)) if outcomes else None  # type: ignore[arg-type]
    return Execution(_box(), discount="0.5", told=True, mode="communication", adapter=adapter)


def _to_the_end(run: Execution) -> Execution:
    while not run.done and run.epoch < 20:
        run.step(None)
    return run


def test_an_action_ends_when_its_time_is_over() -> None:
    run = _to_the_end(_brought())
    assert len(run.passed) == 3 and (run.human_cost, run.cost) == (0, 1)
    assert [passed.going[0].duration for passed in run.passed[1:]] == [2, 1]
    assert verdicts(run) == ["helps"] * 3


def test_who_is_late_ends_later() -> None:
    run = _to_the_end(_brought("running", "running", "running", "running", "done"))
    orders = [each.order for passed in run.passed for each in passed.reports]
    assert [(order.action, order.epochs) for order in orders] == [("bring bot", 3)] * 5
    assert [missed.why for passed in run.passed for missed in passed.unfinished] == ["running"] * 2


def test_who_is_early_waits_for_the_end() -> None:
    run = _to_the_end(_brought("done"))
    assert [len(passed.reports) for passed in run.passed] == [1, 0, 0]


def test_what_fails_has_no_more_effect_and_robots_begin_again() -> None:
    run = _to_the_end(_brought("running", "failed", "running", "running", "done"))
    assert len(run.passed) == 5 and run.cost == 2


def test_what_the_person_makes_impossible_is_broken_off() -> None:
    run = _brought()
    run.step(None)
    run.step("block ann")
    run.step(None)
    assert [missed.why for missed in run.passed[-1].unfinished] == ["broken"]
    assert "above" not in run.facts and not run.going
    assert "could not go on" in "\n".join(run.passed[-1].lines("ann"))


def test_the_person_is_not_asked_while_they_are_at_something() -> None:
    run = Execution(_box(), discount="0", told=False)
    run.drop(["bot", "carol"])
    run.step("carry ann")
    assert run.possible() == () and run.step("rest ann").in_vain
    person = person_of(run.task)
    assert person.choose(moment_of(run)) is None
    assert "goes on with carry ann" in "\n".join(run.passed[-1].lines("ann")) or run.passed[-1].in_vain


def test_nobody_gets_in_the_way_of_a_bystander() -> None:
    run = Execution(_box(Script(people={"carol": [(2, "sweep carol"), (5, "leave carol")]})), told=True)
    assert "block ann" in run.possible()
    run.step("rest ann")
    run.step("rest ann")
    assert run.step("block ann").unfinished == ()  # she does it after she has looked
    assert "gone" not in run.facts


def test_a_robot_that_drops_out_leaves_what_it_is_at() -> None:
    run = _brought()
    run.step(None)
    run.drop(["bot"])
    for _ in range(3):
        run.step(None)
    assert "above" not in run.facts


@pytest.mark.long
@given(tasks_in_time(), DISCOUNTS, SEEDS, st.sampled_from(["observant", "drawn"]))
def test_nobody_pays_for_robots_own_goals(task: Task, discount: str, seed: int, human: str) -> None:
    fact = Random(seed).randrange(len(task.facts))
    task = task.with_goal(task.goal, Condition((), (fact,)) if seed % 2 else Condition((fact,)))
    dice = Random(seed) if human == "drawn" else None
    arrives(task, Execution(task, discount=discount), person_of(task, dice=dice))


def test_robots_finish_goals_of_their_own_when_the_person_is_there() -> None:
    """Carol sweeps beside Ann, who carries the box up, and leaves after that; it was refused."""
    box = _box()
    own = box.with_goal(box.goal, Condition((box.facts.index("gone"),)))
    for human in ("observant", "omniscient"):
        (row,) = serendipity.execute(own, human, discount="0").rows
        assert (row.reached, row.left, row.human_cost, row.cost) == (True, 0, 4, 6)
    short = replace(own, goal=Condition((own.facts.index("rested"),)), known_variables=own.variables)
    runs = serendipity.execute(short, discount="0")
    assert runs.rows[0].left == 0 and runs.rows[0].epochs == 5, "they had no time before she rested"


def test_robots_own_goals_wait_while_they_spoil_something() -> None:
    """Bob could lock the shed at once, through which Ann is on her way."""
    made = Builder(("ann", "bob"))
    made.named("pass ann", (0,), "open", "there", "1", 2)
    made.named("lock bob", (1,), "", "!open", "1")
    task = made.task("open", "there")
    task = task.with_goal(task.goal, Condition((), (task.facts.index("open"),)))
    run = Execution(task, discount="0.5")
    assert run.decided.actions == ()
    (row,) = serendipity.execute(task, discount="0.5").rows
    assert (row.reached, row.left, row.human_cost) == (True, 0, 1)


def test_robots_put_things_back_in_time() -> None:
    """As in the guide's plan: going back to the charger costs 1."""
    runs = serendipity.execute(
        serendipity.example("morning"), discount="0.5", leave_free="coffee, table-laid*"
    )
    (row,) = runs.rows
    assert (row.reached, row.left, row.cost, row.human_cost) == (True, 0, 36, 28)


def test_records_and_strays(tmp_path: Path) -> None:
    record = tmp_path / "ann.plan"
    record.write_text("noop\nrest ann\ncarry ann\n")
    runs = serendipity.execute(_box(), f"recorded:{record}", discount="0")
    assert runs.rows[0].reached
    strays = serendipity.execute(
        _box(), "noisy:0.5", runs=5, ties="drawn", faults="fail=0.2,slow=0.2", jobs=2
    )
    again = serendipity.execute(_box(), "noisy:0.5", runs=5, ties="drawn", faults="fail=0.2,slow=0.2")
    assert [(row.cost, row.epochs) for row in strays.rows] == [(row.cost, row.epochs) for row in again.rows]


def test_records_say_when(tmp_path: Path) -> None:
    """Times were taken for nothing: what begins in epoch 3 began at once."""
    record = tmp_path / "ann.plan"
    record.write_text("2.000: (rest ann) [1.000]\n4: (carry ann)\n")
    (log,) = serendipity.execute(_box(), f"recorded:{record}", discount="0").logs
    assert [line["human"] for line in log[1:5]] == [None, None, "rest ann", None]
    record.write_text("0: (carry ann)\n1: (rest ann)\n")
    with pytest.raises(InputError, match=r"ann\.plan:2: recorded action 'rest ann': ann is busy until epoch"):
        serendipity.execute(_box(), f"recorded:{record}")


def test_a_log_names_what_goes_on() -> None:
    run = _brought()
    run.step(None)
    run.step(None)
    lines = json.loads(json.dumps(list(log_lines(run))))
    assert [step["action"] for step in lines[2]["going"]] == ["bring bot"]
    assert "going" not in lines[1]
