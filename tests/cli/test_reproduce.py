"""Suites on the command line: ``reproduce``, and ``bench``, which writes every timing."""

import csv
import json
import re
import shutil
import signal
from dataclasses import replace
from pathlib import Path

import pytest

import serendipity
from serendipity.classical import fast_downward
from serendipity.evaluation.benchmark.contenders import Contender, Outcome
from serendipity.evaluation.benchmark.coverage import CONTENDERS as SUITE_CONTENDERS
from serendipity.evaluation.benchmark.coverage import Call
from serendipity.evaluation.benchmark.rows import BenchRow, as_table
from serendipity.evaluation.benchmark.scaling import AXES, Axis
from serendipity.evaluation.benchmark.side_by_side import CONTENDERS
from serendipity.scenarios.examples import DATA
from serendipity.writing.rows import written
from tests.cli.conftest import Runs, assert_one_line

SHORT = "--modes serendipity,individual --discounts 0.6"


@pytest.fixture
def suite(tmp_path: Path) -> Path:
    for number, preset in ((1, "room2"), (2, "room7")):
        serendipity.generate_usar(tmp_path / "suite" / f"test{number}", preset=preset)
    return tmp_path / "suite"


@pytest.mark.long
def test_formats_say_the_same(run: Runs, suite: Path) -> None:
    shown = run(f"reproduce suite {SHORT}")
    assert (shown.code, shown.err) == (0, "")
    rows = run(f"reproduce suite {SHORT} --format csv").out.splitlines()
    data = json.loads(run(f"reproduce suite {SHORT} --format json").out)
    assert data["schema"] == "serendipity.reproduction/1"
    for line, row in zip(rows[1:], data["rows"], strict=True):
        cells = dict(zip(rows[0].split(","), line.split(","), strict=True))
        assert cells.pop("seconds") != ""
        assert cells == {name: "" if row[name] is None else str(row[name]) for name in cells}
        assert any(text.split()[:4] == list(cells.values())[:4] for text in shown.out.splitlines())
    assert "Table I:" in shown.out
    assert "Table II:" in shown.out


@pytest.mark.long
def test_files(run: Runs, suite: Path, tmp_path: Path) -> None:
    done = run(f"reproduce suite {SHORT} -o rows.csv --report page.html --tables table")
    assert (done.code, done.out, done.err) == (0, "", "")
    written = {path.name for path in tmp_path.iterdir()}
    assert written == {"suite", "rows.csv", "page.html", "table1.csv", "table2.csv"}
    assert (tmp_path / "table1.csv").read_text().startswith("discount,variant,mean_cost,improved,")
    assert (tmp_path / "table2.csv").read_text().startswith("mode,calls,mean_seconds,")


def test_a_journal_of_ones_own_stays(run: Runs, suite: Path, tmp_path: Path) -> None:
    first = run(f"reproduce suite {SHORT} --format csv --journal done.jsonl").out
    assert run(f"reproduce suite {SHORT} --format csv --journal done.jsonl").out == first
    assert len((tmp_path / "done.jsonl").read_text().splitlines()) == 2


def test_progress_in_lines(run: Runs, suite: Path) -> None:
    *_, last = run(f"reproduce suite {SHORT} --format csv --progress json").err.splitlines()
    told = json.loads(last)
    assert (told["event"], told["what"], told["done"], told["total"]) == ("done", "tasks", 2, 2)
    assert "opportunities" in told


@pytest.mark.usefixtures("suite")
def test_what_is_no_folder_of_tasks_or_no_scheduler(run: Runs) -> None:
    assert_one_line(run("reproduce suite/test1"), "single task", "serendipity plan")
    assert_one_line(run(f"reproduce suite {SHORT} --dask nonsense://x --quiet"), "--dask", "nonsense://x")


def test_nothing_is_told_of_means_of_no_task(run: Runs, suite: Path) -> None:
    for problem in suite.glob("*/commx/problem.pddl"):
        problem.write_text("(define (problem")
    shown = run(f"reproduce suite {SHORT}").out
    assert ("error" in shown, "Table I" in shown, "0.000000" in shown) == (True, False, False)


def test_a_broken_task_is_told_when_all_others_are_done(run: Runs, suite: Path, tmp_path: Path) -> None:
    problem = suite / "test1" / "commx" / "problem.pddl"
    good = problem.read_text()
    problem.write_text("(define (problem")
    done = run(f"reproduce suite {SHORT} -o rows.csv")
    assert (done.code, done.out) == (2, "")
    assert re.fullmatch(r"Error: 1: .*problem\.pddl:1: .*\n", done.err)
    table = [line.split(",")[:9] for line in (tmp_path / "rows.csv").read_text().splitlines()]
    assert [(row[0], row[8]) for row in table[1:]] == [("1", "error")] * 2 + [("2", "optimal")] * 2
    problem.write_text(good)
    assert (tmp_path / "rows.csv.journal").exists(), "the answer does not hold all of it"
    assert run(f"reproduce suite {SHORT} -o rows.csv").code == 0
    assert not (tmp_path / "rows.csv.journal").exists()
    problem.write_text("(define (problem")
    assert run("bench suite --modes composite --discounts 0.9 --contenders search -o times.csv").code == 2
    *_, last = (tmp_path / "times.csv").read_text().splitlines()
    assert last.startswith(",test1,") and ",error," in last
    assert "problem.pddl:1" in last


def rows_of(path: Path) -> list[dict[str, str]]:
    return list(csv.DictReader(path.read_text().splitlines()))


def test_contenders_stand_side_by_side(run: Runs) -> None:
    words = "bench --rooms 8 --seeds 2 --modes communication --discounts 0.9 --repeat 1"
    done = run(f"{words} --contenders search,in-turn,automata -o timings.csv")
    assert done.code == 0
    assert "2 tasks" in done.out
    rows = rows_of(Path("timings.csv"))
    assert [row["contender"] for row in rows] == ["search", "in-turn", "automata"] * 2
    assert done.out.index(" x ") < done.out.index(" ms "), "ratios come first"
    for search, in_turn, program in zip(rows[::3], rows[1::3], rows[2::3], strict=True):
        assert search["cost"] == in_turn["cost"] == program["cost"]
        assert search["status"] == in_turn["status"] == program["status"] == "optimal"


def test_an_absent_contender_is_left_out_with_one_line(run: Runs, monkeypatch: pytest.MonkeyPatch) -> None:
    here = CONTENDERS["fast-downward"]
    monkeypatch.setitem(CONTENDERS, "fast-downward", replace(here, absent=lambda: "it is not here"))
    words = "bench --rooms 4 --seeds 1 --modes composite-inf --repeat 1"
    done = run(f"{words} --contenders search,fast-downward")
    assert (done.code, done.err) == (0, "Warning: it is not here\n")
    assert "fast-downward" not in done.out


def test_absence_is_noticed_without_an_import(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(fast_downward, "_has_translator", lambda: False)
    monkeypatch.setattr(fast_downward, "program", lambda _: None)
    reason = fast_downward.absent()
    assert "no fast-downward.translate and no up-fast-downward" in reason


@pytest.mark.long
def test_plots_are_pictures(run: Runs, monkeypatch: pytest.MonkeyPatch) -> None:
    pytest.importorskip("matplotlib")
    words = "bench --rooms 6 --seeds 2 --discounts 0.9 --repeat 1 --contenders search,automata"
    assert run(f"{words} --plot b.png").code == 0
    monkeypatch.setitem(AXES, "rooms", Axis("rooms", (4, 8)))
    monkeypatch.setitem(AXES, "modes", Axis("modes", ("serendipity",), {"rooms": 4}))
    assert run("bench --scaling rooms,modes --seeds 2 -o s.csv --plot s.svg").code == 0
    assert Path("b.png").read_bytes().startswith(b"\x89PNG")
    assert "<svg" in Path("s.svg").read_text()
    measured = [(row["domain"], row["task"]) for row in rows_of(Path("s.csv"))]
    assert measured == [("rooms", "4")] * 2 + [("rooms", "8")] * 2 + [("modes", "serendipity")] * 2


def test_a_suite_is_measured_and_its_tables_are_printed_again(run: Runs) -> None:
    for name in ("flights", "parcels"):
        shutil.copytree(DATA / name, Path("suite") / name)
    words = "bench suite --modes individual,serendipity --contenders search --domains parcels"
    first = run(f"{words} --time-limit 10 -o rows.csv")
    assert first.code == 0
    assert "Calls decided: search." in first.out
    assert [row["status"] for row in rows_of(Path("rows.csv"))] == ["optimal", "optimal"]
    again, printed = run("bench rows.csv"), run("bench rows.csv --markdown")
    assert (again.code, printed.code) == (0, 0)
    assert first.out.endswith(again.out)
    assert "| domain | tasks | human's plan | individual | serendipity |\n| --- |" in printed.out
    assert "| parcels | 1 | 1 | 1 | 1 |" in printed.out


def test_optima_of_a_suite_that_differ_are_an_error(run: Runs) -> None:
    rows = [
        BenchRow("d", "t", "h", "r", True, "individual", 0.9, name, Outcome("optimal", cost))
        for name, cost in (("search", 1.0), ("fast-downward", 2.0))
    ]
    Path("rows.csv").write_text(str(written(as_table(rows), "csv")))
    done = run("bench rows.csv")
    assert done.code == 2
    assert "Calls decided" in done.out
    assert (
        done.err == "Error: d t, individual at 0.9: the proved optima differ: search 1.0, fast-downward 2.0\n"
    )


def test_coverage_over_time_is_drawn(run: Runs) -> None:
    pytest.importorskip("matplotlib")
    row = BenchRow(
        "d", "t", "h", "r", True, "individual", 0.9, "search", Outcome("optimal", 1.0, seconds=0.5)
    )
    Path("rows.csv").write_text(str(written(as_table([row]), "csv")))
    assert run("bench rows.csv --plot over.svg").code == 0
    assert "<svg" in Path("over.svg").read_text()


def test_an_interrupted_suite_leaves_what_was_measured(run: Runs, monkeypatch: pytest.MonkeyPatch) -> None:
    asked = iter(("optimal", "failed"))

    def answer(call: Call) -> Outcome:
        status = next(asked)
        if status == "failed":
            signal.raise_signal(signal.SIGINT)
        return Outcome(status, 1.0)

    monkeypatch.setitem(SUITE_CONTENDERS, "search", Contender(answer))
    shutil.copytree(DATA / "flights", "suite/flights")
    done = run("bench suite --contenders search -o rows.csv")
    assert done.code == 130
    assert "Calls decided" in done.out
    assert [row["status"] for row in rows_of(Path("rows.csv"))] == ["optimal"]


@pytest.mark.skipif(fast_downward.absent() is not None, reason=fast_downward.absent() or "")
def test_scorpion_is_a_contender_where_its_program_is_given(run: Runs) -> None:
    shutil.copytree(DATA / "flights", "suite/flights")
    Path("other").write_text("#!/bin/sh\necho 'no such search'\nexit 1\n")
    words = "bench suite --modes individual --contenders scorpion --scorpion other"
    assert run(words).err == "Error: scorpion: other is no program\n"
    assert run("bench --scorpion other").err == "Error: --scorpion: is for suites of domains only\n"
    Path("other").chmod(0o755)
    told = "scorpion: the search failed: no such search"
    assert run(words).err == f"Warning: scorpion fails on flights flights, individual: {told}\n"
