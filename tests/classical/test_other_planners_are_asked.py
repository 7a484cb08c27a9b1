"""Planners of others: what is read from Fast Downward's output, with processes that only print it.

``classical="symk"``: one of them settles what the search does not, and its plan is checked.
"""

import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

from search.kernel.library import library
from serendipity import Result, SerendipityError, Task, UsageError, check, example, plan, plan_anytime, verify
from serendipity.classical import fast_downward
from serendipity.classical.fast_downward import LMCUT, SYMK, Found, run, run_translated, scorpion
from serendipity.facade import classical
from serendipity.model import Deadline
from serendipity.pddl.classical import ClassicalFiles
from serendipity_testing.builders import task as build
from serendipity_testing.generator import random_call

FILES = ClassicalFiles("", "", scale=5)

FOUND = """[t=0.001001s, 10696 KB] f = 100, 1 evaluated, 0 expanded
[t=0.002001s, 10696 KB] f = 126, 20 evaluated, 8 expanded
[t=0.004982s, 10696 KB] Actual search time: 0.001458s
[t=0.005000s, 10696 KB] Plan cost: 126
[t=0.005000s, 10696 KB] Expanded 13 state(s).
[t=0.005000s, 10696 KB] Search time: 0.001651s
[t=0.005000s, 10696 KB] Total time: 0.005000s
Solution found.
Peak memory: 10240 KB
"""
NONE = FOUND.replace("Plan cost: 126", "Completely explored state space -- no solution!")
BOTH = NONE.replace("Completely explored state space", "BOUND: 2147483647 < 2147483647 [0/1 plans]")
ENDED = FOUND.partition("[t=0.004982s")[0] + "Peak memory: 20480 KB\ncaught signal 15 -- exiting\n"

Outputs = list[tuple[int | None, str]]


@pytest.fixture
def processes(monkeypatch: pytest.MonkeyPatch) -> Iterator[Outputs]:
    """Exit codes and outputs of the processes, in turn."""
    left: Outputs = []

    def process(
        command: list[str], folder: Path, limit: Deadline, stdin: object = None
    ) -> tuple[int | None, str]:
        return left.pop(0)

    monkeypatch.setattr(fast_downward, "program", lambda _: Path("downward"))
    monkeypatch.setattr(fast_downward, "_process", process)
    yield left
    assert not left


def answered() -> Found:
    return run(FILES, LMCUT, 5)


def test_costs_are_scaled_back(processes: Outputs) -> None:
    processes += [(0, "Done!"), (0, FOUND)]
    found = answered()
    assert (found.status, found.cost, found.lower_bound) == ("optimal", 25.2, 25.2)
    assert (found.search_seconds, found.seconds, found.expanded, found.memory) == (0.001651, 0.005, 13, 10)


def test_a_bound_from_both_ends_is_read(processes: Outputs) -> None:
    told = "[t=0.7s, 496568 KB] BOUND: 30 < 2147483647 [0/1 plans], dir: BW\n"
    processes += [(0, "Done!"), (None, told)]
    assert run(FILES, SYMK, 5).lower_bound == 6


@pytest.mark.parametrize(
    "outputs", [[(10, "unsolvable")], *([(0, "Done!"), end] for end in ((11, NONE), (12, NONE), (12, BOTH)))]
)
def test_proofs_that_there_is_no_plan(processes: Outputs, outputs: Outputs) -> None:
    processes += outputs
    found = answered()
    assert (found.status, found.cost, found.lower_bound) == ("infeasible", None, None)


@pytest.mark.parametrize("outputs", [[(None, "")], [(0, "Done!"), (None, "")]])
def test_the_limit_comes_first(processes: Outputs, outputs: Outputs) -> None:
    processes += outputs
    found = answered()
    assert (found.status, found.cost, found.lower_bound) == ("unknown", None, None)


def test_what_it_knew_at_the_limit_is_told(processes: Outputs) -> None:
    processes += [(0, "Done!"), (None, ENDED)]
    found = answered()
    assert (found.status, found.lower_bound, found.expanded) == ("unknown", 25.2, 8)
    assert found.memory == 20


@pytest.mark.parametrize("outputs", [[(30, "bad file")], [(0, ""), (12, "left")], [(0, ""), (0, "hm")]])
def test_failures_are_told(processes: Outputs, outputs: Outputs) -> None:
    processes += outputs
    with pytest.raises(SerendipityError, match="fast-downward"):
        answered()


def test_a_process_is_ended_at_the_limit_and_says_what_it_knows(tmp_path: Path) -> None:
    script = (
        "import signal, sys, time\n"
        "signal.signal(signal.SIGTERM, lambda *_: (print('so far'), sys.exit(0)))\n"
        "print('started', flush=True)\n"
        "time.sleep(60)\n"
    )
    code, text = fast_downward._process([sys.executable, "-c", script], tmp_path, Deadline(1.0))
    assert code is None
    assert text.split("\n")[-2:] == ["so far", ""]


SCRIPT = """#!{python}
import sys
if "scp([projections(hillclimbing(max_time=100, " not in sys.argv[2] or " max_time=200, " not in sys.argv[2]:
    sys.exit("other words")
if sys.stdin.read() == "task":
    print({told!r})
    open("sas_plan", "w").write("(0 )\\n(7 )\\n; cost = 126 (general cost)\\n")
"""


def test_scorpion_is_asked_as_in_the_competition(tmp_path: Path) -> None:
    path = tmp_path / "downward"
    path.write_text(SCRIPT.format(python=sys.executable, told=FOUND))
    with pytest.raises(UsageError, match=r"scorpion: .*downward is no program"):
        scorpion(path)
    path.chmod(0o755)
    found = run_translated("task", scorpion(path), Deadline())
    assert (found.status, found.cost, found.plan) == ("optimal", 126, ("0", "7"))
    for limit, told in ((None, "it says nothing"), (9, "other words")):  # shares of the time limit
        with pytest.raises(SerendipityError, match=f"scorpion: the search failed: {told}"):
            run_translated("another", scorpion(path), Deadline(limit))
    path.write_text("no program")
    with pytest.raises(SerendipityError, match="downward can't be run"):
        run_translated("task", scorpion(path), Deadline())


PROGRAM = Path(__file__).parent / "uniform_cost.py"
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
