"""``serendipity bench`` measures contenders on the same calls and writes every timing."""

import csv
import shutil
import signal
from dataclasses import replace
from pathlib import Path

import pytest

from serendipity.cli.app import main
from serendipity.evaluation.benchmark import fast_downward
from serendipity.evaluation.benchmark.contenders import Contender, Outcome
from serendipity.evaluation.benchmark.coverage.rows import CONTENDERS as SUITE_CONTENDERS
from serendipity.evaluation.benchmark.coverage.rows import Call, Row
from serendipity.evaluation.benchmark.coverage.table import as_table
from serendipity.evaluation.benchmark.measure import CONTENDERS
from serendipity.evaluation.benchmark.scaling import AXES, Axis, Size
from serendipity.scenarios.examples import DATA
from serendipity.writing.rows import written


def test_contenders_stand_side_by_side(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    table = tmp_path / "timings.csv"
    arguments = ["bench", "--rooms", "8", "--seeds", "2", "--modes", "communication", "--discounts", "0.9"]
    assert (
        main([*arguments, "--repeat", "1", "--contenders", "search,in-turn,automata", "-o", str(table)]) == 0
    )
    printed = capsys.readouterr().out
    assert "2 tasks" in printed
    rows = list(csv.DictReader(table.read_text().splitlines()))
    assert [row["contender"] for row in rows] == ["search", "in-turn", "automata"] * 2
    assert printed.index(" x ") < printed.index(" ms "), "ratios come first"
    for search, in_turn, program in zip(rows[::3], rows[1::3], rows[2::3], strict=True):
        assert search["cost"] == in_turn["cost"] == program["cost"]
        assert search["status"] == in_turn["status"] == program["status"] == "optimal"


def test_an_absent_contender_is_left_out_with_one_line(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    here = CONTENDERS["fast-downward"]
    monkeypatch.setitem(CONTENDERS, "fast-downward", replace(here, absent=lambda: "it is not here"))
    arguments = ["bench", "--rooms", "4", "--seeds", "1", "--modes", "composite-inf", "--repeat", "1"]
    assert main([*arguments, "--contenders", "search,fast-downward"]) == 0
    printed = capsys.readouterr()
    assert printed.err == "Warning: it is not here\n"
    assert "fast-downward" not in printed.out


def test_absence_is_noticed_without_an_import(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(fast_downward, "_has_translator", lambda: False)
    monkeypatch.setattr(fast_downward, "binary", lambda: None)
    reason = fast_downward.absent()
    assert reason is not None
    assert "no fast-downward.translate and no up-fast-downward" in reason


def test_plots_are_pictures(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    pytest.importorskip("matplotlib")
    arguments = ["bench", "--rooms", "6", "--seeds", "2", "--discounts", "0.9", "--repeat", "1"]
    assert main([*arguments, "--contenders", "search,automata", "--plot", str(tmp_path / "b.png")]) == 0
    monkeypatch.setitem(AXES, "rooms", Axis("rooms", "rooms", tuple((n, Size(rooms=n)) for n in (4, 8))))
    monkeypatch.setitem(AXES, "modes", Axis("modes", "mode", ((0, Size(rooms=4)),), labels=("serendipity",)))
    series = ["bench", "--scaling", "rooms,modes", "--seeds", "2", "-o", str(tmp_path / "s.csv")]
    assert main([*series, "--plot", str(tmp_path / "s.svg")]) == 0
    assert (tmp_path / "b.png").read_bytes().startswith(b"\x89PNG")
    assert "<svg" in (tmp_path / "s.svg").read_text()
    rows = list(csv.DictReader((tmp_path / "s.csv").read_text().splitlines()))
    assert [(row["axis"], row["rooms"]) for row in rows] == [("rooms", "4")] * 2 + [("rooms", "8")] * 2 + [
        ("modes", "4")
    ] * 2


@pytest.mark.parametrize(
    "wrong",
    [
        ["--plot", "timings.txt"],
        ["--discounts", "x"],
        ["--scaling", "width"],
        ["here", "--scaling", "rooms"],
        ["--modes", "x"],
    ],
)
def test_wrong_usage_is_one_line(wrong: list[str], capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["bench", "--rooms", "4", "--seeds", "1", *wrong]) == 2
    assert capsys.readouterr().err.count("\n") == 1


def test_an_unknown_contender_is_named(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["bench", "--rooms", "4", "--seeds", "1", "--contenders", "search,guess"]) == 2
    assert capsys.readouterr().err.count("\n") == 1


def test_a_suite_is_measured_and_its_tables_are_printed_again(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    for name in ("flights", "parcels"):
        shutil.copytree(DATA / name, tmp_path / "suite" / name)
    rows = tmp_path / "rows.csv"
    arguments = [
        "bench",
        str(tmp_path / "suite"),
        "--modes",
        "individual,serendipity",
        "--contenders",
        "search",
    ]
    assert main([*arguments, "--domains", "parcels", "--time-limit", "10", "-o", str(rows)]) == 0
    first = capsys.readouterr().out
    assert "Calls decided: search." in first
    assert [row["status"] for row in csv.DictReader(rows.read_text().splitlines())] == ["optimal", "optimal"]
    assert main(["bench", str(rows)]) == 0
    assert first.endswith(capsys.readouterr().out)
    assert main(["bench", str(rows), "--markdown"]) == 0
    printed = capsys.readouterr().out
    assert "| domain | tasks | human's plan | individual | serendipity |\n| --- |" in printed
    assert "| parcels | 1 | 1 | 1 | 1 |" in printed


def test_optima_of_a_suite_that_differ_are_an_error(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    rows = [
        Row("d", "t", "h", "r", True, "individual", 0.9, name, Outcome("optimal", cost))
        for name, cost in (("search", 1.0), ("fast-downward", 2.0))
    ]
    (tmp_path / "rows.csv").write_text(str(written(as_table(rows), "csv")))
    assert main(["bench", str(tmp_path / "rows.csv")]) == 2
    printed = capsys.readouterr()
    assert "Calls decided" in printed.out
    assert printed.err == (
        "Error: d t, individual: the proved optima differ: search 1.0, fast-downward 2.0\n"
    )


def test_coverage_over_time_is_drawn(tmp_path: Path) -> None:
    pytest.importorskip("matplotlib")
    row = Row("d", "t", "h", "r", True, "individual", 0.9, "search", Outcome("optimal", 1.0, seconds=0.5))
    (tmp_path / "rows.csv").write_text(str(written(as_table([row]), "csv")))
    assert main(["bench", str(tmp_path / "rows.csv"), "--plot", str(tmp_path / "over.svg")]) == 0
    assert "<svg" in (tmp_path / "over.svg").read_text()


def test_an_interrupted_suite_leaves_what_was_measured(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    asked = iter(("optimal", "failed"))

    def answer(call: Call) -> Outcome:
        status = next(asked)
        if status == "failed":
            signal.raise_signal(signal.SIGINT)
        return Outcome(status, 1.0)

    monkeypatch.setitem(SUITE_CONTENDERS, "search", Contender(answer))
    shutil.copytree(DATA / "flights", tmp_path / "suite" / "flights")
    rows = tmp_path / "rows.csv"
    assert main(["bench", str(tmp_path / "suite"), "--contenders", "search", "-o", str(rows)]) == 130
    assert "Calls decided" in capsys.readouterr().out
    assert [row["status"] for row in csv.DictReader(rows.read_text().splitlines())] == ["optimal"]
