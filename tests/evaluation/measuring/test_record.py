"""What stands in a record is not done again; fits and memory are as exact as what was measured.

A line of a record that a kill has cut off is done anew.
"""

from collections.abc import Callable
from pathlib import Path

import pytest

from serendipity.evaluation.measuring.figures import peak_memory, percentile, power_law
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


def test_a_power_is_found_exactly() -> None:
    xs = (1, 10, 100, 250)
    fit = power_law(xs, [3 * x**1.5 for x in xs])
    assert fit is not None
    assert fit.exponent == pytest.approx(1.5)
    assert fit.factor == pytest.approx(3)
    assert fit.error == pytest.approx(0, abs=1e-6)


@pytest.mark.parametrize("xs", [[], [1, 2], [3, 3, 3]])
def test_too_little_to_fit(xs: list[float]) -> None:
    assert power_law(xs, range(1, len(xs) + 1)) is None


def test_peak_memory_grows_with_what_is_held() -> None:
    before = peak_memory()
    held = b"x" * int((before + 32) * 2**20)  # more than there ever was
    assert peak_memory() > before + 16
    del held


def test_percentiles_are_values_that_are_there() -> None:
    assert [percentile([3, 1, 2], share) for share in (0, 0.5, 0.95, 1)] == [1, 2, 3, 3]
    assert percentile(range(1, 101), 0.95) == 96
