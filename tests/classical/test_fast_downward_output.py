"""What is read from Fast Downward's output, with processes that only print it."""

import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

from serendipity import SerendipityError, UsageError
from serendipity.classical import fast_downward
from serendipity.classical.fast_downward import LMCUT, SYMK, Found, run, run_translated, scorpion
from serendipity.model import Deadline
from serendipity.pddl.classical import ClassicalFiles

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
