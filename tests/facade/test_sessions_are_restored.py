"""A session that is written down goes on elsewhere as it would have here."""

import json
from typing import Any

import pytest

import serendipity
from serendipity import InputError, Session, UsageError
from serendipity_testing.builders import task as build


def begun() -> Session:
    """A session two epochs after its first answer."""
    session = Session(serendipity.example("room2"), discount="0.9", time_limit=20)
    answer = session.plan()
    for epoch in (1, 2):
        session.execute(step.action for step in answer.plan or () if step.epoch == epoch)
    return session


def written(session: Session) -> dict[str, Any]:
    """A snapshot that has been to a file."""
    read: dict[str, Any] = json.loads(json.dumps(session.snapshot()))
    return read


def test_a_restored_session_goes_on_where_the_other_stood() -> None:
    session = begun()
    restored = Session.restore(serendipity.example("room2"), written(session))
    assert restored.task.init == session.task.init
    assert (restored.human_plan, restored.rest) == (session.human_plan, session.rest)
    assert written(restored) == written(session)
    answer = restored.plan()
    assert (answer.status, answer.statistics["expanded"]) == ("optimal", 0)
    assert answer.cost == session.plan().cost
    assert restored.plan(discount=0).options.time_limit == 20


def test_options_of_the_snapshot_give_way() -> None:
    restored = Session.restore(serendipity.example("room2"), written(begun()), discount=0)
    assert restored.plan().options.discount == 0


def test_a_goal_and_facts_that_were_seen_are_kept() -> None:
    task = serendipity.example("room2")
    session = Session(task)
    session.set_goal(["conducted_triage commx room3"])
    session.change({"at robot room4": False, "at robot room2": True})
    restored = Session.restore(task, written(session))
    assert (restored.task.init, restored.task.goal) == (session.task.init, session.task.goal)
    assert restored.plan().cost == session.plan().cost


def test_a_head_start_of_a_call_is_kept() -> None:
    task = serendipity.example("office")
    late = [(epoch + 4, name) for epoch, name in serendipity.plan(task).human_entries or ()]
    session = Session(task, human_plan=late)
    session.plan(head_start=3)
    restored = Session.restore(task, written(session))
    for _ in range(4):
        session.execute([])
        restored.execute([])
        assert restored.human_plan == session.human_plan
        assert written(restored) == written(session)


def test_what_is_no_snapshot_of_the_task_is_refused() -> None:
    whole = written(begun())
    with pytest.raises(InputError, match=r"snapshot: it is of another task"):
        Session.restore(serendipity.example("parcels"), whole)
    with pytest.raises(InputError, match=r"snapshot: schema: 'serendipity.session/9' is newer"):
        Session.restore(serendipity.example("room2"), {**whole, "schema": "serendipity.session/9"})
    with pytest.raises(serendipity.PlanError, match="human plan, step 1: there is no action 'x' in the task"):
        Session.restore(serendipity.example("room2"), {**whole, "human_plan": ["x"]})
    wrong = {"facts": 3, "goal": None, "options": [], "answers": [{}], "predicted": None, "human_plan": 7}
    for name in wrong:
        for bad in ({k: v for k, v in whole.items() if k != name}, {**whole, name: wrong[name]}):
            with pytest.raises(InputError) as caught:
                Session.restore(serendipity.example("room2"), bad)
            assert "\n" not in str(caught.value)
    for more, message in (
        ({"facts": ["at robot nowhere"]}, "snapshot: there is no fact 'at robot nowhere'"),
        ({"goal": ["nothing"]}, "snapshot: there is no fact 'nothing'"),
        ({"predicted": 3}, "snapshot: predicted: expected true or false, got 3"),
        ({"outdated": "no"}, "snapshot: outdated: expected true or false, got 'no'"),
        ({"options": {"discount": 7}}, "snapshot: discount: expected a number"),
        ({"options": {"luck": 7}}, "snapshot: unknown option 'luck'"),
        ({"options": {"visible": 7}}, "snapshot: unknown option 'visible'"),
    ):
        with pytest.raises(InputError, match=message):
            Session.restore(serendipity.example("room2"), {**whole, **more})
    with pytest.raises(UsageError, match="unknown option 'luck'"):
        Session.restore(serendipity.example("room2"), whole, luck=7)  # type: ignore[call-arg]


@pytest.mark.parametrize(
    ("wrong", "message"),
    [
        ({"bound": "1/0"}, "bound: expected a finite number, got '1/0'"),
        ({"bound": "1e999999999"}, "bound: expected a finite number of at most 4000 digits"),
        ({"bound": "9" * 5000}, "bound: expected a finite number of at most 4000 digits"),
        ({"bound": [1]}, "bound: expected a finite number"),
        ({"horizon": "x"}, "horizon: expected a whole number"),
        ({"horizon": 1.5}, "horizon: expected a whole number"),
        ({"is_sure": "x"}, "is_sure: expected true or false, got 'x'"),
        ({"is_best": 1}, "is_best: expected true or false, got 1"),
        ({"unsure": 1}, "unsure: expected true or false, got 1"),
        ({"steps": [[0, 0]]}, "epoch: expected a whole number from 1 to 1000000, got 0"),
        ({"steps": [[1, -1]]}, "action: expected a whole number"),
        ({"steps": [[1]]}, "expected what Session.snapshot"),
        ({"window": {"start": 1.5, "end": 2}}, "start: expected a whole number"),
        ({"window": {"start": 2, "end": 2}}, "window: expected 1 <= start < end"),
        ({"human_plan": [3]}, "human plan: expected a list of names"),
    ],
)
def test_a_wrong_answer_in_a_snapshot_is_refused_at_once(wrong: dict[str, object], message: str) -> None:
    whole = written(begun())
    whole["answers"][0] |= wrong
    with pytest.raises(InputError, match=f"^snapshot: {message}") as caught:
        Session.restore(serendipity.example("room2"), whole)
    assert "\n" not in str(caught.value)


def test_that_the_last_answer_leaves_no_rest_is_kept() -> None:
    task = serendipity.example("room2")
    goals = [{"goal": ["conducted_triage commx room1"], "prior": 1}]
    for last, rest in (({"mode": "assistance"}, None), ({"goals": goals}, None), ({}, 15)):
        session = Session(task, discount=0.6)
        session.plan()
        session.plan(**last)
        restored = Session.restore(task, written(session))
        assert restored.rest == session.rest
        assert (None if session.rest is None else len(session.rest)) == rest
        assert written(restored) == written(session)
        assert restored.plan().statistics["expanded"] == 0, "the first answer is known as well"


def test_an_empty_rest_is_kept() -> None:
    task = build(goal="done", init="done", actions={"do h": "-> done"})
    session = Session(task, discount=0.6)
    session.plan()
    assert Session.restore(task, written(session)).rest == session.rest == ()


def test_older_snapshots_tell_of_answers_with_a_rest_only() -> None:
    whole = written(begun())
    assert [*whole["answers"][0]] == ["options", "human_plan", *_OF_AN_ANSWER]
    assert Session.restore(serendipity.example("room2"), whole).rest


_OF_AN_ANSWER = ("steps", "names", "window", "is_sure", "bound", "is_best", "horizon")


def test_what_is_proved_for_one_view_is_not_taken_over_for_another() -> None:
    task = serendipity.example("room2")
    session = Session(task, human_model="local", discount=0.6)
    session.plan(visible=lambda *_: False)
    assert [answer["bound"] for answer in written(session)["answers"]] == [None]


def test_that_a_predicted_plan_is_outdated_is_kept() -> None:
    task = build(
        agents="ann rob",
        human="ann",
        init="out",
        goal="in",
        actions={
            "climb ann": "out -> in !out @ 5",
            "sit ann": "out -> seated !out @ 5",
            "enter ann": "open out -> in !out @ 1",
            "open rob": "-> open",
        },
    )
    session = Session(task)
    session.plan()
    session.execute(["open rob"])
    session.plan()  # nothing helps beside the plan from before the door was open
    restored = Session.restore(task, written(session))
    assert written(restored) == written(session)
    assert restored.plan().cost == session.plan().cost == 1


def test_what_can_not_be_written_is_refused() -> None:
    task = build(goal="done", actions={"do h": "-> done", "help r": "-> done"})
    with pytest.raises(UsageError, match="snapshot: visible is no plain value"):
        Session(task, visible=lambda *_: True).snapshot()
