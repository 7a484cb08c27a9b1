"""No false result is proved, whichever way the verifier goes; and what is right is not taken for false."""

from collections import Counter
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

import serendipity
from serendipity.model import Certificate, Claim, SerendipityError
from serendipity_testing.crosscheck import FalseCertificates, false_certificates
from serendipity_testing.generator.calls import random_call
from serendipity_testing.oracle.truth import Truth, UnknownTruthError
from tests.cli.conftest import Runs

METHODS = {"auto", "auto, paper", "exhaustive", "program", "proof"}
MODES = {"individual", "serendipity", "communication", "composite", "assistance"}


def _presented(first: int, calls: int) -> FalseCertificates:
    judge = FalseCertificates()
    for seed in range(first, first + calls):
        assert judge(random_call(seed)) is None
    return judge


def _verdicts(judge: FalseCertificates) -> Counter[str]:
    verdicts: Counter[str] = Counter()
    for (*_, verdict), number in judge.counts.items():
        verdicts[verdict] += number
    return verdicts


@pytest.mark.long
def test_none_is_proved() -> None:
    verdicts = _verdicts(_presented(0, 8))
    assert verdicts["refuted"] > 200
    assert verdicts["proved"] == 0


@pytest.mark.slow
def test_none_of_thousands_is_proved() -> None:
    judge = _presented(2028, 120)
    assert _verdicts(judge)["refuted"] > 3000
    kinds, modes, methods, _ = (set(part) for part in zip(*judge.counts, strict=True))
    assert (modes, methods) == (MODES, METHODS)
    assert len(kinds) == 17


@given(st.integers(0, 10**9))
def test_right_answers_are_not_taken_for_false(seed: int) -> None:
    call = random_call(seed)
    try:
        answer = serendipity.plan(call.task, human_plan=call.human_plan, **call.keywords())
        assert Truth(call.task).fault(answer) is None
    except (SerendipityError, UnknownTruthError):
        return


def test_a_verifier_that_believes_everything_is_found(monkeypatch: pytest.MonkeyPatch, run: Runs) -> None:
    believed = Certificate((Claim("cost", "proved", ""),), 0.0)
    monkeypatch.setattr(false_certificates, "certify", lambda *_, **__: believed)
    monkeypatch.setattr("serendipity_testing.shrinking.shrink", lambda call, *_, **__: call)
    done = run("crosscheck --judges false-certificates --seed 1 -o found")
    assert (done.code, "proved, but" in done.out) == (1, True)
    again = Path("found/commands.txt").read_text()
    assert "crosscheck --count 1 --seed 1 --judges false-certificates" in again


def test_the_command_counts_by_kind_mode_and_method(run: Runs) -> None:
    done = run("crosscheck --judges search,false-certificates --seed 3 --count 2")
    assert (done.code, "2 calls, search, false-certificates: 0 disagreements" in done.out) == (0, True)
    first, *_, last = done.out.splitlines()[-1].split()
    assert (first, last) == ("all", "0")
