"""What stands in a record is not done again, and a line that a kill has cut off is done anew."""

from collections.abc import Callable
from pathlib import Path

import pytest

from serendipity.evaluation.measuring.record import measured
from serendipity.model.errors import InputError


def squares(seen: list[int]) -> Callable[[int], int]:
    def work(job: int) -> int:
        seen.append(job)
        return job * job

    return work


def test_a_record_goes_on_where_it_was_stopped(tmp_path: Path) -> None:
    file, seen = tmp_path / "record.jsonl", list[int]()
    assert dict(measured(range(3), squares(seen), file)) == {0: 0, 1: 1, 2: 4}
    file.write_bytes(file.read_bytes()[:-4])  # the line of job 2 is cut off
    assert dict(measured(range(4), squares(seen), file)) == {0: 0, 1: 1, 2: 4, 3: 9}
    assert seen == [0, 1, 2, 2, 3]


def test_processes_do_the_same(tmp_path: Path) -> None:
    file = tmp_path / "record.jsonl"
    for _ in range(2):
        assert sorted(measured([-1, 2, -3], abs, file, processes=2)) == [(-3, 3), (-1, 1), (2, 2)]
    assert len(file.read_text().splitlines()) == 3


def test_another_file_is_refused(tmp_path: Path) -> None:
    file = tmp_path / "record.jsonl"
    file.write_text("seconds,answer\n1,2\n")
    with pytest.raises(InputError, match="a record of what was measured"):
        list(measured([1], abs, file))
