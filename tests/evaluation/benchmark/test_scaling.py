"""Scaling series: every task in a process of its own, tables, exponents."""

from dataclasses import replace

import pytest

from serendipity import UsageError, generate_usar, load, plan
from serendipity.evaluation.benchmark.scaling import AXES, Axis, Sample, Size, exponents, scale, scaling_table

SMALL = Axis("rooms", "rooms", ((4, Size(rooms=4)), (8, Size(rooms=8))))
MEASURED = Axis("length", "actions", ((0, Size(rooms=8)),), measured=True)


def test_a_sample_is_the_planners_answer(
    monkeypatch: pytest.MonkeyPatch, tmp_path_factory: pytest.TempPathFactory
) -> None:
    monkeypatch.setitem(AXES, "rooms", SMALL)
    found = list(scale(["rooms"], seeds=2))
    assert [(s.value, s.rooms, s.seed) for s in found] == [(4, 4, 0), (4, 4, 1), (8, 8, 0), (8, 8, 1)]
    for sample in found:
        folder = tmp_path_factory.mktemp("task")
        generate_usar(folder, rooms=sample.rooms, seed=sample.seed)  # too few rooms for a cycle
        task = load(folder)
        answer = plan(task, discount="0.9")
        assert (sample.cost, sample.actions) == (answer.cost, len(task.actions))
        assert sample.length == len(answer.human_plan or ())
        assert sample.proved
        assert sample.memory > 5
        assert min(sample.read_seconds, sample.pack_seconds, sample.search_seconds) > 0


def test_a_measured_axis_has_the_length_of_his_plan(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(AXES, "length", MEASURED)
    found = list(scale(["length"], seeds=1))
    assert all(sample.value == max(1, sample.length) for sample in found)
    assert len({sample.value for sample in found}) > 1


def test_an_unknown_axis() -> None:
    with pytest.raises(UsageError, match="width"):
        list(scale(["rooms", "width"]))


def sample(value: float, seconds: float, *, axis: str = "rooms", status: str = "optimal") -> Sample:
    size = (21, 2, 1, None, "serendipity", "0.9", 0, 100, 9)
    return Sample(axis, value, *size, 1.0, 1.0, seconds, seconds, 20 * value, status, 1.0, 5)


def test_exponents_are_those_of_the_samples() -> None:
    found = [sample(x, 0.001 * x**2) for x in (10, 20, 40)]
    assert exponents(found).rows == [["rooms", "2.00 +- 0.00", "0.00 +- 0.00", "1.00 +- 0.00"]]
    found[-1] = replace(found[-1], status="feasible")
    assert exponents(found).rows[0][1] == ">= 2.00 +- 0.00"


def test_axes_without_numbers_have_no_exponent() -> None:
    found = [sample(i, 1.0, axis="modes") for i in range(3)]
    assert not exponents(found).rows
    assert [row[:4] for row in scaling_table(found).rows] == [
        ["modes", mode, "1", "1"] for mode in ("individual", "serendipity", "communication")
    ]


def test_lengths_are_shown_in_quarters() -> None:
    found = [sample(x, float(x), axis="length") for x in range(8, 0, -1)]
    assert [row[1] for row in scaling_table(found).rows] == ["1-2", "3-4", "5-6", "7-8"]
