"""``serendipity reproduce`` on the command line."""

import json
import re
from pathlib import Path

import pytest

import serendipity
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
