"""``serendipity bench`` measures contenders on the same calls and writes every timing."""

import csv
from pathlib import Path

import pytest

from serendipity.cli.app import main


def test_contenders_stand_side_by_side(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    table = tmp_path / "timings.csv"
    arguments = ["bench", "--rooms", "8", "--seeds", "2", "--modes", "communication", "--discounts", "0.9"]
    assert main([*arguments, "--repeat", "1", "-o", str(table)]) == 0
    printed = capsys.readouterr().out
    assert "2 tasks" in printed
    rows = list(csv.DictReader(table.read_text().splitlines()))
    assert [row["contender"] for row in rows] == ["search", "automata"] * 2
    for search, program in zip(rows[::2], rows[1::2], strict=True):
        assert search["cost"] == program["cost"]
        assert search["status"] == program["status"] == "optimal"


def test_an_unknown_contender_is_named(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["bench", "--rooms", "4", "--seeds", "1", "--contenders", "search,guess"]) == 2
    assert capsys.readouterr().err.count("\n") == 1
