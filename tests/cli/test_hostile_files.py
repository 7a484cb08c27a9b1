"""Names from files may hold anything: characters that nobody sees reach no terminal, page or picture.

Times that can't be, or are too many: an exit code and one line each, soon, and in little memory.
"""

import csv
import io
import json
from collections.abc import Mapping
from pathlib import Path
from time import monotonic

import pytest

import serendipity
from serendipity.model.printable import LONGEST, message, printable, printable_json
from serendipity.writing.csv_text import as_csv
from tests.cli.conftest import Runs, assert_one_line

HOSTILE = "mk\u200e2j\u200b1\u00ad"
"""Says how the direction of writing goes on, and is not as long as it looks.

What clears a screen or turns the direction round is refused when a file is read.
"""


@pytest.fixture
def building(tmp_path: Path) -> str:
    """The example room2 with a medkit of a hostile name."""
    serendipity.generate_usar(tmp_path, preset="room2", layout="pair")
    problem = tmp_path / "problem.pddl"
    problem.write_text(problem.read_text().replace("mk2", HOSTILE))
    return "domain.pddl problem.pddl --human commx --robot robot"


def unseen(text: str) -> set[str]:
    return {character for character in text if not character.isprintable()} - {"\n"}


def test_every_report_is_printable(building: str, run: Runs, tmp_path: Path) -> None:
    task, options = building.split(" --", 1)
    assert run(f"plan {building} --discount 0.6 -o help.json").code == 0
    assert json.loads((tmp_path / "help.json").read_text())["plan"][3]["action"].startswith("pick_up")
    for command in (
        f"plan {building} --discount 0.6",
        f"plan {building} --discount 0.6 --format json",
        f"explain {building} --discount 0.6",
        f"interruptions {building} --discount 0.6 --format json",
        f"simulate {task} help.json --{options}",
    ):
        done = run(command)
        assert (done.code, done.err) == (0, "")
        assert "u200b1" in done.out
        assert not unseen(done.out)
    for ending in ("html", "svg"):
        assert run(f"show {task} help.json --{options} -o help.{ending}").code == 0
        drawn = (tmp_path / f"help.{ending}").read_text()
        assert r"\u200b1" in drawn
        assert not unseen(drawn)


def test_errors_and_warnings_are_short_and_printable(building: str, run: Runs, tmp_path: Path) -> None:
    problem = tmp_path / "problem.pddl"
    problem.write_text(problem.read_text().replace(f"(at {HOSTILE} room3)", f"(at {HOSTILE * 50_000} room3)"))
    done = run(f"plan {building}")
    assert_one_line(done, "problem.pddl", r"\u200b1")
    assert len(done.err) <= LONGEST + len("\n")
    assert not unseen(done.err)


@pytest.mark.parametrize("schema", [[1] * 100_000, "\u202e" * 1000, None])
def test_errors_about_results_are_short(schema: object, run: Runs, tmp_path: Path) -> None:
    (tmp_path / "answer.json").write_text(json.dumps({"schema": schema}))
    done = run("verify --example room2 answer.json")
    assert_one_line(done, "answer.json", "schema")
    assert len(done.err) <= LONGEST + len("\n")


@pytest.mark.parametrize(
    ("text", "shown"),
    [
        ("grün, 部屋2", "grün, 部屋2"),
        ("a\nb\tc\x1b[2J", r"a\nb\tc\x1b[2J"),
        ("\u2066a\u2069\ufeff\u00ad", r"\u2066a\u2069\ufeff\xad"),
        ("\U000e0041\ud800", r"\U000e0041\ud800"),
    ],
)
def test_what_cannot_be_seen_is_written_as_its_code(text: str, shown: str) -> None:
    assert printable(text) == shown


def test_json_keeps_its_meaning() -> None:
    value = {"grün": "\x7f\u202e\U000e0041部屋", "lines": ["a\nb"]}
    text = printable_json(json.dumps(value, ensure_ascii=False, indent=1))
    assert json.loads(text) == value
    assert "部屋" in text
    assert not unseen(text)


def test_a_long_message_loses_its_middle() -> None:
    text = message("file.pddl:7: expected a name, got " + "x" * 10**6 + " in 'at'")
    assert len(text) == LONGEST
    assert text.startswith("file.pddl:7: expected a name, got xx")
    assert text.endswith("x in 'at'")
    assert " … " in text


def test_spreadsheets_compute_nothing() -> None:
    rows = [["=cmd|'/C calc'!A0", "@sum", "+1+1", "-2", "-", -2.5, "1e-3"]]
    text = as_csv(["=name", "b", "c", "d", "e", "f", "g"], rows)
    assert list(csv.reader(io.StringIO(text))) == [
        ["'=name", "b", "c", "d", "e", "f", "g"],
        ["'=cmd|'/C calc'!A0", "'@sum", "'+1+1", "-2", "'-", "-2.5", "1e-3"],
    ]


DOMAIN = """(define (domain home) (:requirements :typing :durative-actions :timed-initial-literals :fluents)
 (:types agent) (:predicates (open) (there ?a - agent) (out ?a - agent)) (:functions (pace ?a - agent))
 (:durative-action walk :parameters (?a - agent) :duration {duration}
  :effect (at end (there ?a)))
 (:durative-action leave :parameters (?a - agent) :duration (= ?duration 2)
  :condition (and (at start (there ?a)) (at start (open)) (over all (open))) :effect (at end (out ?a))))
"""
PROBLEM = """(define (problem day) (:domain home) (:objects ann bob carol - agent)
 (:init {init}
 ) (:goal (and {goal})))
"""
USUAL = {"duration": "(= ?duration 4)", "init": "(open)", "goal": "(out ann)", "plan": ""}
PLAN = "plan domain.pddl problem.pddl --human ann --robot bob"
CAROL = "--robot carol --bystander carol"
DONE = "--bystander carol=carol.plan"


ABOVE, MOST = "domain.pddl:3: action 'walk': expected a duration above 0", "expected at most 1,000,000"
TWICE = "problem.pddl:2: 'open' becomes true and false"
CAROLS, HIS = "carol.plan:1: plan of carol: ", "--human-plan carol.plan"


def duration(length: str) -> dict[str, str]:
    """Walks of that length."""
    return {"duration": f"(= ?duration {length})"}


def plan(text: str) -> dict[str, str]:
    return {"plan": text}


@pytest.mark.parametrize(
    ("given", "options", "code", "words"),
    [
        (duration("0"), "", 2, f"{ABOVE}, got 0"),
        (duration("-4"), "", 2, f"{ABOVE}, got -4"),
        (duration("(- 2 2)"), "", 2, f"{ABOVE}, got 0"),
        (duration("2.5"), "", 0, ""),
        (duration("2.5"), "--epoch 1", 0, "Warning: durations are rounded up to whole epochs of 1"),
        (duration("1000000000"), "", 2, f"takes 500,000,000 epochs of 2, {MOST}"),
        (duration("1000000000"), "--epoch 1e6", 0, "Warning: durations are rounded up"),
        (duration("1000000"), "", 2, "takes 500,000 epochs, expected at most 10,000: longer epochs"),
        (duration("0.000001"), "", 2, f"takes 2,000,000 epochs of 1e-06, {MOST}"),
        ({"init": "(open) (at 0 (there ann))"}, "", 2, "problem.pddl:2: initial state: expected a time"),
        ({"init": "(open) (at -3 (there ann))"}, "", 2, "expected a time above 0, got -3"),
        ({"init": "(at 2 (open)) (at 2 (there ann))"}, "", 0, ""),
        ({"init": "(at 2 (open)) (at 2 (open))"}, "", 0, ""),
        ({"init": "(at 2 (open)) (at 2 (not (open)))"}, "", 2, f"{TWICE} at 2"),
        ({"init": "(at 2 (open)) (at 1.5 (not (open)))"}, "--epoch 2", 2, f"{TWICE} with epoch 1 of 2"),
        ({"init": "(at 2000000 (open))"}, "", 2, "the script takes 1,000,000 epochs, expected"),
        ({"init": "(at 1e9 (open))"}, "", 2, f"takes 500,000,000 epochs of 2, {MOST}"),
        (plan("0: (fly carol)"), DONE, 2, f"{CAROLS}'fly carol' is not an action that carol can do alone"),
        (plan("0: (walk ann)"), DONE, 2, f"{CAROLS}'walk ann' is not an action that carol can do alone"),
        (
            plan("0: (walk carol)\n2: (leave carol)"),
            DONE,
            2,
            "carol.plan:2: plan of carol: 'leave carol' begins in epoch 2, but",
        ),
        (plan("; epoch 0\n(walk carol)"), DONE, 2, "carol.plan:2: plan of carol: expected an epoch from 1"),
        ({}, "--bystander carol=", 2, "--bystander: expected NAME or NAME=FILE, got no file after '='"),
        (plan("0: (walk carol) [7]"), DONE, 2, f"{CAROLS}expected [4], the duration of 'walk carol'"),
        (plan("1: (walk carol) [4]"), DONE, 2, f"{CAROLS}expected a multiple of 2"),
        (plan("9e9: (walk carol)"), DONE, 2, f"{CAROLS}expected one action"),
        (plan("4000000: (walk carol)"), DONE, 2, f"{CAROLS}{MOST[:26]}"),
        (plan("1900000: (walk carol)"), DONE, 2, "the script takes 950,002 epochs, expected at most 100"),
        (plan("0: (leave carol)"), DONE, 3, "are idle, epoch 1: 'leave carol' is not applicable"),
        (plan("[1]"), DONE, 2, "carol.plan"),
        ({}, "--bystander carol=nowhere", 2, "nowhere: can't be read"),
        ({}, "--bystander dave", 2, "dave"),
        ({}, "--bystander ann", 2, "bystander 'ann': is the human"),
        ({}, "--bystander carol --bystander CAROL=carol.plan", 2, "--bystander: expected each name once"),
        ({}, CAROL, 2, "bystander 'carol': has no goal in the task, so a plan has to be given"),
        ({"goal": "(out ann) (there carol)"}, CAROL, 0, ""),
        ({"init": "", "goal": "(there ann) (out carol)"}, CAROL, 2, "'carol': can't reach the goal alone"),
        ({}, "--human any", 2, "'any' is for tasks with files for each agent"),
        ({}, "--epoch 0", 2, "epoch: expected a number above 0, got 0"),
        ({}, "--epoch 1e-9", 2, f"{MOST}: longer epochs can be asked for with --epoch"),
        (plan("0: (walk ann)\n4.5: (leave ann)"), HIS, 2, "expected a multiple of 2"),
        (plan("0: (walk ann)\n1998: (leave ann)"), HIS, 0, ""),
        (plan("0: (walk ann)\n2: (leave ann)"), HIS, 2, "carol.plan:2: human plan"),
        (plan("-4: (walk ann)"), HIS, 2, "carol.plan:1: human plan: expected a time from 0 on, got -4"),
        ({}, "--waiting-cost -1", 2, "waiting_cost: expected a number of at least 0, got -1"),
        ({}, "--head-start 1000001", 2, "head_start: expected at most 1000000, got 1000001"),
    ],
)
def test_times(given: Mapping[str, str], options: str, code: int, words: str, run: Runs) -> None:
    texts = USUAL | given
    Path("domain.pddl").write_text(DOMAIN.format(**texts))
    Path("problem.pddl").write_text(PROBLEM.format(**texts))
    Path("carol.plan").write_text(texts["plan"])
    begun = monotonic()
    done = run(f"{PLAN} {options}")
    lines = [line for line in done.err.splitlines() if "no agent of this call" not in line]
    assert (done.code, len(lines)) == (code, bool(words)), done
    assert words in done.err
    assert bool(done.out) == (code != 2)
    assert monotonic() - begun < 5
