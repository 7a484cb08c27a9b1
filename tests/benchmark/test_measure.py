"""Contenders on the same calls: warm-up, medians, disagreements, ratios."""

from dataclasses import replace

import pytest

from serendipity import Task, UsageError, example
from serendipity.benchmark import CONTENDERS, HEADER, Contender, Timing, measure, summary
from serendipity.benchmark.answer import Answer
from serendipity.model import Options


class Scripted:
    """A contender that takes given times."""

    def __init__(self, *seconds: float, cost: float = 1.0, status: str = "optimal") -> None:
        self.seconds = list(seconds)
        self.cost = cost
        self.status = status

    def __call__(self, task: Task, options: Options) -> Answer:
        return Answer(self.seconds.pop(0), self.status, self.cost)


def timings(monkeypatch: pytest.MonkeyPatch, **contenders: Scripted) -> list[Timing]:
    for name, contender in contenders.items():
        monkeypatch.setitem(CONTENDERS, name, Contender(contender))
    return list(measure([example("room2")], ["serendipity"], ["0.6"], contenders, repeat=3))


def test_the_first_call_warms_up(monkeypatch: pytest.MonkeyPatch) -> None:
    (timing,) = timings(monkeypatch, search=Scripted(0.9, 0.2, 0.1, 0.3))
    assert (timing.fastest, timing.seconds, timing.slowest, timing.repeats) == (0.1, 0.2, 0.3, 3)


def test_a_slow_call_is_made_once(monkeypatch: pytest.MonkeyPatch) -> None:
    (timing,) = timings(monkeypatch, search=Scripted(1.5))
    assert (timing.seconds, timing.repeats) == (1.5, 1)


def test_proved_answers_that_differ_are_an_error(monkeypatch: pytest.MonkeyPatch) -> None:
    with pytest.raises(UsageError, match=r"search 1\.0, other 2\.0"):
        timings(monkeypatch, search=Scripted(2), other=Scripted(2, cost=2.0))


def test_an_unproved_answer_may_differ(monkeypatch: pytest.MonkeyPatch) -> None:
    found = timings(monkeypatch, search=Scripted(2), other=Scripted(2, cost=2.0, status="feasible"))
    assert [timing.solved for timing in found] == [True, False]


def test_calls_that_a_contender_cannot_answer_are_left_out() -> None:
    modes = ["composite", "composite-inf"]
    found = measure([example("room2")], modes, ["0.6"], ["search", "paper"], repeat=1, time_limit=0.1)
    assert [(t.mode, t.contender) for t in found] == [
        ("composite", "search"),
        ("composite", "paper"),
        ("composite-inf", "search"),
    ]


@pytest.mark.parametrize(
    ("modes", "contenders", "what"), [(["x"], ["search"], "modes"), (["serendipity"], ["x"], "contenders")]
)
def test_unknown_names(modes: list[str], contenders: list[str], what: str) -> None:
    with pytest.raises(UsageError, match=what):
        list(measure([], modes, ["0"], contenders))


def timing(task: str, contender: str, seconds: float, **other: object) -> Timing:
    fixed = {"repeats": 1, "status": "optimal", "cost": 1.0, "process_seconds": None, "memory": None}
    return Timing(task, "composite", "0", contender, seconds, seconds, seconds, **{**fixed, **other})  # type: ignore[arg-type]


def test_ratios_are_call_by_call() -> None:
    calls = [("a", 0.1, 0.2), ("b", 0.2, 1.0), ("c", 0.4, 1.6)]
    found = [timing(name, "search", own) for name, own, _ in calls]
    found += [timing(name, "other", theirs) for name, _, theirs in calls]
    row = dict(zip(HEADER, summary(found)[1], strict=True))
    assert row["ratio of medians"] == "5.0 x"
    assert (row["least ratio"], row["ratio 50 %"], row["ratio 95 %"]) == ("2.0 x", "4.0 x", "5.0 x")
    assert (row["median"], row["min-max"]) == ("1000.00 ms", "200.00-1600.00 ms")


def test_figures_that_a_limit_made_too_small_are_marked() -> None:
    found = [timing("a", "search", 0.1), timing("a", "other", 1.0, status="unknown", cost=None)]
    row = dict(zip(HEADER, summary(found)[1], strict=True))
    assert (row["ratio of medians"], row["proved"]) == (">= 10.0 x", "0")


def test_outside_processes_have_a_row_of_their_own() -> None:
    found = [timing("a", "search", 0.1), timing("a", "other", 0.2)]
    found[1] = replace(found[1], process_seconds=3.0)
    rows = [dict(zip(HEADER, row, strict=True)) for row in summary(found)]
    assert [row["contender"] for row in rows] == ["search", "other", "other, process"]
    assert [row["ratio 50 %"] for row in rows] == ["1.0 x", "2.0 x", "30.0 x"]
