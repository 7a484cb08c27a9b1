"""From the first plan of the human's on there is an answer, whatever limit comes."""

import json
from dataclasses import replace
from functools import partial
from typing import Any

import pytest

import serendipity
from search import PreparedTask, first_answer
from search.kernel.library import library
from search.packed.packed_task import PackedTask
from serendipity import LimitReachedError, Task
from serendipity.cli.text.answers import plan_report
from serendipity.model import Deadline, Options, Result
from serendipity_testing.builders import task as build
from serendipity_testing.countdown import Countdown
from serendipity_testing.generator.families import family_task
from tests.endings import endings

pytestmark = pytest.mark.skipif(library() is None, reason="there is no kernel here")

REPLANS: list[dict[str, Any]] = [{"human_model": "observant"}, {"human_model": "local"}]
TIES: list[dict[str, Any]] = [
    {"ties": "robust"},
    {"ties": "optimistic"},
    {"ties": "expected"},
    {"ties": "robust", "mode": "communication", "communication_weight": 1},
    {"ties": "robust", "human_model": "observant"},
]
SILENT: list[dict[str, Any]] = [{"mode": "assistance"}, {"mode": "assistance", "ties": "robust"}]


def _switches() -> Task:
    return family_task("switches", 4, 6)


def _goals(*sizes: int) -> dict[str, Any]:
    """As many goals, the task's but for some literals."""
    literals = _switches().goal.literals(_switches().facts)
    return {"goals": [{"name": str(size), "goal": literals[:size]} for size in sizes]}


UNSURE = [_goals(3), _goals(2, 3), _goals(1, 2) | {"risk": "worst"}]
ALL: list[dict[str, Any]] = [{}, {"preservation": "state"}, {"horizon": 9}, *REPLANS, *TIES, *SILENT]


def _ended(options: dict[str, Any], *, memory: bool = False) -> list[Result]:
    """What comes of a call that ends at any look: its time is up, or memory is short for once."""

    def call(limit: Deadline) -> Result:
        return serendipity.plan(
            replace(_switches()), deadline=limit, discount="0.5", max_ties=100_000, **options
        )

    limit = partial(LimitReachedError, "memory-limit" if memory else "time-limit")
    found = endings(call, limit, sparser=20, once=memory)
    return [
        ending for ending in found if isinstance(ending, Result)
    ]  # else there was no time even to pack it


def _says(result: Result) -> tuple[Any, ...]:
    return result.status, result.human_plan, result.cost, result.lower_bound, result.saving_alone


@pytest.mark.long
@pytest.mark.parametrize("options", [*ALL, *UNSURE], ids=str)
def test_an_answer_is_not_lost_breaks_no_rule_and_is_not_refuted(options: dict[str, Any]) -> None:
    """Where humans replan, ties count or help is silent there was none before their optimum was proved.

    Memory may be free again after what asked for too much is given up: that loses none either.
    """
    found, again = _ended(options), _ended(options, memory=True)
    last = found[-1]
    assert (found[0].status, last.status) == ("unknown", "optimal")
    for results in (found, again):
        statuses = [result.status for result in results]
        answered = statuses.index(next(status for status in statuses if status != "unknown"))
        assert "unknown" not in statuses[answered:]
    for result in found:
        if result.status != "unknown":
            assert result.lower_bound is not None and last.objective is not None and result.cost is not None
            assert result.lower_bound <= last.objective
            assert (last.cost is not None and last.cost <= result.cost) or result.options.ties == "robust"
    for result in {_says(result): result for result in (*found, *again)}.values():
        assert serendipity.check(_switches(), result).refuted is None
        assert serendipity.verify(_switches(), result, time_limit=5).refuted is None
        assert serendipity.verify(_switches(), result, deadline=Countdown(200)).refuted is None
        written = json.dumps(result.to_dict())
        assert Result.from_dict(json.loads(written)).to_dict() == result.to_dict()


def test_only_the_canonical_plan_is_called_the_human_s_best() -> None:
    """Another one may cost as little, and leave other help to be given."""
    actions = {f"{kind}_{i} h": f"-> p_{i}" for i in range(4) for kind in ("do", "also")}
    goal = " ".join(f"p_{i}" for i in range(4))
    task = build(goal=goal, actions={**actions, "help r": "-> p_3"})
    last, others = serendipity.plan(replace(task)), 0
    for result in endings(lambda limit: serendipity.plan(replace(task), deadline=limit), sparser=0):
        if isinstance(result, Result) and result.human_plan not in (None, last.human_plan):
            others += result.human_cost == last.human_cost
            assert (result.status, result.saving_alone, result.opportunity) == ("feasible", None, False)
    assert others, "no limit came while the canonical plan was looked for"


@pytest.mark.parametrize("options", UNSURE, ids=str)
def test_help_for_several_goals_begins_with_doing_nothing(options: dict[str, Any]) -> None:
    told: list[Result] = []
    last = serendipity.plan(_switches(), on_improvement=told.append, **options)
    assert told[0].status == "feasible" and told[0].recognition is None and last.recognition is not None
    for served in told[0].goals or ():
        assert [step.action for step in served.plan or ()] == list(served.human_plan or ())


def test_what_was_observed_weighs_goals_by_their_optimal_plans_alone() -> None:
    known = serendipity.recognise(_switches(), _goals(3)["goals"]).goals[0].plan
    asked = {"observed": (known or ())[:1], **_goals(2, 3)}
    for found in _ended(asked):
        assert (found.status == "unknown") == (found.recognition is None)


def test_people_are_told_that_the_plan_may_not_be_the_best() -> None:
    """The text spoke of an optimal plan of theirs."""
    for options in (REPLANS[0], TIES[0]):
        result = next(serendipity.plan_anytime(_switches(), max_ties=100_000, **options))
        text = plan_report(_switches(), result, serendipity.check(_switches(), result))
        assert "may have a cheaper plan alone" in text
        assert "optimal plans of the human" not in text


def test_nothing_is_at_hand_where_robots_have_goals() -> None:
    """Whether robots reach theirs beside such a plan is not known."""
    task = build(goal="p", robot_goal="q", actions={"a h": "-> p", "b r": "-> q p"})
    for options in ({"human_model": "observant"}, {"ties": "robust"}):
        first, *_ = serendipity.plan_anytime(task, horizon=2, **options)
        assert first.saving_alone is not None or first.status != "feasible"


@pytest.mark.long
@pytest.mark.parametrize("options", [{}, {"mode": "communication"}, *REPLANS, *TIES], ids=str)
def test_a_plan_that_takes_too_many_epochs_is_no_answer(options: dict[str, Any]) -> None:
    """It was an error where a limit came: that the horizon is too short, which it is for that plan alone."""
    task = _switches()
    known = first_answer(PreparedTask(task), Options(), Deadline())
    best = serendipity.plan(task, mode="individual").human_plan
    assert known.plan is not None and best is not None and len(best) < len(known.plan)
    for result in _ended({**options, "horizon": len(best)}):
        assert serendipity.check(task, result).refuted is None
        assert result.horizon in (None, len(best))


@pytest.mark.long
@pytest.mark.parametrize("options", ALL, ids=str)
def test_what_was_told_on_the_way_is_not_taken_back(options: dict[str, Any]) -> None:
    """In serendipity mode it was: the answer at hand, where a limit came before the human's optimum."""
    told = True
    for looks in range(1000, 0, -7):
        before, told = told, False
        limit = Countdown(looks)
        try:
            answers = list(serendipity.plan_anytime(_switches(), deadline=limit, max_ties=100_000, **options))
        except LimitReachedError:
            continue
        told = answers[-1].cost is not None
        assert told or all(answer.cost is None for answer in answers)
        assert before or not told


def test_several_goals_are_packed_once_before_the_first_answer(monkeypatch: pytest.MonkeyPatch) -> None:
    """It took as long as the files for each of them: 0.7 s for four goals in 84 rooms."""
    packings, answers = list[int](), list[int]()
    pack = PackedTask.__init__

    def counted(self: PackedTask, task: Task, *rest: Any) -> None:
        packings.append(len(answers))
        pack(self, task, *rest)

    monkeypatch.setattr(PackedTask, "__init__", counted)
    serendipity.plan(
        _switches(), time_limit=60, on_improvement=lambda _: answers.append(1), **_goals(1, 2, 3)
    )
    assert packings.count(0) == 1
