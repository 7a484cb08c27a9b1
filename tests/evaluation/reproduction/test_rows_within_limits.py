"""What a limit leaves open is said to be so, and done again by the next run."""

from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

import serendipity
from serendipity import Deadline, UsageError
from serendipity.evaluation.reproduction import Reproduction, Row
from serendipity.evaluation.reproduction.tables import Tables, as_json

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
