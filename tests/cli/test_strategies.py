"""``--strategies`` chooses what is tried, and ``-v`` tells what came of each."""

import json

import pytest

from search.strategies.portfolio import chosen as chosen_turns
from serendipity.cli.text.answers import table_of
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


def test_a_row_tells_all() -> None:
    rows = [
        {"name": "soon", "seconds": 0.0004, "better": 0, "bound": None, "settled": False},
        {"name": "all", "seconds": 12.5, "better": 2, "bound": 1012.6, "settled": True},
    ]
    assert [line.split() for line in table_of(rows).splitlines()] == [
        ["turn", "seconds", "better", "answers", "bound", "settled"],
        ["soon", "0.000"],
        ["all", "12.500", "2", "1012.6", "yes"],
    ]
