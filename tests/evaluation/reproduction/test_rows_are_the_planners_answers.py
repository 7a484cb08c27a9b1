"""However a suite is run, its rows are what ``plan`` answers.

What a limit leaves open is said to be so, and done again by the next run.
"""

import pickle
import tracemalloc
from dataclasses import replace
from fractions import Fraction
from gc import collect
from pathlib import Path
from typing import Any

import pytest

import serendipity
from serendipity import Deadline, UsageError
from serendipity.evaluation.reproduction import COLUMNS, Progress, Reproduction, Row, reproduce
from serendipity.evaluation.reproduction import run as run_module
from serendipity.evaluation.reproduction.packed import PackedRows
from serendipity.evaluation.reproduction.suite import TaskFolder
from serendipity.evaluation.reproduction.tables import Tables, as_json, table_1
from serendipity.evaluation.reproduction.work import Assignment, Call, TaskRows, unknown
from serendipity.model import Window
from serendipity.pddl.write import write_pddl
from serendipity_testing.builders import task as build
from tests.evaluation.reproduction.conftest import PRESETS

MODES = ("individual", "serendipity", "communication")
DISCOUNTS = ("0.6", "0.9")
CALLS = ("0", "0.3", "0.5", "0.7", "0.9")


def folder(number: int) -> TaskFolder:
    return TaskFolder(str(number), Path(f"test{number}"), f"{number:x}")


def numbered(assignment: Assignment) -> TaskRows:
    """Rows of which no two have the same cost."""
    test, first = assignment.task.test, int(assignment.task.test) * len(CALLS)
    rows = (
        replace(unknown(test, call), status="optimal", cost=Fraction(first + i, 4), seconds=0.1 + i)
        for i, call in enumerate(assignment.calls)
    )
    return TaskRows(test, assignment.task.fingerprint, tuple(rows))


def without_times(run: Reproduction) -> list[dict[str, Any]]:
    return [row.to_dict() | {"seconds": None} for row in run.rows]


@pytest.fixture(scope="module")
def run(suite: Path) -> Reproduction:
    return reproduce(suite, modes=MODES, discounts=DISCOUNTS)


def test_tasks_of_a_suite_have_names_of_their_own(tmp_path: Path) -> None:
    """A folder is called by its number, unless another one is: both had the rows of one name."""
    for name, preset in (("test1", "room2"), ("1", "room7"), ("test2", "room5"), ("testbed", "room5")):
        serendipity.generate_usar(tmp_path / name, preset=preset)
    run = reproduce(tmp_path, modes=["individual"], discounts=["0.6"])
    costs = {row.test: row.cost for row in run.rows}
    assert sorted(costs) == ["1", "2", "test1", "testbed"]
    assert costs["1"] == serendipity.plan(serendipity.example("room7"), mode="individual").cost
    assert costs["test1"] == serendipity.plan(serendipity.example("room2"), mode="individual").cost


def test_rows_are_the_answers_in_order(run: Reproduction) -> None:
    expected = []
    for number, preset in enumerate(PRESETS, start=1):
        task = serendipity.example(preset)
        for mode in MODES:
            for discount in DISCOUNTS:
                result = serendipity.plan(task, mode=mode, discount=discount)
                expected.append((str(number), mode, Fraction(discount), result.cost, result.window))
    found = [
        (row.test, row.mode, row.discount, None if row.cost is None else float(row.cost), row.window)
        for row in run.rows
    ]
    assert found == expected


@pytest.mark.long
def test_processes_give_the_same_rows(suite: Path, run: Reproduction) -> None:
    assert without_times(reproduce(suite, modes=MODES, discounts=DISCOUNTS, jobs=2)) == without_times(run)


def test_a_batch_takes_no_more_memory_the_longer_it_runs(monkeypatch: pytest.MonkeyPatch) -> None:
    """It grew by half a KiB for each row."""
    monkeypatch.setattr(run_module, "find_tasks", lambda _: tuple(map(folder, range(500))))
    monkeypatch.setattr(run_module, "solve", numbered)
    taken: dict[int, int] = {}

    def look(progress: Progress) -> None:
        if progress.done in (300, 500):
            collect()
            taken[progress.done], _ = tracemalloc.get_traced_memory()

    tracemalloc.start()
    try:
        rows = reproduce("suite", modes=["serendipity"], discounts=CALLS, on_progress=look).rows
    finally:
        tracemalloc.stop()
    assert taken[500] - taken[300] < 100_000, "for 1,000 rows"
    assert [row.cost for row in rows] == [Fraction(n, 4) for n in range(2500)]


def test_rows_are_as_they_were_put() -> None:
    """Where their bytes don't say all of them, too."""
    tasks, calls = [folder(0)], [Call("serendipity", Fraction(n)) for n in range(4)]
    rows, odd = PackedRows(tasks, calls), Fraction(10**20 + 1, 3 * 10**15)
    none = [unknown("0", call) for call in calls]
    assert [*rows] == none
    done = replace(none[0], status="optimal", cost=odd, human_cost=Fraction(1, 3), window=Window(2, 5))
    broken = replace(none[2], status="error", reason="why")
    rows.put(TaskRows("0", tasks[0].fingerprint, (done, none[1], broken)))
    rows.put(TaskRows("0", "another", tuple(none)))
    rows.put(TaskRows("0", tasks[0].fingerprint, (none[0],)), proved=True)
    assert rows[:] == (done, none[1], broken, none[3])
    assert rows[-1] == none[3]
    assert rows.missing(0) == (*calls[1:],)
    again = pickle.loads(pickle.dumps(rows))
    assert again == rows
    assert hash(again) == hash(rows)
    rows.put(TaskRows("0", tasks[0].fingerprint, (replace(done, cost=None),)))
    assert again != rows
    assert rows[0].cost is None


@pytest.mark.long
def test_a_dask_cluster_gives_the_same_rows(suite: Path, run: Reproduction) -> None:
    again = reproduce(suite, modes=MODES, discounts=DISCOUNTS, jobs=1, dask="local")
    assert without_times(again) == without_times(run)


def test_cells_stand_in_the_columns(run: Reproduction) -> None:
    assert tuple(run.table().columns) == COLUMNS
    lines = [row.cells() for row in run.rows]
    assert lines[2][:7] == ("1", "serendipity", "0.6", "12.6", "13.0", "6", "7")
    assert lines[2][8:] == ("optimal", "True", "12.6", "12.6", "")
    assert all(float(line[7]) > 0 for line in lines)


def test_progress_counts_tasks_and_opportunities(suite: Path) -> None:
    seen: list[Progress] = []
    reproduce(suite, modes=["serendipity"], discounts=["0.6"], on_progress=seen.append)
    assert [progress.done for progress in seen] == list(range(7))
    assert {progress.total for progress in seen} == {6}
    assert [progress.opportunities for progress in seen] == [0, 1, 1, 1, 2, 2, 2]


def test_means_and_counts_follow_the_ties(tmp_path: Path) -> None:
    """In room5 only some of the human's optimal plans pass by the medkit."""
    serendipity.generate_usar(tmp_path / "test1", preset="room5")
    run = reproduce(tmp_path, modes=["serendipity"], discounts=["0.9"])
    entries = {entry.variant: entry for entry in table_1(run)}
    task = serendipity.load(tmp_path / "test1")
    best = serendipity.plan(task, discount="0.9", ties="optimistic")
    worst = serendipity.plan(task, discount="0.9", ties="robust")
    for variant, answer in (("best", best), ("worst", worst)):
        entry = entries[f"serendipity, {variant} tie"]
        assert entry.mean_cost is not None
        assert float(entry.mean_cost) == answer.cost
        assert entry.improved == answer.opportunity


def test_the_worst_tie_is_the_dearest_answer(tmp_path: Path) -> None:
    """It was the dearest of those that the best tie had to look at: a list that ends early."""
    task = build(
        goal="done",
        actions={
            **{f"enter{k} h": f"-> on{k}" for k in range(5)},
            **{f"walk{k} h": f"on{k} -> past{k}" for k in range(5)},
            **{f"leave{k} h": f"past{k} -> done @ 3" for k in range(5)},
            **{f"quit{k} h": f"past{k} light -> done" for k in range(4)},
            "fetch r": "-> lamp",
            "help r": "lamp -> light",
        },
    )
    write_pddl(task, tmp_path / "test1")
    (row,) = reproduce(tmp_path, modes=["serendipity"], discounts=["0.9"]).rows
    assert (row.best_tie, row.worst_tie) == (Fraction("3.2"), Fraction(5))


SHORT: dict[str, Any] = {"modes": ["serendipity", "individual"], "discounts": ["0.6"]}


def answers(run: Reproduction) -> list[Row]:
    return [replace(row, seconds=0.0) for row in run.rows]


@pytest.mark.parametrize("jobs", [1, 2])
def test_rows_without_time_are_unknown(suite: Path, jobs: int) -> None:
    run = serendipity.reproduce(suite, **SHORT, time_limit=0, jobs=jobs)
    assert {row.status for row in run.rows} == {"unknown"}
    assert {(row.cost, row.best_tie, row.worst_tie, row.window) for row in run.rows} == {(None,) * 4}
    assert (run.unproved, run.complete) == (len(run.rows), False)
    assert as_json(run, Tables((), (), ()))["complete"] is False


def test_rows_without_memory_are_unknown(suite: Path) -> None:
    run = serendipity.reproduce(suite, **SHORT, memory_limit=1)
    assert {row.status for row in run.rows} == {"unknown"}


def test_a_limit_that_is_enough_changes_nothing(suite: Path) -> None:
    run = serendipity.reproduce(suite, **SHORT, time_limit=60, memory_limit=99999, deadline=Deadline(600))
    assert run.complete
    assert answers(run) == answers(serendipity.reproduce(suite, **SHORT))


def test_the_next_run_does_again_what_a_limit_left_open(suite: Path, tmp_path: Path) -> None:
    journal = tmp_path / "done.jsonl"
    late = serendipity.reproduce(suite, **SHORT, time_limit=0, journal=journal)
    again = serendipity.reproduce(suite, **SHORT, journal=journal)
    assert not late.complete
    assert answers(again) == answers(serendipity.reproduce(suite, **SHORT))


@pytest.mark.parametrize("jobs", [1, 2])
def test_a_run_ends_with_its_deadline(suite: Path, jobs: int, tmp_path: Path) -> None:
    journal = tmp_path / "done.jsonl"
    run = serendipity.reproduce(suite, **SHORT, jobs=jobs, deadline=Deadline(time_limit=0), journal=journal)
    assert [row.status for row in run.rows] == ["unknown"] * 12
    assert len(journal.read_text().splitlines()) == 1  # the rest was not begun


def test_limits_are_checked(suite: Path) -> None:
    with pytest.raises(UsageError, match="time_limit"):
        serendipity.reproduce(suite, **SHORT, time_limit=-1)
