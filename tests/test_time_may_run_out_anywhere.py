"""Whenever the time runs out, a call ends with what it knows: never with an exception."""

from dataclasses import replace
from typing import Any

import pytest

from serendipity import Task, plan, planning
from serendipity.model import Result
from serendipity.model.deadline import Deadline
from serendipity.model.errors import LimitReachedError
from tests.cases import case_2, case_4

CALLS: list[dict[str, Any]] = [
    {"mode": "individual"},
    {"discount": "0.5"},
    {"discount": "0.5", "window_weight": 0},
    {"discount": "0.5", "preservation": "state"},
    {"mode": "communication", "discount": "0.9", "communication_weight": 1},
    {"mode": "communication", "discount": "0.9", "keep_prefix": True},
    {"mode": "composite", "discount": "0.5"},
    {"mode": "composite", "discount": "0.5", "horizon": "inf"},
    {"human_model": "observant", "discount": "0.5"},
    {"human_model": "local", "discount": "0.5"},
    {"discount": "0.9", "ties": "robust"},
    {"mode": "assistance", "ties": "optimistic"},
]


class Countdown(Deadline):
    """A deadline that runs out at a given look at it; ticks are looks, too."""

    looks = 0

    def check(self) -> None:
        type(self).looks -= 1
        if self.looks < 0:
            raise LimitReachedError("time-limit")

    tick = check


def answers(task: Task, options: dict[str, Any], monkeypatch: pytest.MonkeyPatch) -> list[Result]:
    """What a call says if the first look at the deadline is the last, the second one, and so on."""
    monkeypatch.setattr(planning, "Deadline", Countdown)
    found = []
    looks = 0
    while True:
        Countdown.looks = looks
        found.append(plan(replace(task), time_limit=1, **options))  # a copy knows nothing yet
        if Countdown.looks >= 0:
            return found
        looks = max(looks + 1, looks * 9 // 8)  # each of the first ones, then fewer of them


@pytest.mark.parametrize("options", CALLS, ids=str)
@pytest.mark.parametrize("task", [case_2(), case_4()], ids=["case 2", "case 4"])
def test_time_may_run_out_at_any_look(
    task: Task, options: dict[str, Any], monkeypatch: pytest.MonkeyPatch
) -> None:
    found = answers(task, options, monkeypatch)
    *early, last = found
    assert len(early) > 3
    assert early[0].status == "unknown"
    assert last.status == "optimal"
    for answer in early:
        assert answer.status in ("unknown", "feasible", "optimal")
        if answer.lower_bound is not None and answer.mode != "assistance":
            assert answer.objective is not None
            assert answer.lower_bound <= min(answer.objective, last.objective or 0)
