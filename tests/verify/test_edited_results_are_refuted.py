"""Whatever field of a good result is edited, it is refuted or refused, unless what it says is still right."""

import itertools
from collections import Counter
from dataclasses import replace
from typing import Any

import pytest

import serendipity
from serendipity.model import InputError, Result, SerendipityError, Window
from tests.verify.edits.corpus import Good, corpus
from tests.verify.edits.edits import Edit, edited, pairs, single
from tests.verify.edits.explained import explained

_STRIDE = 53
"""One edit in so many is tried by the quick test; a prime, so that every field has its turn."""

_PAIRS = 400
"""Pairs of edits of each good result, for the slow test."""


def _verdict(good: Good, *edits: Edit) -> str:
    """What becomes of an edited result: a verdict, ``refused``, or why it is right to prove it."""
    data = edited(good.result.to_dict(), *edits)
    try:
        result = Result.from_dict(data)
        verdict = serendipity.verify(good.task, result).verdict
    except SerendipityError as error:
        assert "\n" not in str(error)
        assert len(str(error)) <= 300
        return "refused"
    if verdict != "proved":
        return verdict
    why = _why(good, data, result, edits)
    assert why is not None, (good.name, *map(str, edits))
    return why


def _why(good: Good, data: dict[str, Any], result: Result, edits: tuple[Edit, ...]) -> str | None:
    """Why an edited result is right: for both edits at once, or for one after the other."""
    found = explained(good, data, result, edits)
    for first in edits if found is None and len(edits) > 1 else ():
        try:
            between = replace(good, result=Result.from_dict(edited(good.result.to_dict(), first)))
        except SerendipityError:
            continue
        rest = tuple(edit for edit in edits if edit is not first)
        once = explained(good, between.result.to_dict(), between.result, (first,))
        found = found or (once and explained(between, data, result, rest))
    return found


def _count(every: int, count: int) -> Counter[str]:
    goods, found = corpus(), Counter[str]()
    for number, good in enumerate(goods):
        data, other = good.result.to_dict(), goods[(number + 1) % len(goods)].result.to_dict()
        for edit in itertools.islice(single(data, other), number % every, None, every):
            found[_verdict(good, edit)] += 1
        for both in pairs(data, other, count, seed=number):
            found[_verdict(good, *both)] += 1
    return found


@pytest.mark.long
def test_edited_results() -> None:
    found = _count(_STRIDE, 4)
    assert found["refuted"] > 200
    assert found["refused"] > 400


@pytest.mark.slow
def test_every_edit_of_every_field() -> None:
    found = _count(1, _PAIRS)
    assert sum(found.values()) > 50_000, found


@pytest.mark.parametrize(
    ("fields", "words"),
    [
        ({"status": "proved"}, "status"),
        ({"mode": "assistance"}, "mode"),
        ({"mode": None}, "mode"),
        ({"cost": "12.6"}, "cost"),
        ({"cost": float("nan")}, "cost"),
        ({"objective": -1.0}, "objective"),
        ({"opportunity": 1}, "opportunity"),
        ({"window": (6, 7)}, "another type"),
        ({"plan": [{"epoch": 1}]}, "another type"),
        ({"plan": 7}, "another type"),
        ({"options": {}}, "another type"),
        ({"human_plan": "move"}, "human_plan|another task"),
        ({"realised": {"observant": "yes"}}, "realised"),
        ({"agent_costs": None}, "another type"),
        ({"statistics": 7}, "another type"),
        ({"horizon": "long"}, "horizon"),
    ],
    ids=str,
)
def test_results_made_by_hand_are_checked_like_files(fields: dict[str, Any], words: str) -> None:
    task = serendipity.example("room2")
    answer = serendipity.plan(task, discount="0.6")
    for examine in (serendipity.verify, serendipity.check):
        with pytest.raises(InputError, match=words):
            examine(task, replace(answer, **fields))


def test_an_empty_answer_of_another_mode_is_not_proved() -> None:
    """A result without a policy claims nothing that a policy could prove."""
    task = serendipity.example("room2")
    answer = serendipity.plan(task, discount="0.6")
    empty = replace(answer, mode="assistance", plan=(), window=None, cost=1.0, objective=1.0, lower_bound=1.0)
    for options in (answer.options, answer.options.but(mode="assistance")):
        forged = replace(empty, options=options, mode="assistance")
        for examine in (serendipity.verify, serendipity.check):
            try:
                assert examine(task, forged).verdict == "refuted"
            except InputError as error:
                assert "mode" in str(error)


def test_an_exact_discount_stays_exact_in_json() -> None:
    task = serendipity.example("room2")
    for discount in ("2/3", "2000003/3000017"):
        answer = serendipity.plan(task, discount=discount)
        read = Result.from_dict(answer.to_dict())
        assert answer.to_dict()["options"]["discount"] == discount
        assert read.options == answer.options
        assert serendipity.verify(task, read).verdict == "proved"


def test_a_window_that_is_none_is_no_window() -> None:
    task = serendipity.example("room2")
    answer = serendipity.plan(task, discount="0.6")
    assert serendipity.verify(task, replace(answer, window=Window(5, 7))).verdict == "refuted"


def test_a_billionth_of_the_window_weight_is_no_rounding() -> None:
    good = next(good for good in corpus() if good.name == "goals")
    assert _verdict(good, Edit(("options", "window_weight"), 1000.000000001)) == "refuted"
