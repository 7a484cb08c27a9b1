"""Robots told by numbers of things that are alike: bounds and answers against brute force and search."""

from collections.abc import Iterator
from contextlib import suppress
from fractions import Fraction
from random import Random
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

import search.improvements
import serendipity
from search.short_windows.independent.short_windows import ShortWindows, short_windows
from search.call.context import SearchContext
from search.engine.best_first import Incumbent
from search.call.prepared_task import PreparedTask
from serendipity.model import Options, Task
from serendipity.model.errors import LimitReachedError
from serendipity.model.resources.deadline import Deadline
from serendipity.testing.countdown import Countdown
from serendipity.testing.oracle import best
from tests.search.short_windows.independent.alike.surveys import survey

ONE_EPOCH = Options(mode="serendipity", max_window=1)


def _options(dice: Random) -> Options:
    discount = dice.choice(["0", "1/2", "9/10", "1"])
    return ONE_EPOCH.but(discount=discount, interference=dice.choice(["paper", "strict"]))


def _incumbent(context: SearchContext, plan: tuple[int, ...]) -> Incumbent:
    keys = context.keys
    idle = sum(option.weight for _, option in context.followed(plan)) + keys.epoch_weight
    return Incumbent(idle + keys.of_start(len(plan), len(plan)))


def counted(task: Task, options: Options) -> tuple[Fraction, Fraction] | None:
    """A lower bound on the cost of plans with a window of one epoch, and what the best that was found costs.

    None where robots can't be told by numbers.
    """
    context = SearchContext(PreparedTask(task), options, Deadline())
    optimal = context.canonical_plan()
    if optimal is None or not optimal.actions:
        return None
    incumbent = _incumbent(context, optimal.actions)
    windows = short_windows(context, optimal.actions, len(optimal.actions), incumbent, by_numbers=True)
    if windows is None:
        return None
    for _ in windows.answers():
        pass
    bound = context.keys.objective(min(windows.bound, incumbent.key)) - options.window_weight
    return bound, context.keys.cost(incumbent.key)


def _nothing(*_: object) -> Iterator[Any]:
    raise LimitReachedError("time-limit")


def test_bounds_and_answers_are_what_brute_force_says() -> None:
    asked = 0
    for seed in range(120):
        dice = Random(f"brute force {seed}")
        task, options = survey(dice, 4, 1), _options(dice)
        found = counted(task, options)
        if found is not None:
            asked += 1
            assert found == (best(task, options).cost,) * 2
    assert asked > 6


def test_bounds_and_answers_are_what_search_says(monkeypatch: pytest.MonkeyPatch) -> None:
    """Robots' ways with names can be found for all that is worth it, beside these plans of the human's."""
    monkeypatch.setattr(search.improvements.Improvements, "_in_short_windows", lambda _: iter(()))
    asked = 0
    for seed in range(110):
        dice = Random(f"search {seed}")
        task, options = survey(dice, dice.choice((5, 6, 7)), dice.choice((1, 1, 2))), _options(dice)
        found = counted(task, options)
        if found is not None:
            asked += 1
            answer = serendipity.plan(
                task, max_window=1, discount=options.discount, interference=options.interference
            )
            assert answer.status == "optimal"
            assert tuple(map(float, found)) == (answer.cost, answer.cost)
    assert asked > 10


def test_calls_that_are_settled_by_numbers(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(search.improvements, "FIRST", 0)
    settled = []
    answers = ShortWindows.answers

    def seen(self: ShortWindows) -> Iterator[None]:
        yield from answers(self)
        settled.append(self._counted is not None and self.bound >= self._best.key)

    monkeypatch.setattr(ShortWindows, "answers", seen)
    for seed in range(40):
        dice = Random(f"calls {seed}")
        task, discount = survey(dice, 6, 1), dice.choice(["1/2", "9/10"])
        answer = serendipity.plan(task, discount=discount)
        assert serendipity.check(task, answer).verdict != "refuted"
        with monkeypatch.context() as patched:
            patched.setattr(search.improvements.Improvements, "_in_one_epoch_each", lambda *_: iter(()))
            plain = serendipity.plan(task, discount=discount)
        assert (answer.status, answer.objective) == (plain.status, plain.objective)
    assert sum(settled) > 4


def test_ways_that_are_not_found_leave_a_bound(monkeypatch: pytest.MonkeyPatch) -> None:
    for seed in range(40):
        dice = Random(f"search {seed}")
        task, options = survey(dice, dice.choice((5, 6, 7)), dice.choice((1, 1, 2))), _options(dice)
        exact = counted(task, options)
        with monkeypatch.context() as patched:
            patched.setattr("search.short_windows.independent.alike.window.lifted", lambda *_: None)
            found = counted(task, options)
        assert (found is None) == (exact is None)
        if found is not None and exact is not None:
            assert found[0] <= exact[0] <= found[1]


@given(st.integers(0, 300), st.integers(1, 400))
def test_a_limit_leaves_a_bound(seed: int, looks: int) -> None:
    dice = Random(f"search {seed}")
    task, options = survey(dice, dice.choice((5, 6, 7)), dice.choice((1, 1, 2))), _options(dice)
    exact = counted(task, options)
    if exact is None:
        return
    context = SearchContext(PreparedTask(task), options, Deadline())
    optimal = context.canonical_plan()
    assert optimal is not None
    incumbent = _incumbent(context, optimal.actions)
    plan, windows = optimal.actions, None
    with suppress(LimitReachedError):
        hurried = context.under(Countdown(looks))
        windows = short_windows(hurried, plan, len(plan), incumbent, by_numbers=True)
        for _ in windows.answers() if windows else ():
            pass
    known = 0 if windows is None else windows.bound
    bound = context.keys.objective(min(known, incumbent.key)) - options.window_weight
    assert bound <= exact[0] <= context.keys.cost(incumbent.key)
