"""Leaving robots' walks out of the search changes its size, not its answers."""

from itertools import product

import pytest

import serendipity
from search import PreparedTask
from search.call.context import SearchContext
from serendipity.model import Window
from serendipity.model.resources.deadline import Deadline
from serendipity_testing import builders
from tests.verify.claims import verdicts

OPTIONS = (
    {"discount": "0.9"},
    {"discount": "0.6", "window_weight": "0"},
    {"discount": "0.9", "window_weight": "0.5", "interference": "strict"},
    {"discount": "1", "max_window": 2},
    {"discount": "0.9", "suffix": "subplan"},
    {"discount": "0.9", "ties": "optimistic"},
)


@pytest.fixture(scope="module")
def buildings(tmp_path_factory):
    """Buildings in which two or three robots can help, some with cycles."""
    tasks = []
    for seed, rooms, robots in ((4, 12, 2), (12, 14, 2), (39, 11, 2), (5, 20, 3), (23, 13, 3), (31, 16, 2)):
        folder = tmp_path_factory.mktemp("building") / "task"
        serendipity.generate_usar(
            folder, rooms=rooms, medkits=2, robots=robots, seed=seed, extra_edges=seed % 3
        )
        tasks.append(serendipity.load(folder))
    return tasks


def test_answers_are_those_of_a_search_that_walks_step_by_step(buildings, monkeypatch):
    folded = [serendipity.plan(task, **options) for task, options in product(buildings, OPTIONS)]
    monkeypatch.setattr(SearchContext, "walks", _step_by_step)
    stepwise = [serendipity.plan(task, **options) for task, options in product(buildings, OPTIONS)]
    for (task, _), one, other in zip(product(buildings, OPTIONS), folded, stepwise, strict=True):
        found = verdicts(serendipity.check(task, one))
        assert "refuted" not in found.values(), found
        assert found["replay"] == "proved"
        assert (one.objective, one.cost, one.window) == (other.objective, other.cost, other.window)
        assert len(one.plan) == len(other.plan)
    assert sum(answer.opportunity for answer in folded) >= 6
    assert any(answer.opportunity and answer.window is not None for answer in folded)


def test_walks_are_left_out_only_where_nobody_else_minds(buildings):
    assert all(_foldable(task) for task in buildings)
    walk = {"go r a b": "at-a -> at-b !at-a", "go r b a": "at-b -> at-a !at-b"}
    deed = {"open r b": "at-b -> open", "do h": "open -> done @ 2", "do2 h": "-> done @ 9"}
    base = {"init": "at-a", "goal": "done"}
    assert _foldable(builders.task(**base, actions=walk | deed))
    # The human minds where the robot is; the robot works from anywhere.
    assert not _foldable(builders.task(**base, actions=walk | deed | {"do h": "open at-a -> done @ 2"}))
    assert not _foldable(builders.task(**base, actions=walk | deed | {"open r b": "-> open"}))
    # Ways of different cost: the dear one might be the shorter one.
    assert not _foldable(builders.task(**base, actions=walk | deed | {"go r b a": "at-b -> at-a !at-b @ 2"}))


def test_what_robots_only_move_together_is_nobodys_place():
    """It was each robot's place: planning ended in a ValueError."""
    push = {f"push r q {a} {b}": f"at-{a} -> at-{b} !at-{a}" for a, b in ("ab", "bc", "cb", "ba")}
    deeds = {
        "dig r": "-> dug",
        "open r q c": "at-c dug -> open",
        "do h": "open -> met @ 2",
        "do2 h": "-> met @ 9",
    }
    task = builders.task(agents="h r q", init="at-a", goal="met", actions=push | deeds)
    assert not _foldable(task)
    answer = serendipity.plan(task, horizon=5, window_weight=0, discount="0.9")
    assert (answer.cost, answer.window) == (2.4, Window(1, 5))


@pytest.mark.parametrize(
    ("there", "back", "distances"),
    [("at-a", "at-a !at-b !open", (1, -1)), ("at-a lit", "at-a !at-b", (-1, 1))],
    ids=["what else it changes", "what else it asks for, even what nothing changes"],
)
def test_a_walk_that_is_about_more_than_a_place_is_a_deed(there, back, distances):
    moves = {"go r a b": f"{there} -> at-b !at-a", "go r b a": f"at-b -> {back}"}
    deeds = {"open r b": "at-b -> open", "do h": "open -> done @ 2", "do2 h": "-> done @ 9"}
    task = builders.task(init="at-a", goal="done", actions=moves | deeds)
    tables = PreparedTask(task).plain(Deadline())
    packed, walks = tables.packed, tables.decoupled(Deadline())
    a, b = (packed.pack([task.facts.index(name)]) & walks.fields[0] for name in ("at-a", "at-b"))
    assert walks.foldable
    found = (walks.ways(0, here).get(there) for here, there in ((a, b), (b, a)))
    assert tuple(ways[0].epochs if ways else -1 for ways in found) == distances


def _step_by_step(context, plan):
    """In place of ``SearchContext.walks``: none that can be folded."""


def _foldable(task):
    return PreparedTask(task).plain(Deadline()).decoupled(Deadline()).foldable
