"""What is read from Fast Downward's output, with processes that only print it."""

import subprocess
from collections.abc import Iterator
from fractions import Fraction
from pathlib import Path

import pytest

from search import PreparedTask
from serendipity import SerendipityError, example
from serendipity.evaluation.benchmark import fast_downward
from serendipity.model import Options

FOUND = """[t=0.004982s, 10696 KB] Actual search time: 0.001458s
[t=0.005000s, 10696 KB] Plan cost: 126
[t=0.005000s, 10696 KB] Search time: 0.001651s
[t=0.005000s, 10696 KB] Total time: 0.005000s
Solution found.
Peak memory: 10240 KB
"""
NONE = FOUND.replace("Plan cost: 126", "Completely explored state space -- no solution!")
OPTIONS = Options(mode="composite", horizon="inf", discount=Fraction("0.6"), time_limit=5)


@pytest.fixture
def processes(monkeypatch: pytest.MonkeyPatch) -> Iterator[list[tuple[int, str]]]:
    """Exit codes and outputs of the processes, in turn."""
    left: list[tuple[int, str]] = []

    def run(command: list[str], folder: Path, limit: float | None, stdin: object = None) -> tuple[int, str]:
        if not left:
            raise subprocess.TimeoutExpired(command, limit or 0)
        return left.pop(0)

    monkeypatch.setattr(fast_downward, "_binary", lambda: Path("downward"))
    monkeypatch.setattr(fast_downward, "_run", run)
    yield left
    assert not left


def test_costs_are_scaled_back(processes: list[tuple[int, str]]) -> None:
    processes += [(0, "Done!"), (0, FOUND)]
    answer = fast_downward.answer(PreparedTask(example("room2")), OPTIONS)
    # Team costs are 1 and 0.4, so the files' are 5 and 2.
    assert (answer.status, answer.cost) == ("optimal", 25.2)
    assert (answer.seconds, answer.memory) == (0.001651, 10)


@pytest.mark.parametrize("outputs", [[(10, "unsolvable")], [(0, "Done!"), (11, NONE)]])
def test_proofs_that_there_is_no_plan(
    processes: list[tuple[int, str]], outputs: list[tuple[int, str]]
) -> None:
    processes += outputs
    answer = fast_downward.answer(PreparedTask(example("room2")), OPTIONS)
    assert (answer.status, answer.cost) == ("infeasible", None)


@pytest.mark.parametrize("outputs", [[], [(0, "Done!")]])
def test_the_limit_comes_first(processes: list[tuple[int, str]], outputs: list[tuple[int, str]]) -> None:
    processes += outputs
    assert fast_downward.answer(PreparedTask(example("room2")), OPTIONS).status == "unknown"


@pytest.mark.parametrize("outputs", [[(30, "bad file")], [(0, ""), (32, "bad option")], [(0, ""), (0, "hm")]])
def test_failures_are_told(processes: list[tuple[int, str]], outputs: list[tuple[int, str]]) -> None:
    processes += outputs
    with pytest.raises(SerendipityError, match="fast-downward"):
        fast_downward.answer(PreparedTask(example("room2")), OPTIONS)
