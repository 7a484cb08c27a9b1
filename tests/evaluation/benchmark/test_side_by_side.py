"""Contenders on the same calls: warm-up, medians, disagreements, ratios.

And scaling series: every task in a process of its own, tables, exponents.
"""

from dataclasses import replace

import pytest

from search import PreparedTask
from serendipity import UsageError, example, generate_usar, load, plan
from serendipity.evaluation.benchmark.contenders import Contender, Outcome
from serendipity.evaluation.benchmark.rows import BenchRow
from serendipity.evaluation.benchmark.scaling import AXES, Axis, exponents, scale, scaling_table
from serendipity.evaluation.benchmark.side_by_side import CONTENDERS, measure, ratios, times
from serendipity.evaluation.measuring import figures
from serendipity.model import Options
from serendipity.model.errors import DisagreementError
from serendipity.model.telling import Grid


class Scripted:
    """A contender that takes given times."""

    def __init__(self, *seconds: float, cost: float = 1.0, status: str = "optimal") -> None:
        self.seconds = list(seconds)
        self.cost = cost
        self.status = status

    def __call__(self, prepared: PreparedTask, options: Options) -> Outcome:
        return Outcome(self.status, self.cost, seconds=self.seconds.pop(0))


def timings(monkeypatch: pytest.MonkeyPatch, **contenders: Scripted) -> list[BenchRow]:
    for name, contender in contenders.items():
        monkeypatch.setitem(CONTENDERS, name, Contender(contender))
    return list(measure([example("room2")], ["serendipity"], ["0.6"], contenders, repeat=3))


def test_the_first_call_warms_up(monkeypatch: pytest.MonkeyPatch) -> None:
    (timing,) = timings(monkeypatch, search=Scripted(0.9, 0.2, 0.1, 0.3))
    of = timing.outcome
    assert (of.fastest, of.seconds, of.slowest, of.repeats) == (0.1, 0.2, 0.3, 3)


def test_a_slow_call_is_made_once(monkeypatch: pytest.MonkeyPatch) -> None:
    (timing,) = timings(monkeypatch, search=Scripted(1.5))
    assert (timing.outcome.seconds, timing.outcome.repeats) == (1.5, 1)


def test_proved_answers_that_differ_are_an_error(monkeypatch: pytest.MonkeyPatch) -> None:
    with pytest.raises(DisagreementError, match=r"search 1\.0, other 2\.0"):
        timings(monkeypatch, search=Scripted(2), other=Scripted(2, cost=2.0))


def test_an_unproved_answer_may_differ(monkeypatch: pytest.MonkeyPatch) -> None:
    found = timings(monkeypatch, search=Scripted(2), other=Scripted(2, cost=2.0, status="feasible"))
    assert [timing.outcome.proved for timing in found] == [True, False]


def test_calls_that_a_contender_cannot_answer_are_left_out() -> None:
    modes = ["composite", "composite-inf"]
    found = measure([example("room2")], modes, ["0.6"], ["search", "paper"], repeat=1, time_limit=0.1)
    assert [(t.mode, t.contender) for t in found] == [
        ("composite", "search"),
        ("composite", "paper"),
        ("composite-inf", "search"),
    ]


def test_unknown_names() -> None:
    for modes, contenders, what in ((["x"], ["search"], "modes"), (["serendipity"], ["x"], "contenders")):
        with pytest.raises(UsageError, match=what):
            list(measure([], modes, ["0"], contenders))


KEPT = {
    "search": [["0"], ["0"], ["0"], ["1/2"], ["1/2"], ["1/2"]],
    "in-turn": [["0"], ["0", "1/2"]] * 3,
    "again": [["0"] * n for n in (1, 2, 3)] + [["0"] * 3 + ["1/2"] * n for n in (1, 2, 3)],
}
"""Each call, and those before it on the same prepared task: a warm-up and two repetitions."""


@pytest.mark.parametrize("name", KEPT)
def test_what_earlier_calls_leave_behind(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    found = []
    asked: list[tuple[PreparedTask, list[str]]] = []

    def answer(prepared: PreparedTask, options: Options) -> Outcome:
        kept = next((calls for known, calls in asked if known is prepared), None)
        if kept is None:
            kept = []
            asked.append((prepared, kept))
        kept.append(str(options.discount))
        found.append(list(kept))
        return Outcome("optimal", 1.0, seconds=0.1)

    monkeypatch.setitem(CONTENDERS, name, replace(CONTENDERS[name], answer=answer))
    timings = list(measure([example("room2")], ["serendipity"], ["0", "0.5"], [name], repeat=2))
    assert found == KEPT[name]
    assert [(timing.discount, timing.outcome.repeats) for timing in timings] == [(0, 2), (0.5, 2)]


def timing(task: str, contender: str, seconds: float, status: str = "optimal") -> BenchRow:
    outcome = Outcome(status, 1.0, seconds=seconds, fastest=seconds, slowest=seconds)
    return BenchRow("", task, "", "", True, "composite", 0.0, contender, outcome)


def rows_of(grid: Grid) -> list[dict[str, str]]:
    return [dict(zip(grid.header, row, strict=True)) for row in grid.rows]


def test_ratios_are_call_by_call() -> None:
    calls = [("a", 0.1, 0.2), ("b", 0.2, 1.0), ("c", 0.4, 1.6)]
    found = [timing(name, "search", own) for name, own, _ in calls]
    found += [timing(name, "other", theirs) for name, _, theirs in calls]
    (row,) = rows_of(ratios(found))
    assert (row["contender"], row["over"], row["calls"]) == ("other", "search", "3")
    assert (row["of medians"], row["of 95 %"]) == ("5.00 x", "4.00 x")
    assert (row["least"], row["call by call: 50 %"], row["95 %"]) == ("2.00 x", "4.00 x", "5.00 x")
    row = rows_of(times(found))[1]
    assert (row["median"], row["95 %"], row["longest"]) == ("1000.00 ms", "1600.00 ms", "1600.00 ms")
    assert row["min-max"] == "200.00-1600.00 ms"


def test_figures_that_a_limit_made_too_small_are_marked() -> None:
    """Three of four calls end: only what the fourth one's time decides is uncertain."""
    found = [timing(name, "search", 0.1) for name in "abcd"]
    found += [timing(name, "other", seconds) for name, seconds in zip("abc", (1, 2, 3), strict=True)]
    found.append(timing("d", "other", 10.0, status="unknown"))
    (row,) = rows_of(ratios(found))
    assert (row["of medians"], row["of 95 %"]) == ("30 x", ">= 100 x")
    assert (row["call by call: 50 %"], row["95 %"], row["least"]) == ("30 x", ">= 100 x", "10 x")
    row = rows_of(times(found))[1]
    assert (row["proved"], row["median"], row["longest"]) == ("3", "3000.00 ms", ">= 10000.00 ms")


def test_calls_that_the_search_did_not_prove_are_no_base() -> None:
    found = [timing("a", "search", 0.1), timing("b", "search", 0.1, status="feasible")]
    found += [timing("a", "other", 0.2), timing("b", "other", 9.0)]
    (row,) = rows_of(ratios(found))
    assert (row["calls"], row["95 %"]) == ("1 of 2", "2.00 x")
    (row,) = rows_of(ratios([found[1], found[3]]))
    assert (row["calls"], row["95 %"]) == ("0 of 1", "")


def test_what_a_solver_works_counts_though_it_is_a_process_of_its_own(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(figures, "children_seconds", iter((10.0, 110.0)).__next__)
    answer = CONTENDERS["automata"].answer(PreparedTask(example("room2")), Options(discount="0.6"))
    assert answer.cost == 12.6
    assert answer.seconds > 100


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


def sample(value: object, seconds: float, memory: float = 20.0, *, axis: str = "rooms") -> BenchRow:
    times = {"seconds": seconds + 1, "read_seconds": 1.0, "prepare_seconds": 1.0, "again_seconds": seconds}
    outcome = Outcome("optimal", 1.0, memory=memory, **times)
    return BenchRow(axis, str(value), "", "", True, "serendipity", 0.9, "search", outcome)


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
