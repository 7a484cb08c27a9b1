"""Reports as text and as JSON, which says what it was made of; rows as CSV, JSON lines and Parquet."""

import json
import math
import sys
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

import serendipity
from serendipity.evaluation.benchmark.contenders import Outcome
from serendipity.evaluation.benchmark.rows import BenchRow, as_table, read_rows
from serendipity.model.json_text import json_text
from serendipity.model.table import Table
from serendipity.writing.rows import FORMATS
from serendipity.writing.rows import written as written_as
from tests.cli.conftest import Runs, assert_one_line
from tests.writing.reading import rows_of


def test_an_explanation_says_the_same_in_both(run: Runs) -> None:
    shown = run("explain --example room2 --discount 0.6")
    assert (shown.code, shown.err) == (0, "")
    data = json.loads(run("explain --example room2 --discount 0.6 --format json").out)
    assert data["schema"] == "serendipity.explanation/1"
    lines = [line.strip() for line in shown.out.splitlines() if line.startswith("  ")]
    assert lines == [sentence["text"] for sentence in data["sentences"]]
    topics = [line for line in shown.out.splitlines() if line and not line.startswith(" ")]
    assert topics == list(dict.fromkeys(sentence["topic"] for sentence in data["sentences"]))
    assert data["break_even_discount"]["exact"] == "1/2"
    assert (data["human_part"], data["robot_part"], data["cost"]) == (11, 1.6, 12.6)


def test_a_result_is_explained(run: Runs) -> None:
    assert run("plan --example room7 --discount 0.6 -o answer.json").code == 0
    from_file = run("explain --example room7 answer.json")
    assert from_file.code == 0
    assert from_file.out == run("explain --example room7 --discount 0.6").out


def test_a_doctored_result_is_refused(run: Runs, answer: dict[str, object]) -> None:
    assert_one_line(run("explain --example room2 help.json --discount 0.6"), "got both")
    Path("help.json").write_text(json.dumps(answer | {"cost": 12}))
    assert_one_line(run("explain --example room2 help.json"), "help.json", "no answer to this task")


@pytest.fixture
def room5(run: Runs) -> Runs:
    """Run command lines where ``help.json`` answers the example room5."""
    assert run("plan --example room5 --discount 0.9 -o help.json").code == 0
    return run


def test_a_simulation_tells_the_story(room5: Runs) -> None:
    text = room5("simulate --example room5 help.json").out
    assert "epoch 5\n  commx: move_reverse commx hall5 room5" in text
    assert text.splitlines()[-1].startswith("not realised with the observant human")


def test_a_simulation_holds_every_epoch(room5: Runs) -> None:
    trace = json.loads(room5("simulate --example room5 help.json --human-model local --format json").out)
    assert trace["schema"] == "serendipity.trace/1"
    assert trace["realised"] is False
    assert [epoch["epoch"] for epoch in trace["epochs"]] == list(range(1, 14))
    assert trace["promised_cost"] == 11.5


def test_the_front_on_the_command_line(run: Runs) -> None:
    asked = "front --example flights --discount 0.9 --disturbance "
    shown = run(f"{asked} ask=1 --format json --picture front.svg")
    assert (shown.code, '"schema": "serendipity.front/1"' in shown.out) == (0, True)
    assert "ask 1, meet 0, sight 0" in run(f"{asked} ask=1").out


def test_the_front_over_goals_on_the_command_line(run: Runs) -> None:
    Path("goals.txt").write_text("0.5: conducted_triage commx room1\n0.5: at commx hall1\n")
    asked = "front --example room2 --discount 0.9"
    shown = run(f"{asked} --goals goals.txt --verify --format csv")
    assert (shown.code, shown.out.count("proved")) == (0, 2)
    regret = run(f"{asked} --goals goals.txt --risk regret")
    assert regret.out.startswith("commx alone: greatest regret ")


scalars = (
    st.none() | st.booleans() | st.integers() | st.floats(allow_nan=False, allow_infinity=False) | st.text()
)
values = st.recursive(
    scalars, lambda inner: st.lists(inner) | st.dictionaries(st.text(), inner), max_leaves=5
)


@given(st.dictionaries(st.text(), values, max_size=3))
def test_it_reads_as_it_was(value: dict[str, object]) -> None:
    assert json.loads(json_text(value)) == value


@pytest.mark.parametrize(
    ("value", "error"), [(math.nan, ValueError), ([-math.inf], ValueError), ({1}, TypeError)]
)
def test_what_is_no_json_is_not_written(value: object, error: type[Exception]) -> None:
    with pytest.raises(error):
        json_text({"a": value})


def saved(run: Runs, command: str, table: Table) -> dict[str, list[tuple[object, ...]]]:
    """The rows of a command in each format that can be written here."""
    found = {}
    for form in FORMATS:
        done = run(f"{command} -o rows.{form}")
        if form == "parquet" and "Parquet needs" in done.err:
            continue
        assert (done.code, done.err) == (0, "")
        content = Path(f"rows.{form}").read_bytes()
        found[form] = rows_of(content if form == "parquet" else content.decode(), form, table)
    return found


def test_interruptions(run: Runs) -> None:
    report = serendipity.interruptions(serendipity.example("room2"), discount=0.6)
    written = saved(run, "interruptions --example room2 --discount 0.6", report.table())
    empty = [tuple(None if cell == "" else cell for cell in row) for row in report.table().rows]
    assert written.pop("csv") == empty
    assert all(rows == list(report.table().rows) for rows in written.values())
    told = report.to_dict()["windows"]
    assert [row[0] for row in report.table().rows] == [window["window"]["start"] for window in told]


def test_recognise(run: Runs) -> None:
    Path("goals").write_text("1: conducted_triage commx room1\n1: conducted_triage commx room2\n")
    found = serendipity.recognise(serendipity.example("room2"), "goals")
    written = saved(run, "recognise --example room2 --goals goals", found.table())
    assert all(rows == list(found.table().rows) for rows in written.values())
    assert [row[4] for row in found.table().rows] == [goal.posterior for goal in found.goals]


def test_execute(run: Runs) -> None:
    command = "execute --example room2 --discount 0.6 --human noisy:0.2 --runs 3 --seed 4"
    runs = serendipity.execute(serendipity.example("room2"), "noisy:0.2", discount=0.6, runs=3, seed=4)
    clock = list(runs.table().columns).index("slowest")
    for rows in saved(run, command, runs.table()).values():
        without = [row[:clock] + row[clock + 1 :] for row in rows]
        assert without == [row[:clock] + row[clock + 1 :] for row in runs.table().rows]


def test_reproduce(run: Runs) -> None:
    serendipity.generate_usar("suite/test1", preset="room2")
    command = "reproduce suite --modes serendipity,individual --discounts 0.6,1/3 --journal done"
    run(f"{command} -o all.json")
    told = [tuple(row.values()) for row in json.loads(Path("all.json").read_text())["rows"]]
    table = serendipity.reproduce(
        "suite", modes=["serendipity", "individual"], discounts=["0.6", "1/3"], journal="done"
    ).table()
    assert list(table.rows) == told
    written = saved(run, command, table)
    assert written.pop("csv") == [(*row[:7], round(row[7], 6), *row[8:]) for row in told]
    assert all(rows == told for rows in written.values())


def test_bench_of_a_suite(run: Runs) -> None:
    said = [
        Outcome("optimal", 12.6, lower_bound=12.6, seconds=0.25, reason="+1"),
        Outcome("unknown", None, reason="=time-limit, first"),
    ]
    asked = {"domain": "d", "task": "t", "human": "h", "robots": "r1 r2", "alone": True, "discount": 0.9}
    rows = [BenchRow(**asked, mode="individual", contender="search", outcome=each) for each in said]
    table = as_table(rows)
    Path("suite.csv").write_text(str(written_as(table, "csv")))
    for found in saved(run, "bench suite.csv --quiet", table).values():
        assert found == list(table.rows)
    assert read_rows(Path("rows.csv")) == rows


@pytest.mark.parametrize("command", ["interruptions", "execute"])
def test_rows_go_to_stdout_but_parquet_does_not(command: str, run: Runs) -> None:
    done = run(f"{command} --example room2 --format jsonl")
    assert all(isinstance(json.loads(line), dict) for line in done.out.splitlines())
    assert_one_line(run(f"{command} --example room2 --format parquet"), "--format: parquet", "-o FILE")


@pytest.mark.parametrize(
    "words", ["execute --example room2", "reproduce suite", "bench", "recognise --goals none none"]
)
def test_parquet_without_a_library_is_one_line(
    words: str, run: Runs, monkeypatch: pytest.MonkeyPatch
) -> None:
    for name in ("polars", "pyarrow"):
        monkeypatch.setitem(sys.modules, name, None)
    assert_one_line(
        run(f"{words} -o rows.parquet"), "Parquet needs polars or pyarrow", "serendipity-planner[data]"
    )
    assert not Path("rows.parquet").exists()
