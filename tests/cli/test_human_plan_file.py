"""The file of --human-plan: how it may look, and where its errors point."""

import json
from collections.abc import Callable
from pathlib import Path

import pytest

import serendipity
from serendipity.cli.files.plans import checked_plan
from tests.cli.conftest import Run, assert_one_line


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
def test_every_look_is_the_same_plan(look: str, names: list[str], run: Callable[[str], Run]) -> None:
    Path("plan.txt").write_text(LOOKS[look](names))
    done = run("plan --example room2 --discount 0.6 --human-plan plan.txt --format json")
    assert done.code == 0, done
    answer = json.loads(done.out)
    assert answer["human_plan"] == names
    assert (answer["human_cost"], answer["cost"]) == (13.0, 12.6)


@pytest.mark.parametrize(
    "look",
    ["plain", "comments", "json lines", "noops", "carriage returns only"],
)
def test_an_error_names_file_and_line(look: str, names: list[str], run: Callable[[str], Run]) -> None:
    spoilt = [*names[:4], "fly commx hall5 hall1", *names[5:]]
    Path("plan.txt").write_text(LOOKS[look](spoilt))
    line = next(i for i, text in enumerate(Path("plan.txt").read_text().splitlines(), 1) if "fly" in text)
    assert_one_line(run("plan --example room2 --human-plan plan.txt"), f"plan.txt:{line}:", "fly")


def test_an_inapplicable_action_is_named(names: list[str], run: Callable[[str], Run]) -> None:
    Path("plan.txt").write_text("# his\n" + "\n".join([names[0], *names[2:]]))
    done = run("plan --example room2 --human-plan plan.txt")
    assert_one_line(done, "plan.txt:3:", names[2], "not applicable")


def test_a_robots_action_is_named(names: list[str], run: Callable[[str], Run]) -> None:
    Path("plan.txt").write_text("\n".join([*names[:2], "move robot room4 hall4", *names[2:]]))
    assert_one_line(run("plan --example room2 --human-plan plan.txt"), "plan.txt:3:", "commx", "alone")


def test_a_missed_goal_is_named(names: list[str], run: Callable[[str], Run]) -> None:
    Path("plan.txt").write_text("\n".join(names[:-1]))
    assert_one_line(run("plan --example room2 --human-plan plan.txt"), "plan.txt", "goal")


def test_half_a_bracket_is_named(tmp_path: Path) -> None:
    path = tmp_path / "plan.txt"
    path.write_text("move a b\n(move b c\n")
    with pytest.raises(serendipity.InputError, match=r"plan\.txt:2: .*expected one action"):
        checked_plan(path, serendipity.example("room2"))


@pytest.mark.parametrize("text", ["[1, 2]", '["a",', "[[]]"])
def test_json_that_is_no_list_of_names(text: str, tmp_path: Path) -> None:
    path = tmp_path / "plan.txt"
    path.write_text(text)
    with pytest.raises(serendipity.InputError, match=r"plan\.txt"):
        checked_plan(path, serendipity.example("room2"))
