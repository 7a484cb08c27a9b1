"""A limit that comes while a proof is checked says nothing about the proof."""

import json
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import Any

import pytest

import serendipity
from serendipity.model import Deadline, LimitReachedError, ProofCheck, Result, Task
from serendipity_testing.cases import case_1
from serendipity_testing.countdown import Countdown
from tests.endings import endings
from tests.verify.proofs.samples import sample
from verify.proofs import checker


@pytest.fixture(scope="module")
def proved(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, Task, Result]:
    """A proof, and what it is of."""
    task, file = case_1(), tmp_path_factory.mktemp("proofs") / "proof.json"
    answer = serendipity.plan(task)
    assert serendipity.verify(task, answer, proof=file).verdict == "proved"
    return file, task, answer


@pytest.mark.long
@pytest.mark.parametrize("once", [False, True])
@pytest.mark.parametrize("reason", ["time-limit", "memory-limit", "cancelled"])
def test_whenever_it_comes(proved: tuple[Path, Task, Result], reason: str, once: bool) -> None:
    """``once``: as memory may be free again when somebody looks at it afterwards."""

    def examine(deadline: Deadline) -> ProofCheck:
        return serendipity.check_proof(*proved, deadline=deadline)

    *early, last = endings(examine, lambda: LimitReachedError(reason), sparser=2, once=once)
    assert last.accepted
    for found in early:
        assert found.reason == reason if isinstance(found, LimitReachedError) else found.accepted


def test_time_that_is_kept_for_the_end(proved: tuple[Path, Task, Result]) -> None:
    """What is undecided since the time for it is up is not rejected while some is left for the end."""

    class Nearly(Countdown):
        """Ends in the part of the time that is not kept for the end."""

        def sooner(self, share: float) -> "Countdown":
            return Countdown(5)

    with pytest.raises(LimitReachedError):
        serendipity.check_proof(*proved, deadline=Nearly(10**9))


def test_rows_and_leaves_are_looked_at_one_by_one(tmp_path: Path) -> None:
    data, looks = sample("branched").proof, 0

    def counted(items: Iterable[Any]) -> Iterator[Any]:
        nonlocal looks
        for item in items:
            looks += 1
            yield item

    (tmp_path / "proof.json").write_text(json.dumps(data))
    assert checker.read(tmp_path / "proof.json", counted) == data
    assert looks > sum(len(program["rows"]) for program in data["programs"])
    looks = 0
    found = checker.check(data, counted)
    assert looks >= sum(program.rows + program.leaves for program in found)
