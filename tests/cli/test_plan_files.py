"""Plan files: how that of --human-plan may look, where its errors point, and what ``--save-plan`` writes."""

import json
from collections.abc import Callable
from pathlib import Path

import pytest

import serendipity
from serendipity.cli.files.plans import plan_file, timed_plan
from serendipity.cli.options.planning import Planning
from serendipity.model import PlanError, Result, Script, Task
from serendipity_testing.builders import task
from serendipity_testing.builders import task as build
from serendipity_testing.cases import WORKED, Worked
from tests.cli.conftest import Runs, assert_one_line
from tests.cli.test_exit_codes import anytime


@pytest.fixture
def names() -> list[str]:
    """The human's plan in the example room2."""
    plan = serendipity.plan(serendipity.example("room2")).human_plan
    assert plan is not None
    return list(plan)


LOOKS: dict[str, Callable[[list[str]], str]] = {
    "plain": "\n".join,
    "brackets": lambda names: "\n".join(f"({name})" for name in names),
    "upper case": lambda names: "\n".join(names).upper(),
    "epochs": lambda names: "\n".join(f"{i}: ({name})" for i, name in enumerate(names, 1)),
    "the paper's": lambda names: "\n".join(f"- {i} - {name}" for i, name in enumerate(names, 1)),
    "comments": lambda names: "; his plan\n\n" + "\n# wait\n".join(f"{name} ; so" for name in names),
    "noops": lambda names: "noop\n" + "\n(NOOP)\n".join(names),
    "json": lambda names: json.dumps(names),
    "json lines": lambda names: json.dumps(names, indent=2),
    "byte order mark": lambda names: "\ufeff" + "\n".join(names),
    "json with a byte order mark": lambda names: "\ufeff" + json.dumps(names),
    "carriage returns only": lambda names: "; his plan\r" + "\r".join(names),
    "json with carriage returns": lambda names: json.dumps(names, indent=2).replace("\n", "\r"),
}


@pytest.mark.parametrize("look", LOOKS)
def test_every_look_is_the_same_plan(look: str, names: list[str], run: Runs) -> None:
    Path("plan.txt").write_text(LOOKS[look](names))
    done = run("plan --example room2 --discount 0.6 --human-plan plan.txt --format json")
    assert done.code == 0, done
    answer = json.loads(done.out)
    assert answer["human_plan"] == names
    assert (answer["human_cost"], answer["cost"]) == (13.0, 12.6)


@pytest.mark.parametrize("look", ["plain", "comments", "json lines", "noops", "carriage returns only"])
def test_an_error_names_file_and_line(look: str, names: list[str], run: Runs) -> None:
    spoilt = [*names[:4], "fly commx hall5 hall1", *names[5:]]
    Path("plan.txt").write_text(LOOKS[look](spoilt))
    line = next(i for i, text in enumerate(Path("plan.txt").read_text().splitlines(), 1) if "fly" in text)
    assert_one_line(run("plan --example room2 --human-plan plan.txt"), f"plan.txt:{line}:", "fly")


SPOILT: list[tuple[Callable[[list[str]], list[str]], list[str]]] = [
    (lambda his: ["# his", his[0], *his[2:]], ["plan.txt:3:", "hall7 hall6", "not applicable"]),
    (lambda his: [*his[:2], "move robot room4 hall4", *his[2:]], ["plan.txt:3:", "commx", "alone"]),
    (lambda his: his[:-1], ["plan.txt", "goal"]),
]


@pytest.mark.parametrize(
    ("spoil", "words"), SPOILT, ids=["an inapplicable action", "a robot's action", "a missed goal"]
)
def test_what_is_no_plan_is_named(
    spoil: Callable[[list[str]], list[str]], words: list[str], names: list[str], run: Runs
) -> None:
    Path("plan.txt").write_text("\n".join(spoil(names)))
    assert_one_line(run("plan --example room2 --human-plan plan.txt"), *words)


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("move a b\n(move b c\n", r"plan\.txt:2: .*expected one action"),
        ("[1, 2]", r"plan\.txt"),
        ('["a",', r"plan\.txt"),
        ("[[]]", r"plan\.txt"),
    ],
)
def test_half_a_bracket_or_no_list_of_names_is_named(text: str, said: str, tmp_path: Path) -> None:
    path = tmp_path / "plan.txt"
    path.write_text(text)
    with pytest.raises(serendipity.InputError, match=said):
        timed_plan(path, serendipity.example("room2"))


def test_a_plan_is_read_behind_its_head_start(tmp_path: Path) -> None:
    door = build(init="shut", goal="in", actions={"pass h": "!shut -> in"})
    file = tmp_path / "plan.txt"
    file.write_text("; through the door\npass h\n")
    opens = door.with_script(Script(facts=[(2, "!shut")]))
    assert Planning(file, head_start="3").plan_of(opens) == ("pass h",)
    shuts = opens.with_script(Script(facts=[(4, "shut")]))
    with pytest.raises(PlanError, match=r"plan.txt:2: human plan, step 1: 'pass h' is not applicable"):
        Planning(file, head_start="5").plan_of(shuts)


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


@pytest.mark.parametrize("mode", ["individual", "serendipity", "communication", "composite"])
@pytest.mark.parametrize("given", [None, [[2, "walk h"], [6, "noop"]]], ids=["predicted", "given"])
def test_waiting_at_the_end_is_read_back(mode: str, given: list[list[object]] | None, tmp_path: Path) -> None:
    """Beside robots who do nothing it was not written, and what was read missed the goal."""
    actions = {"walk h": "-> there", "go r": "-> away"}
    bus = build(goal="there come", actions=actions).with_script(Script(facts=[(4, "come")]))
    result = serendipity.plan(bus, mode=mode, human_plan=given)
    path = tmp_path / "h.plan"
    path.write_text(plan_file(bus, result))
    read = timed_plan(path, bus)
    assert read[-1] == (6 if given else 4, "noop")
    assert read[:-1] == tuple((step.epoch, step.action) for step in result.plan or ())
    assert read == result.human_entries or (given and mode != "serendipity")


def test_without_a_plan_there_is_no_file(run: Runs, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    anytime(monkeypatch, None, Result("serendipity", "unknown", "commx", serendipity.Options()))
    done = run("plan --example room2 --save-plan help.plan")
    assert done.err.startswith("Warning: --save-plan: there is no plan")
    assert not (tmp_path / "help.plan").exists()
