"""``serendipity bench`` measures contenders on the same calls and writes every timing."""

import csv
import shutil
import signal
from dataclasses import replace
from pathlib import Path

import pytest

from serendipity.classical import fast_downward
from serendipity.evaluation.benchmark.contenders import Contender, Outcome
from serendipity.evaluation.benchmark.coverage import CONTENDERS as SUITE_CONTENDERS
from serendipity.evaluation.benchmark.coverage import Call
from serendipity.evaluation.benchmark.rows import Row, as_table
from serendipity.evaluation.benchmark.scaling import AXES, Axis
from serendipity.evaluation.benchmark.side_by_side import CONTENDERS
from serendipity.scenarios.examples import DATA
from serendipity.writing.rows import written
from tests.cli.conftest import Runs


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
        Row("d", "t", "h", "r", True, "individual", 0.9, name, Outcome("optimal", cost))
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
    row = Row("d", "t", "h", "r", True, "individual", 0.9, "search", Outcome("optimal", 1.0, seconds=0.5))
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
