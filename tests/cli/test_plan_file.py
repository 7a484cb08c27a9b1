"""``plan --save-plan``: the plan as planning competitions write it, executable line by line."""

from pathlib import Path

import pytest

import serendipity
from serendipity.cli.files.plans import plan_file
from serendipity.model import Result, Task
from serendipity.testing.builders import task
from serendipity.testing.cases import WORKED, Worked
from tests.cli.conftest import Runs
from tests.cli.test_exit_codes import anytime


def actions(text: str) -> list[str]:
    return [line[1:-1] for line in text.splitlines() if line.startswith("(")]


def executes(planned: Task, names: list[str]) -> bool:
    """Whether actions can be executed one after another and reach the goals."""
    state = planned.init
    for name in names:
        same = [planned.actions[i] for i in planned.named[name]]
        action = next((action for action in same if action.applicable(state)), None)
        if action is None:
            return False
        state = state.difference(action.delete).union(action.add)
    return planned.goal.holds(state) and planned.robot_goal.holds(state)


def test_it_is_written_beside_the_answer(run: Runs, tmp_path: Path) -> None:
    done = run("plan --example room2 --discount 0.6 -o help.json --save-plan help.plan")
    assert (done.code, done.out, done.err) == (0, "", "")
    lines = (tmp_path / "help.plan").read_text().splitlines()
    assert lines[0] == "; usar-room2: human commx, robot robot"
    assert lines[-1] == "; cost = 12.6 (general cost)"
    at = lines.index("(hand_over robot commx mk2 hall4)")
    assert lines[at - 1] == "; epoch 6"
    assert executes(serendipity.example("room2"), actions("\n".join(lines)))


@pytest.mark.parametrize("worked", WORKED, ids=str)
def test_every_plan_can_be_executed_line_by_line(worked: Worked) -> None:
    planned = worked.task()
    result = serendipity.plan(planned, human_plan=worked.human_plan, **worked.options)
    if result.plan is not None and result.mode != "assistance":
        assert executes(planned, actions(plan_file(planned, result)))


def test_who_undoes_something_comes_later() -> None:
    planned = task(
        init="door",
        goal="inside",
        actions={"enter h": "door -> inside @ 2", "close r": "door -> !door shut @ 0"},
    )
    result = Result(
        "composite",
        "feasible",
        "h",
        serendipity.Options(mode="composite"),
        plan=(
            serendipity.PlanStep(1, ("r",), "close r", 0.0),
            serendipity.PlanStep(1, ("h",), "enter h", 2.0),
        ),
        cost=2.0,
    )
    assert actions(plan_file(planned, result)) == ["enter h", "close r"]


def test_without_a_plan_there_is_no_file(run: Runs, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    anytime(monkeypatch, None, Result("serendipity", "unknown", "commx", serendipity.Options()))
    done = run("plan --example room2 --save-plan help.plan")
    assert done.err.startswith("Warning: --save-plan: there is no plan")
    assert not (tmp_path / "help.plan").exists()
