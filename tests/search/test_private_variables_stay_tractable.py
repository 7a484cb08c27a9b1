"""The human's private variables are tabulated together only as far as that does not take long."""

from pathlib import Path

import pytest

import search.human.own_problem
import serendipity
from search.human.pattern_database import human_graph, private_fields
from search.packed.packed_task import PackedTask
from serendipity.model import Deadline, Task
from serendipity.testing.builders import task
from serendipity.testing.countdown import Countdown

COUNT = 30


def packed(problem: Task) -> PackedTask:
    return PackedTask(problem, frozenset(), Deadline())


def test_too_many_states_are_not_listed_again_and_again() -> None:
    """With one variable less each time, 50,000 states were listed for each of 15 numbers of switches."""
    names = [f"on{i}" for i in range(COUNT)]
    actions = {f"switch{name} h": f"-> {name}" for name in names} | {"help r": "-> on0"}
    deadline = Countdown(10**9)
    graph = human_graph(packed(task(goal=" ".join(names), actions=actions)), deadline)
    assert 10_000 <= len(graph.moves) <= 50_000
    assert 10**9 - deadline.left_over[0] < 60_000


def test_what_can_only_become_little_together_is_kept_together() -> None:
    chain = {f"do{i} h": f"f{i} -> f{i + 1} @ 2" for i in range(COUNT)} | {"help r": "-> light"}
    problem = packed(task(init="f0", goal=f"f{COUNT} light", actions=chain))
    graph = human_graph(problem, Deadline())
    assert graph.mask == sum(private_fields(problem))
    assert len(graph.moves) == COUNT + 1


def test_many_easy_searches_are_not_handed_over(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    """The kernel took over after 200 states in all, and takes milliseconds a question in large buildings."""
    asked: list[object] = []
    monkeypatch.setattr(search.human.own_problem, "own_planner", lambda *given: asked.append(given))
    serendipity.generate_usar(tmp_path / "building", rooms=210, corridors=4)
    building = serendipity.load(tmp_path / "building")
    assert serendipity.plan(building, discount=0.9, window_weight=0).status == "optimal"
    assert not asked
