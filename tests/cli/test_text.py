"""The text of an answer says what the result says."""

import re
from dataclasses import replace

import pytest

import serendipity
from serendipity.cli.on_demand import NAMES
from serendipity.cli.text.answers import plan_report
from serendipity.cli.text.render import rendered
from serendipity.model import Options, Result, Window
from serendipity.model.keywords import CHOICES
from serendipity.model.telling import Grid, Line
from serendipity.pictures import build_scene
from serendipity.pictures.scene.scene import subtitle
from serendipity_testing.builders import task
from tests.cli.conftest import Runs


def rows(text: str) -> dict[str, list[str]]:
    """Rows of the plan's table by epoch, cells split at the gaps between columns."""
    lines = text.splitlines()
    first = next(i for i, line in enumerate(lines) if line.startswith("epoch"))
    table: dict[str, list[str]] = {}
    for line in lines[first:]:
        if not line:
            break
        cells = [cell.strip() for cell in line.replace("* ", "").strip().split("   ") if cell.strip()]
        table[cells[0]] = cells[1:]
    return table


def test_the_one_plan_left_to_watch_is_told_as_any_other(run: Runs) -> None:
    """The task's name was missing, and the checker's line said the table again."""
    asked = "plan --example room2 --discount 0.6 --ties"
    for more, ends in (("", "checker: proves"), ("--verify", "realised ")):
        found = [run(f"{asked} {ties} {more}").out.splitlines() for ties in ("fixed", "watched")]
        assert found[1][0] == found[0][0] == "usar-room2: human commx, robot robot"
        assert all(lines[-1].startswith(ends) for lines in found)


def test_the_demo_shows_both_plans_in_parallel(run: Runs) -> None:
    text = run("plan --example room2 --discount 0.6").out
    result = serendipity.plan(serendipity.example("room2"), discount=0.6)
    table = rows(text)
    assert len(result.human_plan) == 13
    for epoch, action in enumerate(result.human_plan, start=1):
        assert table[str(epoch)][-1] == action
    for step in result.plan:
        assert table[str(step.epoch)].count(step.action) >= len(step.agents)
    assert table["6"][:2] == ["hand_over robot commx mk2 hall4"] * 2
    assert [line for line in text.splitlines() if line.lstrip().startswith("* ")] == [
        line for line in text.splitlines() if line.lstrip().startswith("* 6 ")
    ]
    assert "cost 13 -> 12.6, saving 0.4" in text
    assert "checker: proves replay, cost, window (" in text


@pytest.mark.parametrize(
    ("command", "words"),
    [
        ("--example room7 --discount 0.6", ["no opportunity (proved)", "cost 13 -> 13"]),
        ("--example room7 --discount 0.6 --mode communication", ["an opportunity", "cost 13 -> 12.6"]),
        ("--example room2 --mode individual", ["individual: a plan, proved to be the best"]),
        ("--example room2 --max-window 2", ["max_window 2"]),
    ],
)
def test_headlines(command: str, words: list[str], run: Runs) -> None:
    text = run(f"plan {command}").out
    for word in words:
        assert word in text


def test_a_plan_that_is_only_the_humans_is_not_shown_twice(run: Runs) -> None:
    text = run("plan --example room7 --discount 0.6").out
    assert "former plan" not in text
    assert text.count("conduct_triage commx room1") == 1


def test_a_terminal_gets_the_same_words_in_colour() -> None:
    parts = [
        Line("cost [13]", "bold"),
        Grid(("epoch", "r"), [("1", "move [x]"), ("* 2",)], frozenset({1}), True),
    ]
    plain, coloured = rendered(parts, terminal=False), rendered(parts, terminal=True)
    assert plain == "cost [13]\nepoch   r\n    1   move [x]\n  * 2\n"
    bare = re.sub(r"\x1b\[[0-9;]*m", "", coloured)
    assert coloured != bare
    assert bare.split() == plain.split()


@pytest.mark.parametrize("width", [40, 80, 120])
def test_nothing_is_cut_on_a_narrow_terminal(width: int, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("COLUMNS", str(width))
    task = serendipity.example("room2")
    report = serendipity.interruptions(task, discount=0.6)
    for shown in (report, serendipity.verify(task, answer()), answer()):
        words = re.sub(r"\x1b\[[0-9;]*m", "", rendered(shown.told(), terminal=True))
        assert "\N{HORIZONTAL ELLIPSIS}" not in words
        assert set(str(shown).split()) == set(words.split())


def answer(**changes: object) -> Result:
    """An answer that is not proved, with a window of one epoch, in the example room2."""
    result = serendipity.plan(serendipity.example("room2"), discount=0.6)
    return replace(result, status="feasible", **changes)


def reported(**changes: object) -> str:
    task, result = serendipity.example("room2"), answer(**changes)
    return plan_report(task, result, serendipity.check(task, result))


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"lower_bound": 1009.7}, "at least 9.7 has to be paid"),
        (
            {"lower_bound": 2009.7, "window": Window(4, 7)},
            "in a window of 2 epochs, at least 9.7 has to be paid",
        ),
        ({"lower_bound": 12.0, "window": None}, "at least 12 has to be paid"),
        ({"lower_bound": 5.0}, "at least 0 has to be paid"),
    ],
)
def test_what_is_not_proved_is_said_in_costs(changes: dict[str, object], words: str) -> None:
    text = reported(**changes)
    assert f"not proved to be the best: {words}" in text
    assert "100" not in text.splitlines()[1]


def test_a_small_window_weight_stays_in_the_sentence() -> None:
    text = reported(lower_bound=11.0, options=Options(window_weight=2))
    assert "no less than 11 is possible, with 2 for each epoch of a window" in text


@pytest.mark.parametrize(
    ("before", "after", "words"),
    [
        (13.0, 12.6, "cost 13 -> 12.6, saving 0.4"),
        (12345678901.5, 12345678901.1, "cost 12345678901.5 -> 12345678901.1, saving 0.4"),
        (1e30, 1e30, "cost 1e+30, saving 0.4"),
    ],
)
def test_a_saving_is_seen_in_the_costs_beside_it(before: float, after: float, words: str) -> None:
    assert words in reported(human_cost=before, cost=after, saving=0.4).splitlines()


@pytest.mark.parametrize("mode", CHOICES["mode"])
def test_a_goal_that_holds_already_is_said_to(mode: str) -> None:
    there = task(init="g", goal="g", actions={"undo h": "g -> !g", "do r": "!g -> g"})
    result = serendipity.plan(there, mode=mode)
    lines = plan_report(there, result, serendipity.check(there, result)).splitlines()
    assert "h's goal holds already, so there is nothing to help h with" in lines
    assert "h's goal holds already" in subtitle(build_scene(there, result))


def test_the_human_alone_is_a_search_too(run: Runs) -> None:
    text = run("plan --example room2 --mode individual").out
    assert re.search(r"planned in .*, [1-9]\d* nodes expanded", text)


PRONOUNS = re.compile(r"\b(he|his|him|himself|she|her)\b", re.IGNORECASE)


def test_nobody_is_called_he(run: Runs) -> None:
    assert run("plan --example room5 --discount 0.9 -o help.json").code == 0
    commands = [f"{name} --help" for name in NAMES]
    commands += ["generate usar --help", "plan --example room2 --discount 0.6", "explain --example room2"]
    commands += ["explain --example room7 --discount 0.6", "simulate --example room5 help.json"]
    commands += ["interruptions --example room2 --all", "examples"]
    for command in commands:
        assert not PRONOUNS.search(run(command).out), command
