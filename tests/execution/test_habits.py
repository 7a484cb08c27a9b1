"""Habits: plans counted in logs, by hand; what is wrong with logs is said in one line."""

from fractions import Fraction
from pathlib import Path

import pytest

import serendipity
from serendipity.execution import as_text, learn
from serendipity.execution.habits import read_episodes, wilson
from serendipity.model import InputError, UsageError
from serendipity.recognition import plan_library
from serendipity_testing.builders import task as build
from tests.cli.conftest import Runs, assert_one_line

HOME = build(
    init="up",
    actions={
        "wash h": "up -> clean",
        "make h": "up -> coffee",
        "drink h": "coffee -> !coffee fed",
        "help h r": "-> fed",
        "make r": "-> coffee",
    },
)

DAYS = """day,time,actor,action
2026-03-02,7:00,h,(make h)
2026-03-02,07:10,h,drink h
2026-03-02,07:12,r,make r
2026-03-03,07:00,H,make h
2026-03-03,07:05,h,drink h
2026-03-07,09:00,h,wash h
2026-03-08,09:30,h,drink h
"""
"""Monday and Tuesday coffee, Saturday a wash, and Sunday what can't be done alone."""


@pytest.fixture
def days(tmp_path: Path) -> Path:
    file = tmp_path / "days.csv"
    file.write_text(DAYS)
    return file


def test_frequencies_by_hand(days: Path) -> None:
    found = learn(HOME, days)
    coffee, wash = found.plans
    assert (found.episodes, found.fitting, found.left_out) == (4, 3, 1)
    assert found.reason == "human plan, step 1: 'drink h' is not applicable: 'coffee' is false"
    assert (coffee.plan, coffee.goal, coffee.count) == (("make h", "drink h"), ("fed",), 2)
    assert (coffee.probability, wash.probability) == pytest.approx((2 / 3, 1 / 3))
    assert coffee.interval == pytest.approx((0.2077, 0.9385), abs=1e-4)


def test_what_is_asked_for_counts_and_all_days_count_a_little(days: Path) -> None:
    coffee, wash = learn(HOME, days, on="weekday").plans
    assert (coffee.probability, wash.probability) == pytest.approx(((2 + 2 / 3) / 3, (1 / 3) / 3))
    assert (coffee.count, wash.count, wash.interval[0]) == (2, 0, 0)
    assert learn(HOME, days, on="weekday", usual=0).plans[0].probability == 1
    assert learn(HOME, days, at="9:45").plans[0].plan == ("wash h",)
    nobody_knows = learn(HOME, days, on="sun")
    assert (nobody_knows.fitting, nobody_knows.plans[0].interval) == (0, (0, 1))
    assert [one.probability for one in nobody_knows.plans] == pytest.approx([2 / 3, 1 / 3])


def test_a_learnt_library_can_be_read(days: Path) -> None:
    library = plan_library(HOME, learn(HOME, days).to_dict())
    assert [one.probability for one in library] == [Fraction(2, 3), Fraction(1, 3)]
    assert [one.literals for one in library] == [("fed",), ("clean",)]


def test_activities_follow_each_other(tmp_path: Path) -> None:
    file = tmp_path / "days.csv"
    rows = ["2026-03-02T07:00,h,wash h,wash", "2026-03-02T07:01,h,make h,coffee"]
    rows += ["2026-03-02T07:09,h,drink h,coffee", "2026-03-03T07:00,h,make h,coffee"]
    file.write_text("\n".join(["Time, Actor, Action, Activity", *rows]))
    first, second, third = read_episodes(HOME, file)
    assert [one.activity for one in (first, second, third)] == ["wash", "coffee", "coffee"]
    assert [one.before for one in (first, second, third)] == ["nothing", "wash", "nothing"]
    assert (second.minute, second.weekday, third.weekday) == (421, 0, 1)
    found = learn(HOME, file, after="wash", usual=0)
    assert [(one.name, one.probability) for one in found.plans] == [
        ("coffee 2", 1),
        ("wash 1", 0),
        ("coffee 3", 0),
    ]


def test_logs_of_executions_are_episodes(tmp_path: Path) -> None:
    """Where robots do not help, everybody follows plans of their own."""
    task = serendipity.example("room2")
    file = tmp_path / "runs.jsonl"
    runs = serendipity.execute(task, "observant", runs=2, discount=0)
    file.write_text("".join(map(as_text, runs.logs)))
    (one,) = learn(task, file).plans
    assert (one.count, one.goal, one.plan) == (2, None, serendipity.plan(task).human_plan)


def test_one_is_said_of_one(tmp_path: Path) -> None:
    file = tmp_path / "days.csv"
    file.write_text("day,time,actor,action\n1,7:00,h,make h\n")
    (said, *_) = learn(HOME, file).told()
    assert said.text == "1 episode of h, 1 fit, 1 plan"


def test_wilson_at_its_ends() -> None:
    assert wilson(0, 10) == pytest.approx((0, 0.2775), abs=1e-4)
    assert wilson(10, 10) == pytest.approx((0.7225, 1), abs=1e-4)
    assert wilson(0, 0) == (0, 1)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("day,time,action\n", "days.csv:1: expected columns day, time, actor and action, got no 'actor'"),
        ("", "days.csv:1: expected columns"),
        ("day,action,time,actor,action\n", "days.csv:1: expected each column once, got day, action"),
        ("day,time,actor,action\n1,7:00,h\n", "days.csv:2: expected 4 columns"),
        ("day,time,actor,action\n1,7:00,h,make h,5\n", "days.csv:2: expected 4 columns"),
        (
            "day,time,actor,action\n1,late,h,make h\n",
            "days.csv:2: time: expected a time as 07:30, got 'late'",
        ),
        ("time,actor,action\n7:00,h,make h\n", "days.csv:2: time: expected a date and a time as"),
        ("day,time,actor,action\n1,7:00,x,make h\n", "days.csv:2: actor: expected one of h, r, got 'x'"),
        ("day,time,actor,action\n1,7:00,h,fly h\n", "days.csv:2: action: there is no action 'fly h'"),
        ("day,time,actor,action\n1,7:00,h,drink h\n", "days.csv: expected a plan that h can follow: human"),
        (f"day,time,actor,action\n1,7:00,h,{'x' * 200_000}\n", "days.csv:1: expected CSV: field larger"),
        ("day,time,actor,action\n", "days.csv: expected a plan that h can follow"),
        ('{"schema": "serendipity.execution/1"}\n{"human": "fly h"}', "days.csv:2: action: there is no"),
        ("day,time,actor,action\n2026-13-02,7:00,h,make h\n", "days.csv:2: day: expected a date as"),
        ('{"schema": "serendipity.execution/1"}\n{"event": "x"}', "days.csv:2: log: expected an epoch, a"),
        ('{"schema": "serendipity.execution/1"}\n{"human": 3}', "days.csv:2: action: there is no"),
    ],
)
def test_what_is_wrong_with_logs_is_said(text: str, message: str, tmp_path: Path) -> None:
    file = tmp_path / "days.csv"
    file.write_text(text)
    with pytest.raises(InputError) as caught:
        learn(HOME, file)
    assert str(caught.value).replace(f"{tmp_path}/", "").startswith(message)


@pytest.mark.parametrize(
    ("asked", "message"),
    [
        ({"on": "today"}, "on: expected one of mon, tue"),
        ({"at": "late"}, "at: expected a time of day as 7:30, got 'late'"),
        ({"on": "sun", "usual": 0}, "usual: expected a number above 0, since no episode fits"),
        ({"after": "breakfast"}, "after: expected logs that say activities"),
        ({"usual": -1}, "usual: expected a number of at least 0"),
    ],
)
def test_what_is_wrong_with_questions_is_said(asked: dict[str, str], message: str, days: Path) -> None:
    with pytest.raises(UsageError, match=message):
        learn(HOME, days, **asked)  # type: ignore[arg-type]


def test_the_command_writes_a_library(run: Runs) -> None:
    assert run("execute --example room2 --discount 0 --runs 2 --log days.jsonl").code == 0
    done = run("learn --example room2 days.jsonl -o plans.json")
    assert (done.code, done.out) == (0, "")
    assert len(plan_library(serendipity.example("room2"), Path("plans.json"))) == 1
    assert "2 episodes of commx" in run("learn --example room2 days.jsonl --on weekday").out
    assert_one_line(run("learn --example room2 days.jsonl --at noon"), "at: expected a time of day")


def test_waiting_in_a_log_is_no_action(tmp_path: Path) -> None:
    file = tmp_path / "days.csv"
    rows = (
        "1,7:00,h,noop\n2,7:00,h,make h\n2,7:05,h,noop\n2,7:10,h,drink h\n3,7:00,h,make h\n3,7:05,h,drink h\n"
    )
    file.write_text(f"day,time,actor,action\n{rows}")
    found = learn(HOME, file)
    assert (found.episodes, [(one.plan, one.count) for one in found.plans]) == (
        2,
        [(("make h", "drink h"), 2)],
    )


def test_rows_are_in_order_to_the_second_and_a_day_ends_at_midnight(tmp_path: Path) -> None:
    file = tmp_path / "days.csv"
    rows = "1,23:45:30,h,drink h\n1,23:45:10,h,make h\n2,12:00,h,wash h\n"
    file.write_text(f"day,time,actor,action\n{rows}")
    found = learn(HOME, file, at="0:30")
    assert (found.left_out, found.fitting) == (0, 1)
    assert found.plans[0].plan == ("make h", "drink h")


def test_where_there_is_time_plans_have_their_epochs(tmp_path: Path) -> None:
    task = serendipity.example("morning")
    file = tmp_path / "logs.jsonl"
    runs = serendipity.execute(task, discount=0)
    file.write_text("".join(map(as_text, runs.logs)))
    (one,) = learn(task, file).plans
    assert one.plan == serendipity.plan(task, mode="individual").human_entries
    answer = serendipity.plan(task, plans=learn(task, file).to_dict(), discount=0)
    assert (answer.status, answer.human_plan_times.starts[0]) == ("optimal", 4)


def test_questions_of_other_types_are_refused(tmp_path: Path, days: Path) -> None:
    for wrong in ({"on": 3}, {"on": ["mon"]}, {"at": 730}, {"after": 3}):
        with pytest.raises(UsageError, match=f"{next(iter(wrong))}: expected a text"):
            learn(HOME, days, **wrong)
    with pytest.raises(UsageError, match="traces: expected a path"):
        learn(HOME, None)
    file = tmp_path / "named.csv"
    file.write_text("day,time,actor,action,activity\n1,7:00,h,make h,breakfast\n")
    with pytest.raises(UsageError, match="after: expected one of nothing, breakfast, got 'lunch'"):
        learn(HOME, file, after="lunch")
