"""``--strategies`` chooses what is tried, and ``-v`` tells what came of each."""

import json

import pytest

from search.strategies.portfolio import chosen as chosen_turns
from tests.cli.conftest import Runs, assert_one_line


def tried(text: str) -> list[str]:
    """The first column of the table."""
    lines = text.splitlines()
    first = next(i for i, line in enumerate(lines) if line.startswith("turn "))
    return [line.split()[0] for line in lines[first + 1 :]]


@pytest.mark.parametrize(
    ("words", "chosen"),
    [
        ("", None),
        ("--strategies human-plan,all", "human-plan,all"),
        ("--strategies -bound", "-bound"),
        ("--strategies=-all,-bound", "-all,-bound"),
    ],
)
def test_the_table_has_those_that_were_tried(run: Runs, words: str, chosen: str | None) -> None:
    done = run(f"plan --example room2 --discount 0.6 --format json -v {words}")
    answer = json.loads(done.out)
    names = [row["name"] for row in answer["statistics"]["strategies"]]
    assert tried(done.err) == names
    assert answer["options"]["strategies"] == chosen
    known = [turn.name for turn in chosen_turns(chosen.split(",") if chosen else [])]
    assert names == [name for name in known if name in names]


def test_nothing_is_told_without_v_and_another_name_is_refused(run: Runs) -> None:
    run("plan --example room2 -v")
    assert run("plan --example room2 --quiet").err == ""
    assert_one_line(run("plan --example room2 --strategies magic"), "strategies", "magic")


def test_a_planner_of_others_is_asked_only_where_it_can_tell(run: Runs) -> None:
    done = run("plan --example room2 --classical symk")
    told = "classical: is for individual mode, and for composite mode without a horizon"
    assert (done.code, done.err) == (2, f"Error: {told}\n")
