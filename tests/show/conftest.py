"""Scenes that several tests look at."""

from dataclasses import replace
from itertools import pairwise
from pathlib import Path

import pytest

import serendipity
from serendipity.model import Task
from serendipity.pictures import Scene, build_scene
from serendipity_testing import cases

WARDS = Path(__file__).parent / "data" / "wards"


def ground(task: Task) -> Task:
    """The same task as ground files write it: one word for each fact and action."""
    actions = (replace(action, name=action.name.replace(" ", "_")) for action in task.actions)
    ordered = tuple(sorted(actions, key=lambda action: action.key))
    return replace(task, facts=tuple(f.replace(" ", "_") for f in task.facts), actions=ordered)


def walk(who: str, *ways: str) -> dict[str, str]:
    """Moves for :func:`build`, between places joined by ``-``, and back."""
    pairs = [pair for way in ways for a, b in pairwise(way.split("-")) for pair in ((a, b), (b, a))]
    return {f"walk {who} {a} {b}": f"at_{who}_{a} -> at_{who}_{b} !at_{who}_{a}" for a, b in pairs}


def spaced(built: Task) -> Task:
    """A task of :func:`build` as lifted files write it: blanks in the names of facts."""
    return replace(built, facts=tuple(fact.replace("_", " ") for fact in built.facts))


@pytest.fixture(scope="session")
def room2() -> Scene:
    """The paper's example III-C at discount 0.6."""
    task = serendipity.example("room2")
    return build_scene(task, serendipity.plan(task, discount="0.6"))


@pytest.fixture(scope="session")
def no_map() -> Scene:
    """semantics 9, case 10: two robots lift something, nobody is anywhere."""
    task = cases.case_10()
    return build_scene(task, serendipity.plan(task, discount="0.5", horizon=2))


@pytest.fixture(scope="session")
def parcels() -> Scene:
    """The example of a driver, a van and a robot with a cart."""
    task = serendipity.example("parcels")
    return build_scene(task, serendipity.plan(task, discount="0.5"))
