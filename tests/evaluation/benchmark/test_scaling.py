"""Scaling series: every task in a process of its own, tables, exponents."""

from dataclasses import replace

import pytest

from serendipity import UsageError, generate_usar, load, plan
from serendipity.evaluation.benchmark.contenders import Outcome
from serendipity.evaluation.benchmark.rows import Row
from serendipity.evaluation.benchmark.scaling import AXES, Axis, exponents, scale, scaling_table

SMALL = Axis("rooms", (4, 8))
MEASURED = Axis("length", fixed={"rooms": 8})


@pytest.mark.long
def test_a_sample_is_the_planners_answer(
    monkeypatch: pytest.MonkeyPatch, tmp_path_factory: pytest.TempPathFactory
) -> None:
    monkeypatch.setitem(AXES, "rooms", SMALL)
    found = list(scale(["rooms"], seeds=2))
    assert [(row.domain, row.task) for row in found] == [("rooms", value) for value in "4488"]
    for row, seed in zip(found, (0, 1, 0, 1), strict=True):
        sample, folder = row.outcome, tmp_path_factory.mktemp("task")
        generate_usar(folder, rooms=int(row.task), seed=seed)  # too few rooms for a cycle
        task = load(folder)
        answer = plan(task, discount="0.9")
        assert (sample.cost, sample.actions) == (answer.cost, len(task.actions))
        assert sample.length == len(answer.human_plan or ())
        assert sample.proved
        assert sample.memory > 5
        assert min(sample.read_seconds, sample.prepare_seconds, sample.again_seconds or 0) > 0
        assert sample.seconds > sample.prepare_seconds


@pytest.mark.long
def test_a_measured_axis_has_the_length_of_his_plan(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(AXES, "length", MEASURED)
    found = list(scale(["length"], seeds=1))
    assert all(row.task == str(max(1, row.outcome.length)) for row in found)
    assert len({row.task for row in found}) > 1


def test_an_unknown_axis() -> None:
    with pytest.raises(UsageError, match="width"):
        list(scale(["rooms", "width"]))


def sample(value: object, seconds: float, memory: float = 20.0, *, axis: str = "rooms") -> Row:
    times = {"seconds": seconds + 1, "read_seconds": 1.0, "prepare_seconds": 1.0, "again_seconds": seconds}
    outcome = Outcome("optimal", 1.0, memory=memory, **times)
    return Row(axis, str(value), "", "", True, "serendipity", 0.9, "search", outcome)


def test_exponents_are_those_of_the_samples() -> None:
    found = [sample(x, 0.001 * x**2, 20 * x) for x in (10, 20, 40)]
    assert exponents(found).rows == [["rooms", "2.00 +- 0.00", "0.00 +- 0.00", "1.00 +- 0.00"]]
    found[-1] = replace(found[-1], outcome=replace(found[-1].outcome, status="feasible"))
    assert exponents(found).rows[0][1] == ">= 2.00 +- 0.00"


def test_axes_without_numbers_have_no_exponent() -> None:
    modes = ("individual", "serendipity", "communication")
    found = [sample(mode, 1.0, axis="modes") for mode in modes]
    assert not exponents(found).rows
    assert [row[:4] for row in scaling_table(found).rows] == [["modes", mode, "1", "1"] for mode in modes]


def test_lengths_are_shown_in_quarters() -> None:
    found = [sample(x, float(x), axis="length") for x in range(8, 0, -1)]
    assert [row[1] for row in scaling_table(found).rows] == ["1-2", "3-4", "5-6", "7-8"]
