"""Many runs: the same dice give the same rows, and rows say what happened.

A log replays to the same run, and to no other.
"""

from pathlib import Path
from random import Random

import pytest
from hypothesis import given
from hypothesis import strategies as st

import serendipity
from serendipity.execution import (
    Execution,
    Faults,
    Recorded,
    Replanner,
    as_text,
    log_lines,
    moment_of,
    read_logs,
    replay,
)
from serendipity.model import InputError, Task, UsageError
from serendipity.robot import Simulated
from serendipity_testing.strategies import tasks
from tests.execution.living import other_goals, replayed

TIMES = ("slowest",)

STAY = [{"goal": ["at commx room13"]}]
PLANS = [{**STAY[0], "probability": 1, "plan": []}]


def _figures(runs: serendipity.execution.Runs) -> list[dict[str, object]]:
    return [{k: v for k, v in row.to_dict().items() if k not in TIMES} for row in runs.rows]


@pytest.mark.long
@pytest.mark.parametrize("human", ["observant", "local", "omniscient", "noisy:0.3"])
def test_the_same_seed_gives_the_same_runs_in_any_number_of_processes(human: str) -> None:
    task = serendipity.example("room2")
    settings = {"runs": 3, "seed": 5, "discount": "0.9", "ties": "drawn", "faults": "fail=0.2,slow=0.2"}
    rows = _figures(serendipity.execute(task, human, **settings))
    assert rows == _figures(serendipity.execute(task, human, **settings))
    if human == "noisy:0.3":
        assert rows == _figures(serendipity.execute(task, human, jobs=2, **settings))
        assert rows[1:] == [
            {**row, "run": row["run"] + 1}  # type: ignore[operator]
            for row in _figures(serendipity.execute(task, human, **{**settings, "runs": 2, "seed": 6}))
        ]


@pytest.mark.parametrize("human", ["observant", "local", "omniscient", "noisy:0.3"])
def test_runs_with_time_to_decide_are_those_without_a_deadline(human: str) -> None:
    """Runs of one task share tables and the plan from before the first epoch, and nothing that happened."""
    settings = {"runs": 3, "discount": "0.9", "ties": "drawn"}
    timed, untimed = (
        serendipity.execute(serendipity.example("room2"), human, deadline=deadline, **settings)
        for deadline in (60, None)
    )
    assert [(r.cost, r.human_cost, r.epochs) for r in timed.rows] == [
        (r.cost, r.human_cost, r.epochs) for r in untimed.rows
    ]


def test_a_summary_counts_runs() -> None:
    runs = serendipity.execute(serendipity.example("room2"), "noisy:0.2", runs=8, discount="0.9")
    found = runs.summary()
    assert found["less"] + found["same"] + found["more"] == pytest.approx(1)
    assert found["reached"] == 1 and found["kept"] == 1
    assert len(list(runs.summary_lines())) == 4


def test_a_goal_is_recognised_at_some_epoch() -> None:
    task = serendipity.example("room2")
    goals = [{"name": room, "goal": [f"conducted_triage commx {room}"]} for room in ("room1", "room8")]
    (row,) = serendipity.execute(task, goals=goals, discount="0.9").rows
    assert row.known is not None and 1 < row.known < row.epochs and row.wrong == 0


def test_a_recorded_person_does_what_is_written_and_then_goes_on() -> None:
    task = serendipity.example("room2")
    record = ["noop", "move commx room13 hall8", "move_reverse commx hall8 hall7"]
    runs = serendipity.execute(task, record, discount="0.6")
    did = [line["human"] for line in runs.logs[0][1:4]]
    assert did == [None, *record[1:]] and runs.rows[0].reached
    run = serendipity.Execution(task)
    person = Recorded(task, ["move_reverse commx hall8 hall7"])
    assert run.step(person.choose(moment_of(run))).in_vain
    assert run.step(person.choose(moment_of(run))).human == "move commx room13 hall8"


@pytest.mark.parametrize(
    ("arguments", "complaint"),
    [
        ({"human": "psychic"}, "human: expected one of recorded:FILE, .*, got 'psychic'"),
        ({"human": "noisy"}, "human: expected one of"),
        ({"human": "noisy:2"}, "noisy: expected a probability from 0 to 1, got 2"),
        ({"human": "observant:1"}, "human: expected one of"),
        ({"runs": 0}, "runs: expected at least 1, got 0"),
        ({"jobs": 0}, "jobs: expected at least 1, got 0"),
        ({"epochs": 0}, "epochs: expected at least 1, got 0"),
        ({"ties": "robust"}, "ties: expected one of fixed, drawn, got 'robust'"),
        ({"faults": "fail"}, "faults: expected some of fail=P,slow=P,drop=P, got 'fail'"),
        ({"faults": "fail=x"}, "fail: expected a finite number"),
        ({"human_model": "psychic"}, "human_model: expected one of"),
        (
            {"human": "omniscient", "mode": "communication", "goals": [{"goal": ["at commx room1"]}]},
            "goals: with robots. own goals, or communication, an omniscient person.s goal is known",
        ),
        ({"deadline": -1}, "deadline: expected"),
        ({"adapter": "nao"}, "adapter: expected one of simulated.*, got 'nao'"),
        ({"durations": "move"}, "durations: expected some of"),
        ({"epoch_seconds": 0}, "epoch_seconds: expected more than 0"),
        ({"adapter": lambda *_: None, "durations": "*=1"}, "durations: only simulated robots"),
        ({"adapter": lambda *_: None, "faults": "fail=0.1"}, "faults: only simulated robots"),
        ({"mode": "communication"}, "mode: expected serendipity, where nobody is told"),
        ({"human": "omniscient", "mode": "composite"}, "mode: expected serendipity or communication"),
        ({"leave_free": "at *", "goals": STAY}, "leave_free: goes with a known goal only"),
        ({"leave_free": 3}, "leave_free: expected patterns apart by commas"),
        ({"plans": PLANS, "goals": STAY}, "plans: go without goals"),
        ({"plans": PLANS, "human": "omniscient", "mode": "communication"}, "plans: go without robots' own"),
        ({"plans": PLANS, "human_model": "observant"}, "human_model: with plans only 'omniscient'"),
    ],
)
def test_wrong_arguments_are_one_line(arguments: dict[str, object], complaint: str) -> None:
    with pytest.raises(UsageError, match=complaint) as caught:
        serendipity.execute(serendipity.example("room2"), **arguments)
    assert "\n" not in str(caught.value)


def test_a_record_names_actions_of_the_person() -> None:
    with pytest.raises(InputError, match="recorded action 'fly': expected an action of commx's"):
        serendipity.execute(serendipity.example("room2"), ["fly"])


def test_faults_are_probabilities() -> None:
    assert Faults.parse("slow=0.5") == Faults(slow=0.5)
    with pytest.raises(UsageError, match="drop: expected a probability"):
        Faults(drop=1.5)


@given(tasks(), st.integers(0, 2**32))
def test_with_faults_and_doubts_and_changes(task: Task, seed: int) -> None:
    dice = Random(seed)
    robots = Simulated(dice, fail=0.3, slow=0.3)
    run = Execution(task, discount="0.9", adapter=robots, goals=other_goals(task, dice))
    person = Replanner(task)
    for epoch in range(6):
        run.step(person.choose(moment_of(run)))
        if epoch == 2:
            run.change({dice.choice(task.facts): dice.random() < 0.5})
        if epoch == 4:
            run.drop([task.agents[dice.choice(task.robots)]])
    again = replayed(task, run)
    assert list(log_lines(again))[1:] == [
        _with_seconds(line, told) for line, told in zip(list(log_lines(run))[1:], again.events, strict=True)
    ]


def _with_seconds(line: dict[str, object], other: dict[str, object]) -> dict[str, object]:
    """A line with the other one's time: a decision that is replayed takes its own."""
    if "decision" not in line:
        return line
    decision = dict(line["decision"])  # type: ignore[call-overload]
    return {**line, "decision": {**decision, "seconds": other["decision"]["seconds"]}}  # type: ignore[index]


@pytest.fixture(name="log")
def _log_file(tmp_path: Path) -> Path:
    runs = serendipity.execute(serendipity.example("room2"), "noisy:0.3", runs=2, discount="0.9")
    path = tmp_path / "runs.jsonl"
    path.write_text("".join(map(as_text, runs.logs)))
    return path


def test_a_file_holds_several_runs(log: Path) -> None:
    task = serendipity.example("room2")
    assert [replay(task, lines).done for lines in read_logs(log)] == [True, True]


@pytest.mark.parametrize(
    ("old", "new", "complaint"),
    [
        ('"human_cost": 2.0', '"human_cost": 1.0', ":3: log: human_cost: comes out as 2.0, but the log"),
        ('"schema": "serendipity.execution/1"', '"schema": "x"', ":1: log: schema: expected"),
        ('"human": "commx"', '"human": "robot"', ":1: log: is of another task"),
        ('"discount": "9/10"', '"discount": "9"', r":1: log: discount: expected a number in \[0, 1\]"),
        ('\n{"epoch": 2', '\n{"epoch": 3', ":3: log: epoch: comes out as 2"),
        ('"decision": {', '"indecision": {', ":2: log: expected an epoch, a change or a drop"),
        ('\n{"epoch": 2', "\n[2", ":3: log: expected a JSON object"),
    ],
)
def test_what_does_not_come_out_the_same_is_named_with_its_line(
    log: Path, old: str, new: str, complaint: str
) -> None:
    text = log.read_text()
    assert old in text
    log.write_text(text.replace(old, new, 1))
    with pytest.raises(InputError, match=complaint):
        replay(serendipity.example("room2"), read_logs(log)[0], log)


def test_an_empty_file_is_no_log(tmp_path: Path) -> None:
    (tmp_path / "log").write_text("\n")
    with pytest.raises(InputError, match="log: is empty"):
        read_logs(tmp_path / "log")
