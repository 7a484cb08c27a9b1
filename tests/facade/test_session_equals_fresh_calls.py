"""A session answers what a fresh call on the same state answers, and keeps the human's plan."""

import pytest

from serendipity import PlanError, Session, UsageError
from serendipity.testing.cases import case_1
from tests.facade.test_sessions_in_time import fresh, same


def test_a_fact_that_changes_and_a_new_goal() -> None:
    session = Session(case_1(), discount=0.9)
    assert session.plan().cost == 8.4
    session.change({"at k2 r2": False, "at k2 r": True})
    nearer = session.plan()
    assert nearer.cost is not None
    assert nearer.cost < 8.4
    assert same(nearer, fresh(session, discount=0.9))
    session.set_goal(["at h s"])
    assert session.plan().cost == 6
    with pytest.raises(UsageError, match="there is no fact 'at h nowhere'"):
        session.set_goal(["at h nowhere"])
    with pytest.raises(UsageError, match="not applicable"):
        session.execute(["move h d g"])


def test_his_plan_goes_on_behind_his_action_and_waiting_is_none() -> None:
    session = Session(case_1(), discount=0.6)
    predicted = session.plan().human_plan
    session.execute([predicted[0]])
    assert session.human_plan == predicted[1:]
    session.execute(["move h a1 a0"])
    assert session.human_plan is None
    given = Session(case_1(), human_plan=["noop", *predicted], discount=0.6)
    given.plan()
    given.execute([predicted[0]])
    assert given.human_plan == predicted[1:]


def test_a_given_plan_need_not_work_before_what_was_seen_is_told() -> None:
    predicted = Session(case_1(), discount=0.6).plan().human_plan
    assert predicted is not None
    elsewhere = case_1().at(case_1().init - {case_1().facts.index("at h a0")})
    session = Session(elsewhere, human_plan=predicted, discount=0.6)
    with pytest.raises(PlanError):
        session.plan()
    assert session.human_plan == predicted
    session.change({"at h a0": True})
    assert session.human_plan == predicted
    assert same(session.plan(), fresh(session, discount=0.6))
    session.change({"at h a0": False})
    assert session.human_plan is None
