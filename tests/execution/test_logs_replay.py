"""A log replays to the same run, and to no other."""

from pathlib import Path
from random import Random

import pytest
from hypothesis import given
from hypothesis import strategies as st

import serendipity
from serendipity.execution import Execution, Replanner, as_text, log_lines, moment_of, read_logs, replay
from serendipity.model import InputError, Task
from serendipity.robot import Simulated
from serendipity.testing.strategies import tasks
from tests.execution.living import other_goals, replayed


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
