"""Objects say in a line what they are, print as the command line does, and a notebook can show them."""

import json
import re
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import pytest

import serendipity
from serendipity import InputError, Result, Task, UsageError
from serendipity.scenarios.examples import DATA, EXAMPLES
from tests.cli.conftest import Runs

FILES = (DATA / EXAMPLES["room2"].domain, DATA / EXAMPLES["room2"].problem)
GOALS = [{"name": "triage", "goal": ["conducted_triage commx room1"]}]
MADE: dict[str, Callable[[Task, Result], Any]] = {
    "verify --example room2 help.json": serendipity.verify,
    "simulate --example room2 help.json": serendipity.simulate,
    "explain --example room2 help.json": serendipity.explain,
    "interruptions --example room2 --discount 0.6": lambda task, _: serendipity.interruptions(
        task, discount=0.6
    ),
    "execute --example room2 --discount 0.6": lambda task, _: serendipity.execute(task, discount=0.6),
    "check-task --example room2": lambda task, _: serendipity.check_task(task, [FILES]),
    "recognise --example room2 --goals goals.json": lambda task, _: serendipity.recognise(task, GOALS),
}
"""What makes each object, by what the command line says for it."""


@pytest.fixture(scope="module")
def task() -> Task:
    return serendipity.example("room2")


@pytest.fixture(scope="module")
def result(task: Task) -> Result:
    return serendipity.plan(task, discount=0.6)


@pytest.mark.parametrize("command", MADE)
def test_objects_look_like_what_the_command_prints(
    command: str, task: Task, result: Result, run: Runs
) -> None:
    Path("help.json").write_text(result.to_json(), encoding="utf-8")
    Path("goals.json").write_text(json.dumps(GOALS), encoding="utf-8")
    made = MADE[command](task, result)
    assert _timeless(f"{made}\n") == _timeless(run(command).out)
    assert_short(made)
    assert json.loads(made.to_json()) == json.loads(json.dumps(made.to_dict()))
    assert_page(made._repr_html_())


def test_results_and_tasks_do_so_too(task: Task, result: Result, run: Runs) -> None:
    printed = _timeless(run("plan --example room2 --discount 0.6").out).splitlines()
    assert _timeless(str(result)).splitlines() == [printed[0].removeprefix("usar-room2: "), *printed[1:-1]]
    assert repr(task) == "Task('usar-room2', 2 agents, 216 facts, 353 actions)"
    assert repr(result) == "Result('optimal', serendipity, commx: 13 -> 12.6, window [6, 7))"
    assert repr(result.options) == "Options(discount=0.6)"
    assert "goal of commx: conducted_triage commx room1" in str(task)
    helped = serendipity.plan(serendipity.example("room5"), mode="assistance", time_limit=5)
    serendipity.generate_usar("suite/1", preset="room2")
    rows = serendipity.reproduce("suite", modes=["serendipity"], discounts=[0.6])
    loops = (serendipity.Execution(task), serendipity.Session(task))
    for each in (task, result, result.options, result.table(), helped, helped.policy, rows, *loops):
        assert_short(each)
    for page in (task._repr_html_(), result._repr_html_(), helped._repr_html_()):
        assert_page(page)


def test_a_long_name_makes_no_long_line(task: Task) -> None:
    assert_short(replace(task, name="x" * 500, known_variables=task.variables))
    assert_page(replace(task, name="<script>&\u202e", known_variables=task.variables)._repr_html_())


def test_show_draws_what_the_command_draws(task: Task, result: Result, run: Runs) -> None:
    Path("help.json").write_text(result.to_json(), encoding="utf-8")
    report = serendipity.interruptions(task, discount=0.6)
    assert not run("show --example room2 help.json -o page.html").err
    assert not run("show --example room2 help.json --epoch 2 -o still.svg").err
    assert not run("interruptions --example room2 --discount 0.6 --heat-map windows.svg -q -o report.txt").err
    serendipity.show(task, result).save("again.html")
    assert Path("again.html").read_bytes() == Path("page.html").read_bytes()
    assert serendipity.show(task, result, epoch=2)._repr_svg_() == Path("still.svg").read_text()
    assert serendipity.show(task, report).svg() == report._repr_svg_() == Path("windows.svg").read_text()
    assert_short(serendipity.show(task, report))
    assert_short(serendipity.show(task))
    assert serendipity.show(task).html().startswith("<!doctype html>")


def test_show_says_what_it_can_not_draw(task: Task, result: Result) -> None:
    report = serendipity.interruptions(task, discount=0.6)
    with pytest.raises(UsageError, match="from 0 to 13, got 99"):
        serendipity.show(task, result, epoch=99)
    with pytest.raises(UsageError, match=r"expected a picture .*'\.pdf'"):
        serendipity.show(task, result).save("help.pdf")
    with pytest.raises(UsageError, match=r"expected a picture \.svg or \.png, got '\.html'"):
        serendipity.show(task, report).html()
    with pytest.raises(InputError, match="another task"):
        serendipity.show(serendipity.example("taxis"), result)


def assert_short(made: object) -> None:
    assert repr(made).startswith(f"{type(made).__name__}(")
    assert repr(made).isprintable() and len(repr(made)) < 120


def assert_page(page: str) -> None:
    """Whether it is a piece of a page, whatever names are in it."""
    assert (
        ElementTree.fromstring(page.replace("&emsp;", " ").join(("<div>", "</div>"))).find(".//*") is not None
    )


def _timeless(text: str) -> str:
    """A text without what a clock says, nor the blanks beside it."""
    return re.sub(r" +", " ", re.sub(r"\d[\d.e-]* m?s\b|0\.\d+(?= +- )", "", text))
