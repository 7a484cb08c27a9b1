"""A search that has used up its memory ends with the best plan it knows."""

import os
import tracemalloc
from concurrent.futures import ProcessPoolExecutor
from multiprocessing import get_context
from pathlib import Path

import pytest

import serendipity
from search import PreparedTask
from serendipity.model import Result
from serendipity.model.resources.deadline import Deadline
from serendipity.model.resources.memory import resident
from serendipity_testing.builders import task

STATUS = Path("/proc/self/status")

MORE = 8
"""MiB for the search."""


def planned(mode: str) -> tuple[Result, float]:
    """Many orders of the same deeds; the peak of the process in MiB over the limit."""
    os.environ["SERENDIPITY_KERNEL"] = "off"  # which would need less
    deeds = {f"do{i} h": f"-> done{i} @ 3" for i in range(9)}
    for robot in ("r", "s"):
        deeds |= {f"prepare{i} {robot}": f"!ready{i} -> ready{i}" for i in range(9)}
        deeds |= {f"finish{i} {robot}": f"ready{i} -> done{i} !ready{i}" for i in range(9)}
    built = task(agents="h r s", goal=" ".join(f"done{i}" for i in range(9)), actions=deeds)
    used = resident()
    assert used is not None
    most = used / 2**20 + MORE
    options = {"horizon": 9} if mode == "composite" else {"window_weight": 0}
    result = serendipity.plan(built, mode=mode, discount="0.5", memory_limit=most, time_limit=60, **options)
    return result, peak() - most


def peak() -> float:
    """Most memory that this process has had so far, in MiB; ``getrusage`` counts its parent's, too."""
    lines = STATUS.read_text().splitlines()
    return next(int(line.split()[1]) / 1024 for line in lines if line.startswith("VmHWM"))


@pytest.mark.long
@pytest.mark.skipif(not STATUS.exists(), reason="asks Linux what a process has had in memory")
@pytest.mark.parametrize("mode", ["serendipity", "composite"])
def test_the_best_plan_so_far_is_the_answer(mode: str) -> None:
    with ProcessPoolExecutor(1, mp_context=get_context("spawn")) as apart:
        result, over = apart.submit(planned, mode).result()
    assert result.status == "feasible"
    assert result.cost is not None
    assert result.objective is not None
    assert result.lower_bound is not None
    assert 0 <= result.lower_bound < result.objective  # 0: used up before the first epoch was looked at
    assert result.statistics["elapsed_seconds"] < 50
    assert over < MORE


def test_nothing_is_kept_for_each_pair_of_actions() -> None:
    """Two robots with thousands of actions each have more pairs than there is memory for."""
    deeds = {f"do{i} {robot}": f"-> done{i}" for i in range(100) for robot in ("r", "s")}
    built = task(agents="h r s", goal=" ".join(f"done{i}" for i in range(100)), actions=deeds)
    packed = PreparedTask(built).plain(Deadline()).packed
    tracemalloc.start()
    try:
        for first in packed.useful:
            assert sum(packed.compatible(first, second, strict=True) for second in packed.useful) == 100
        used, _ = tracemalloc.get_traced_memory()
    finally:
        tracemalloc.stop()
    assert used < 100_000
