"""Whenever a limit comes there is a certificate: what was not examined is undecided, nothing is wrong."""

from collections.abc import Callable, Iterator
from dataclasses import replace
from typing import Any

import pytest

import serendipity
from serendipity.model import Deadline, LimitReachedError, Options, Result, Task
from serendipity_testing.cases import case_4, case_10
from serendipity_testing.countdown import Countdown
from tests.endings import endings
from tests.verify.claims import verdicts
from tests.verify.doctored import ANOTHER_TASK, DOCTORED
from tests.verify.edits.corpus import corpus
from verify.calls.solve import solve
from verify.certificate.certify import certify

NAMES = (
    *("individual", "window", "no opportunity", "free windows", "state", "subplan", "communication"),
    *("keep prefix", "composite", "composite inf", "observant", "local", "robust", "no human plan"),
    *("assistance robust", "goals"),
)
"""Good results of the corpus."""

LIMITS: dict[str, tuple[Callable[[], Exception], bool]] = {
    "time": (lambda: LimitReachedError("time-limit"), False),
    "memory, for a moment": (lambda: LimitReachedError("memory-limit"), True),
    "no memory, for a moment": (MemoryError, True),
}


def _answered(name: str) -> tuple[Task, Result]:
    good = next(good for good in corpus() if good.name == name)
    return good.task, good.result


def _endings(examine: Callable[[Deadline], Any], limit: str) -> Iterator[Any]:
    make, once = LIMITS[limit]
    return endings(examine, make, sparser=5, once=once)


@pytest.mark.long
@pytest.mark.parametrize("limit", LIMITS)
@pytest.mark.parametrize("name", NAMES)
def test_right_answers_are_never_refuted_and_never_proved_by_halves(name: str, limit: str) -> None:
    task, answer = _answered(name)
    whole = certify(task, answer)
    assert whole.verdict == "proved"
    found = list(_endings(lambda deadline: certify(replace(task), answer, deadline=deadline), limit))
    assert len(found) > 3
    for certificate in found:
        assert certificate.verdict in ("undecided", "proved")
        assert verdicts(certificate).keys() >= verdicts(whole).keys()
        if certificate.verdict == "proved":
            assert verdicts(certificate) == verdicts(whole)
        for claim in certificate.claims:
            assert claim.verdict != "undecided" or "limit" in claim.reason or "memory" in claim.reason
    if limit == "time":
        assert "proved" not in verdicts(found[0]).values()


@pytest.mark.parametrize("limit", ["time", "memory, for a moment"])
@pytest.mark.parametrize("name", [name for name in DOCTORED if name not in ANOTHER_TASK])
def test_wrong_answers_are_never_proved(name: str, limit: str) -> None:
    task, answer = DOCTORED[name].make()
    make, once = LIMITS[limit]
    for looks in (0, 3, 10, 20, 30, 45, 100, 400):
        certificate = certify(replace(task), answer, deadline=Countdown(looks, make, once=once))
        assert certificate.verdict in ("undecided", "refuted")


@pytest.mark.parametrize("encoding", ["automata", "paper"])
@pytest.mark.parametrize("limit", LIMITS)
@pytest.mark.parametrize("mode", ["serendipity", "communication"])
def test_solving_ends_with_a_proved_answer_or_none(mode: str, limit: str, encoding: str) -> None:
    task = case_4() if encoding == "automata" else case_10()
    options = Options(mode=mode, discount="0.9", horizon=8)  # type: ignore[arg-type]
    best = solve(task, options)
    for found in _endings(
        lambda deadline: solve(replace(task), options, encoding=encoding, deadline=deadline), limit
    ):
        assert found.status == "unknown" or (found.status, found.cost) == ("optimal", best.cost)
        assert found.status != "unknown" or found.reason


@pytest.mark.long
@pytest.mark.parametrize("limit", LIMITS)
@pytest.mark.parametrize("name", NAMES)
def test_the_quick_check_says_what_it_did_not_examine(name: str, limit: str) -> None:
    task, answer = _answered(name)
    whole = serendipity.check(task, answer)
    for certificate in _endings(
        lambda deadline: serendipity.check(replace(task), answer, deadline=deadline), limit
    ):
        late = [claim for claim in certificate.claims if "limit" in claim.reason or "memory" in claim.reason]
        assert all(claim.verdict == "undecided" for claim in late)
        assert certificate.verdict == ("undecided" if late else whole.verdict)
