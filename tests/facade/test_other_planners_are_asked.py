"""``classical="symk"``: a planner of others settles what the search does not, and its plan is checked."""

import sys
from pathlib import Path

import pytest

from search.kernel.library import library
from serendipity import Result, Task, UsageError, check, example, plan, plan_anytime, verify
from serendipity.classical import fast_downward
from serendipity.facade import classical
from serendipity.testing.builders import task as build
from serendipity.testing.generator import random_call

PROGRAM = Path(__file__).parents[1] / "classical" / "uniform_cost.py"
TOGETHER = {"mode": "composite", "horizon": "inf"}
LITTLE = {"individual": "saving", "composite": "human-plan"}
"""Strategies that prove nothing in a mode."""

needs_kernel = pytest.mark.skipif(library() is None, reason="the problem is the kernel's")


@pytest.fixture
def program(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """What is run in the place of SymK."""
    path = tmp_path / "downward"
    path.write_text(f"#!{sys.executable}\n{PROGRAM.read_text()}")
    path.chmod(0o755)
    monkeypatch.setattr(fast_downward, "program", lambda _: path)
    return path


def told(task: Task, **options: object) -> Result:
    strategies = LITTLE[str(options["mode"])]
    return plan(task, classical="symk", strategies=strategies, **options)  # type: ignore[arg-type]


@needs_kernel
@pytest.mark.usefixtures("program")
@pytest.mark.parametrize(
    ("name", "mode"), [("flights", {"mode": "individual"}), ("flights", TOGETHER), ("parcels", TOGETHER)]
)
def test_it_settles_what_the_search_leaves_open(name: str, mode: dict[str, str]) -> None:
    task = example(name)
    ours, theirs = plan(task, discount="0.9", **mode), told(task, discount="0.9", **mode)  # type: ignore[arg-type]
    assert (theirs.status, theirs.cost, theirs.saving) == ("optimal", ours.cost, ours.saving)
    assert (theirs.lower_bound, theirs.gap[-1].objective) == (ours.cost, ours.cost)  # type: ignore[index]
    assert theirs.statistics["proved_by"] == theirs.statistics["strategies"][-1]["name"] == "symk"
    assert "proved to be the best by symk" in str(theirs)
    assert "proved_by" not in plan(task, classical="symk", **mode).statistics  # type: ignore[arg-type]
    assert check(task, theirs).verdict == verify(task, theirs).verdict == "proved"


@needs_kernel
@pytest.mark.usefixtures("program")
@pytest.mark.parametrize("seed", range(40, 52))
def test_random_calls_are_told_rightly(seed: int) -> None:
    task = random_call(seed).task
    for mode in ({"mode": "individual"}, TOGETHER):
        ours, theirs = plan(task, **mode), told(task, **mode)  # type: ignore[arg-type]
        if "proved_by" in theirs.statistics:
            assert (theirs.status, theirs.cost) == (ours.status, ours.cost)
        assert check(task, theirs).verdict != "refuted"


@needs_kernel
@pytest.mark.usefixtures("program")
def test_what_has_to_be_done_in_one_epoch_is_one_operator() -> None:
    actions = {"a h": "x -> ga !y @ 3", "b r": "y -> gb !x @ 2"}
    swap = build(agents="h r", human="h", init="x y", goal="ga gb", actions=actions)
    found = told(swap, discount="0.5", **TOGETHER)
    assert (found.status, found.cost, [step.epoch for step in found.plan or ()]) == ("optimal", 4, [1, 1])
    assert told(swap, interference="strict", **TOGETHER).status == "infeasible"
    assert told(swap, mode="individual").reason == "no-human-plan"


@needs_kernel
@pytest.mark.parametrize(
    "answer", ["(0)\n; cost", "(0)\n(0)\n(0)\n(0)", "", "(x)"], ids=["short", "long", "none", "unknown"]
)
def test_a_plan_that_does_not_work_is_no_answer(program: Path, answer: str) -> None:
    program.write_text(
        f"#!{sys.executable}\nopen('sas_plan', 'w').write({answer!r})\n"
        "print('Plan cost: 1\\nSearch time: 0.1s\\nTotal time: 0.1s')\n"
    )
    found = told(example("room2"), mode="individual")
    assert (found.status, found.cost) == ("unknown", None)
    assert not found.statistics["strategies"][-1]["settled"]


@needs_kernel
def test_nothing_depends_on_it(program: Path) -> None:
    program.write_text("#!/bin/sh\nexit 32\n")
    *_, found = plan_anytime(example("room2"), classical="symk", **TOGETHER)  # type: ignore[arg-type]
    assert (found.status, found.cost) == ("optimal", 13)
    assert told(example("room2"), **TOGETHER).status == "feasible"


def test_what_can_not_be_asked_is_refused_in_one_line(monkeypatch: pytest.MonkeyPatch) -> None:
    task = example("room2")
    with pytest.raises(UsageError, match="classical: is for individual mode, and for composite mode without"):
        plan(task, classical="symk")
    with pytest.raises(UsageError, match="classical: expected one of symk, got 'lama'"):
        plan(task, classical="lama", mode="individual")
    monkeypatch.setattr(fast_downward, "program", lambda _: None)
    with pytest.raises(UsageError, match=r"classical: symk is left out: no up-symk here: pip install"):
        plan(task, classical="symk", mode="individual")
    monkeypatch.setattr(classical, "absent", lambda *_, **__: None)
    monkeypatch.setattr(classical, "library", lambda: object())
    with pytest.raises(UsageError, match="classical: waiting_cost and head_start are given"):
        plan(task, classical="symk", mode="individual", head_start=1)
    monkeypatch.setattr(classical, "library", lambda: None)
    with pytest.raises(UsageError, match="classical: needs the compiled kernel"):
        plan(task, classical="symk", mode="individual")
