"""Whenever the time runs out, a call ends with what it knows: never with an exception, nor half an answer."""

from dataclasses import replace
from typing import Any

import pytest

import serendipity
from search import PreparedTask, solve
from search.engine import best_first
from serendipity import LimitReachedError, Task
from serendipity.facade.interruptibility import Interruption, InterruptionReport
from serendipity.model import Result
from serendipity.model.options import Options
from serendipity.model.resources.deadline import Deadline
from serendipity_testing.builders import task as build
from serendipity_testing.cases import case_2, case_4
from serendipity_testing.countdown import Countdown, time_is_up
from tests.endings import answers

CALLS: list[dict[str, Any]] = [
    {"mode": "individual"},
    {"discount": "0.5"},
    {"discount": "0.5", "window_weight": 0},
    {"discount": "0.5", "preservation": "state"},
    {"mode": "communication", "discount": "0.9", "communication_weight": 1},
    {"mode": "communication", "discount": "0.9", "keep_prefix": True},
    {"mode": "composite", "discount": "0.5"},
    {"mode": "composite", "discount": "0.5", "horizon": "inf"},
    {"human_model": "observant", "discount": "0.5"},
    {"human_model": "local", "discount": "0.5"},
    {"discount": "0.9", "ties": "robust"},
    {"discount": "0.9", "ties": "optimistic"},
    {"discount": "0.9", "ties": "expected"},
    {"mode": "assistance", "ties": "optimistic"},
    {"mode": "assistance", "ties": "robust"},
    {"mode": "assistance", "ties": "expected"},
]


@pytest.mark.parametrize(
    ("task", "error", "reason"),
    [
        (case_2(), time_is_up(), "time-limit"),
        (case_4(), time_is_up(), "time-limit"),
        (case_2(), LimitReachedError("memory-limit"), "memory-limit"),
        (case_4(), MemoryError(), "memory-limit"),
    ],
    ids=["case 2", "case 4", "memory", "no memory at all"],
)
@pytest.mark.parametrize("options", CALLS, ids=str)
def test_time_may_run_out_at_any_look(
    task: Task, options: dict[str, Any], error: Exception, reason: str
) -> None:
    # A copy of the task knows nothing yet.
    *early, last = answers(
        lambda deadline: serendipity.plan(replace(task), deadline=deadline, **options), lambda: error
    )
    assert len(early) > 3
    assert (early[0].status, early[0].reason) == ("unknown", reason)
    assert last.status == "optimal"
    for answer in early:
        assert answer.status in ("unknown", "feasible", "optimal")
        assert serendipity.check(task, answer).verdict != "refuted"
        if answer.lower_bound is not None and answer.mode != "assistance":
            assert answer.objective is not None
            assert answer.lower_bound <= min(answer.objective, last.objective or 0)


def goals_of(task: Task) -> list[dict[str, Any]]:
    """The human's goal, and that they stand where their plan leads first."""
    own = [task.facts[fact] for fact in task.goal.positive]
    first = task.actions[task.plan_from_names(alone(task))[0]]
    return [{"goal": own, "prior": 3}, {"goal": [task.facts[first.add[0]]], "prior": 1}]


def alone(task: Task) -> tuple[str, ...]:
    return serendipity.plan(task, mode="individual").human_plan


@pytest.mark.parametrize("several", [True, False])
def test_planning_for_goals_may_be_stopped_at_any_look(several: bool) -> None:
    task = case_2()
    goals = goals_of(task)[: 2 if several else 1]

    def call(deadline: Deadline) -> Result:
        return serendipity.plan(
            replace(task), goals=goals, observed=alone(task)[:1], deadline=deadline, discount="0.5"
        )

    *early, last = answers(call)
    assert early[0].status == "unknown"
    assert early[0].goals is None
    assert last.status == "optimal"
    for answer in early:
        if answer.cost is not None:
            assert last.cost is not None and answer.lower_bound is not None and last.objective is not None
            assert last.cost <= answer.cost
            assert answer.lower_bound <= last.objective
            assert answer.recognition.explained


def test_a_posterior_is_whole_or_not_there() -> None:
    task = case_2()
    goals = goals_of(task)

    def call(deadline: Deadline) -> dict[str, Any]:
        return serendipity.recognise(replace(task), goals, alone(task)[:1], deadline=deadline).to_dict()

    found = answers(call)
    assert all(answer == found[-1] for answer in found)


def unmarked(report: InterruptionReport) -> set[Interruption]:
    """The windows; what is informative among them depends on the others."""
    return {replace(window, informative=False) for window in report.windows}


@pytest.mark.parametrize("preservation", ["kernel", "state"])
def test_windows_examined_by_then_are_reported(preservation: str) -> None:
    task = case_2()

    def call(deadline: Deadline) -> InterruptionReport:
        return serendipity.interruptions(
            replace(task), discount="0.5", preservation=preservation, deadline=deadline
        )

    *early, last = answers(call)
    assert last.complete
    assert len({len(report.windows) for report in early}) >= 5
    for report in early:
        assert (report.limit, report.to_dict()["complete"]) == ("time-limit", False)
        assert unmarked(report) < unmarked(last)
        assert report.interruptible in (None, last.interruptible)
        if preservation == "kernel" and report.windows:
            assert report.interruptible is not None


@pytest.mark.parametrize("options", [{"discount": "0.5"}, {}, {"mode": "composite", "discount": "0.5"}])
def test_an_explanation_says_what_it_leaves_out(options: dict[str, Any]) -> None:
    task = case_2()
    found = answers(lambda deadline: serendipity.explain(replace(task), deadline=deadline, **options))
    last = found[-1]
    assert last.complete
    assert "limit" not in dict(last.sentences)
    for explanation in found[:-1]:
        if explanation.complete:
            assert explanation.sentences == last.sentences
        elif explanation.answer.status == "optimal":
            assert explanation.limit == "time-limit"
            told = [sentence for sentence in explanation.sentences if sentence[0] != "limit"]
            assert set(told) <= set(last.sentences)
            assert not {topic for topic, _ in told} & set(explanation.left_out)
            assert [topic for topic, _ in explanation.sentences].count("limit") == 1
        else:
            assert not explanation.moments and explanation.discount is None and not explanation.misses


@pytest.mark.long
@pytest.mark.parametrize("human_model", ["observant", "local"])
def test_the_epochs_played_by_then_are_told(human_model: str) -> None:
    task = case_2()
    result = serendipity.plan(task, discount="0.5")

    def call(deadline: Deadline) -> serendipity.Trace:
        return serendipity.simulate(replace(task), result, human_model, deadline=deadline)

    *early, last = answers(call, sparser=0)
    assert last.complete
    assert {len(trace.epochs) for trace in early} >= {1, len(last.epochs) - 1}
    for trace in early:
        assert (trace.limit, trace.goals_hold) == ("time-limit", None)
        assert trace.epochs == last.epochs[: len(trace.epochs)]
        assert trace.realised in (None, last.realised)


def test_a_verdict_that_is_not_reached_is_missing() -> None:
    found = answers(lambda deadline: serendipity.plan(case_2(), discount="0.5", deadline=deadline))
    with_plan = [answer for answer in found if answer.plan]
    assert {tuple(answer.realised) for answer in with_plan} == {(), ("observant",)}


def test_a_session_ends_with_its_deadline() -> None:
    session = serendipity.Session(case_2(), discount="0.5", deadline=Deadline(time_limit=0))
    assert session.plan().status == "unknown"
    assert session.plan(deadline=None).status == "optimal"
    assert session.plan(deadline=None, time_limit=0).status == "optimal"  # which is known by now
    assert session.plan(deadline=None, time_limit=0, discount=0).status in ("unknown", "feasible")


@pytest.mark.parametrize("suffix", ["replan", "subplan"])
def test_a_better_answer_is_whole_or_not_there(suffix: str) -> None:
    """It was there as soon as its cost was known; what the human does at the end was not yet found."""
    task = build(
        init="p0",
        goal="p6",
        actions={
            **{f"walk{i} h": f"p{i} -> p{i + 1} !p{i} @ 2" for i in range(6)},
            **{f"run{i} h": f"p{i} -> p{i + 1} !p{i} @ 2" for i in range(6)},
            "jump h": "p1 open -> p3 !p1 @ 1",
            "open r": "-> open @ 0",
        },
    )

    def call(deadline: Deadline) -> Result:
        return serendipity.plan(replace(task), suffix=suffix, window_weight=1, deadline=deadline)

    found = answers(call, sparser=0)
    assert found[-1].opportunity
    for answer in found:
        assert serendipity.check(task, answer).verdict != "refuted"


STEPS = {f"step{k} r": f"on{k} -> on{k + 1}" for k in range(3)}


@pytest.mark.parametrize(
    ("task", "options"),
    [
        (build(init="on0", goal="on3 done", actions={**STEPS, "do h": "on2 -> done"}), {"mode": "composite"}),
        (
            build(init="on0", goal="done", robot_goal="on3", actions={**STEPS, "do h": "-> done"}),
            {"human_model": "observant", "horizon": 4},
        ),
    ],
    ids=["no plan alone", "robots have goals"],
)
def test_no_plan_is_not_said_to_be_feasible(
    task: Task, options: dict[str, Any], monkeypatch: pytest.MonkeyPatch
) -> None:
    """It was, where the bound rose before there was any plan."""
    monkeypatch.setattr(best_first, "_PATIENCE", 0)  # every rise is reported
    *early, last = serendipity.plan_anytime(task, **options)
    assert last.status == "optimal"
    assert "unknown" in {answer.status for answer in early}
    for answer in early:
        assert (answer.status == "feasible") == (answer.plan is not None)


def test_a_given_plan_is_answered_where_nothing_was_prepared() -> None:
    """The limit may come before the human's own searches are there to be asked for a better plan."""
    walks = {f"walk{i} hum": f"at{i} -> at{i + 1} !at{i}" for i in range(3)}
    stroll = build(agents="hum", human="hum", init="at0 home", goal="home", actions=walks)
    plan = ["walk0 hum", "walk1 hum", "walk2 hum"]
    prepared = [PreparedTask(replace(stroll)) for _ in range(100)]
    given = stroll.plan_from_names(plan)
    for looks, one in enumerate(prepared):
        answers = list(solve(one, Options(mode="individual"), human_plan=given, deadline=Countdown(looks)))
        assert answers[-1].status in ("optimal", "feasible", "unknown")
    assert answers[-1].status == "optimal"
