"""Names from files may hold anything: characters that nobody sees reach no terminal, page or picture."""

import csv
import io
import json
from pathlib import Path

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
