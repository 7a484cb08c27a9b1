"""An answer that a limit cut short claims no more than is known by then."""

from dataclasses import replace
from typing import Any

import pytest

import serendipity
from serendipity import Task
from serendipity.model import Result
from serendipity_testing.builders import task as build
from serendipity_testing.countdown import Countdown
from tests.endings import answers


def _detours() -> Task:
    """The given plan goes a long way round; without any robot there is a shorter one, and a still shorter."""
    return build(
        init="p0",
        goal="p4",
        actions={
            **{f"step{i} h": f"p{i} -> p{i + 1} !p{i} @ 3" for i in range(4)},
            **{f"stride{i} h": f"p{i} -> p{i + 1} !p{i} @ 2" for i in range(4)},
            **{f"skip{i} h": f"p{i} -> p{i + 2} !p{i} @ 3" for i in range(3)},
            "carry h r": "p1 near -> p4 !p1 @ 1",
            "come r": "-> near",
        },
    )


OPTIONS: list[dict[str, Any]] = [
    {"window_weight": 0},
    {"window_weight": 0, "suffix": "subplan"},
    {"window_weight": "0.25", "discount": "0.5"},
    {"mode": "communication", "discount": "0.5"},
    {"mode": "communication", "keep_prefix": True, "window_weight": 0, "communication_weight": 1},
    {"mode": "composite", "discount": "0.5", "horizon": "inf"},
    {"human_model": "observant"},
    {"human_model": "local", "discount": "0.9"},
]


def _planned(task: Task, **options: Any) -> list[Result]:
    """The answers wherever time runs out; a copy of the task knows nothing yet."""
    return answers(lambda deadline: serendipity.plan(replace(task), deadline=deadline, **options))


def _wrong(task: Task, answer: Result) -> str | None:
    """What the verifier says of an answer that it does not prove."""
    if answer.status == "unknown":
        wrong = serendipity.verify(task, answer).refuted
        return None if wrong is None else str(wrong)
    certificate = serendipity.verify(task, answer)
    return None if certificate.verdict == "proved" else str(certificate)


@pytest.mark.long
@pytest.mark.parametrize("options", OPTIONS, ids=str)
def test_no_opportunity_before_the_answer_without_robots_is_known(options: dict[str, Any]) -> None:
    """What the human gains alone was taken for help while it was still being looked for."""
    task = _detours()
    *early, last = _planned(task, human_plan=[f"step{i} h" for i in range(4)], **options)
    assert last.status == "optimal"
    assert last.saving_alone
    for answer in early:
        assert answer.saving_alone in (None, last.saving_alone)
        if answer.opportunity:
            assert answer.saving_alone == last.saving_alone
            assert answer.saving is not None
            assert answer.saving > answer.saving_alone
            assert any("r" in step.agents for step in answer.plan or ())
        assert _wrong(task, answer) is None


@pytest.mark.parametrize("mode", ["communication", "composite"])
def test_what_is_out_of_reach_is_infeasible_at_any_limit(mode: str) -> None:
    """The bound was infinite: a proof, and no number to report."""
    task = build(init="p", goal="!p", actions={"do h": "!p -> q !p", "help r": "-> q"})
    options = {"mode": mode, "horizon": 3}
    for limit in (None, 0):
        answer = serendipity.plan(task, time_limit=limit, **options)
        assert (answer.status, answer.reason) == ("infeasible", "no-plan-within-horizon")
        assert answer.lower_bound is None


def test_nothing_to_do_takes_no_window() -> None:
    """The certificate took an epoch of window off an objective that has none."""
    task = build(init="done", goal="done", actions={"do h": "-> done", "help r": "-> done"})
    found = _planned(task, window_weight=2, human_plan=[])
    assert "feasible" in {answer.status for answer in found}
    for answer in found:
        assert _wrong(task, answer) is None


@pytest.mark.parametrize("ties", ["optimistic", "robust", "expected"])
def test_answers_over_ties_are_certified_wherever_time_runs_out(ties: str) -> None:
    """Where nothing was known the certificate asked for a cost; where little was, for the least one."""
    task = build(
        goal="done",
        actions={
            **{f"go{k} h": f"-> on{k}" for k in range(3)},
            **{f"do{k} h": f"on{k} -> done @ 4" for k in range(3)},
            **{f"end{k} h": f"on{k} light -> done @ {1 + k}" for k in range(2)},
            "fetch r": "-> lamp",
            "help r": "lamp -> light",
        },
    )
    found = _planned(task, ties=ties, discount="0.5", horizon=4, window_weight=0)
    assert {answer.status for answer in found} == {"unknown", "feasible", "optimal"}
    for answer in found:
        assert _wrong(task, answer) is None
        if answer.status == "feasible":
            assert (answer.lower_bound or 0) <= (found[-1].objective or 0) <= (answer.objective or 0)


@pytest.mark.long
def test_savings_are_counted_from_the_least_that_doing_nothing_costs() -> None:
    """The first way that robots had found to their goal counted, before the least was known."""
    task = build(
        init="at0",
        goal="at2",
        robot_goal="clean",
        actions={
            "walk0 h": "at0 -> at1 !at0 @ 2",
            "walk1 h": "at1 -> at2 !at1 @ 2",
            "scrub r": "-> clean @ 9",
            "fetch r": "-> brush @ 1",
            "brush r": "brush -> clean @ 1",
            "sweep r": "brush -> swept @ 1",
        },
    )
    for looks in range(0, 60, 2):
        used = replace(task)  # by a call that left some of what it found
        early = Countdown(looks)
        serendipity.plan(used, deadline=early, horizon=4)
        for more in range(60):
            late = Countdown(more)
            answer = serendipity.plan(used, deadline=late, horizon=4)
            assert serendipity.check(task, answer).refuted is None
            if answer.status == "optimal":
                break
