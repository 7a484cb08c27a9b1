"""Whenever a limit comes there is a certificate: what was not examined is undecided, nothing is wrong."""

from collections.abc import Callable, Iterator
from dataclasses import replace
from functools import cache
from typing import Any

import pytest

import serendipity
from serendipity.model import Certificate, LimitReachedError, Options, Result, Task
from serendipity.testing.cases import case_2, case_4, case_5, case_8, case_10
from serendipity.testing.countdown import Countdown
from tests.search.modes.goals.test_worked_cases import helped, workshop
from tests.verify.doctored import ANOTHER_TASK, DOCTORED
from verify.calls.solve import solve
from verify.certificate.certify import certify

CALLS: dict[str, tuple[Callable[[], Task], dict[str, Any]]] = {
    "individual": (case_4, {"mode": "individual"}),
    "help": (case_4, {"discount": "0.9"}),
    "no help": (case_4, {"discount": "0.5"}),
    "K = 0": (case_2, {"discount": "0.5", "window_weight": 0}),
    "state preserved": (case_4, {"discount": "0.9", "preservation": "state"}),
    "subplan": (case_4, {"discount": "0.9", "suffix": "subplan", "interference": "strict"}),
    "communication": (case_4, {"mode": "communication", "discount": "0.9", "communication_weight": 1}),
    "prefix kept": (case_4, {"mode": "communication", "discount": "0.9", "keep_prefix": True}),
    "composite": (case_2, {"mode": "composite", "discount": "0.5"}),
    "composite without horizon": (case_2, {"mode": "composite", "discount": "0.5", "horizon": "inf"}),
    "observant": (case_4, {"human_model": "observant", "discount": "0.5"}),
    "local": (case_4, {"human_model": "local", "discount": "0.9"}),
    "ties": (case_4, {"discount": "0.9", "ties": "robust"}),
    "infeasible": (case_8, {}),
    "assistance": (case_5, {"mode": "assistance", "ties": "robust"}),
}
LIMITS: dict[str, tuple[Callable[[], Exception], bool]] = {
    "time": (lambda: LimitReachedError("time-limit"), False),
    "memory, for a moment": (lambda: LimitReachedError("memory-limit"), True),
    "no memory, for a moment": (MemoryError, True),
}


@cache
def _answered(name: str) -> tuple[Task, Result]:
    if name == "goals":
        task = workshop("!q -> z @ 5")
        return task, helped(task, 1, 1)
    make, options = CALLS[name]
    return make(), serendipity.plan(make(), **options)


def _verdicts(certificate: Certificate) -> list[tuple[str, str]]:
    return [(claim.claim, claim.verdict) for claim in certificate.claims]


def _until_none_comes(examine: Callable[[Countdown], Any], limit: str) -> Iterator[Any]:
    """What an examination comes to if the limit comes at the first look, the second one, and so on."""
    make, once = LIMITS[limit]
    looks = 0
    while True:
        deadline = Countdown(looks, make, once=once)
        found = examine(deadline)
        if not deadline.ran_out:
            return
        yield found
        looks = max(looks + 1, looks * 6 // 5)  # each of the first ones, then fewer of them


@pytest.mark.long
@pytest.mark.parametrize("limit", LIMITS)
@pytest.mark.parametrize("name", [*CALLS, "goals"])
def test_right_answers_are_never_refuted_and_never_proved_by_halves(name: str, limit: str) -> None:
    task, answer = _answered(name)
    whole = certify(task, answer)
    assert whole.verdict == "proved"
    found = list(_until_none_comes(lambda deadline: certify(replace(task), answer, deadline=deadline), limit))
    assert len(found) > 3
    for certificate in found:
        assert certificate.verdict in ("undecided", "proved")
        assert {claim.claim for claim in certificate.claims} >= {claim.claim for claim in whole.claims}
        if certificate.verdict == "proved":
            assert _verdicts(certificate) == _verdicts(whole)
        for claim in certificate.claims:
            assert claim.verdict != "undecided" or "limit" in claim.reason or "memory" in claim.reason
    if limit == "time":
        assert all(verdict != "proved" for _, verdict in _verdicts(found[0]))


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
    for found in _until_none_comes(
        lambda deadline: solve(replace(task), options, encoding=encoding, deadline=deadline), limit
    ):
        assert found.status == "unknown" or (found.status, found.cost) == ("optimal", best.cost)
        assert found.status != "unknown" or found.reason


@pytest.mark.long
@pytest.mark.parametrize("limit", LIMITS)
@pytest.mark.parametrize("name", [*CALLS, "goals"])
def test_the_quick_check_says_what_it_did_not_examine(name: str, limit: str) -> None:
    task, answer = _answered(name)
    whole = serendipity.check(task, answer)
    for certificate in _until_none_comes(
        lambda deadline: serendipity.check(replace(task), answer, deadline=deadline), limit
    ):
        late = [claim for claim in certificate.claims if "limit" in claim.reason or "memory" in claim.reason]
        assert all(claim.verdict == "undecided" for claim in late)
        assert certificate.verdict == ("undecided" if late else whole.verdict)
