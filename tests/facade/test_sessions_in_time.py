"""A session in time: each moment is a task of its own, and is asked about as such."""

import json
from dataclasses import replace
from random import Random
from typing import Final

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import serendipity
from serendipity import PlanError, Result, Script, Session, Task, UsageError
from serendipity.model import Condition
from serendipity.model.task.plans import PlanEntry
from serendipity_testing.builders import task
from serendipity_testing.call import Call
from serendipity_testing.oracle import best
from serendipity_testing.strategies import calls_in_time, timed_tasks
from tests.search.exact_answers import proved


def fresh(session: Session, **options: object) -> Result:
    return serendipity.plan(replace(session.task), human_plan=session.human_plan, **options)


def same(one: Result, other: Result) -> bool:
    return replace(one, statistics={}) == replace(other, statistics={})


def now(answer: Result) -> list[str]:
    """What an answer begins at once."""
    return [step.action for step in answer.plan or () if step.epoch == 1]


@pytest.mark.long
@pytest.mark.parametrize("name", ["morning", "office"])
def test_following_the_answer_epoch_by_epoch(name: str) -> None:
    session = Session(serendipity.example(name), discount=0.5)
    answer = session.plan()
    paid = 0.0
    first = answer.cost
    while not session.task.goal.holds(session.task.init) or session.task.script.deeds:
        paid += sum(step.cost for step in answer.plan or () if step.epoch == 1)
        session.execute(now(answer))
        answer = session.plan()
        assert same(answer, fresh(session, discount=0.5))
        assert session.plan(time_limit=0).cost == answer.cost
    assert paid == first


_FIGURES = ("status", "cost", "objective", "opportunity", "saving", "lower_bound", "horizon", "window")

MODES: Final = ("serendipity", "composite", "individual")


@pytest.mark.long
@settings(max_examples=settings().max_examples // 4)
@given(
    st.one_of(calls_in_time(modes=MODES), calls_in_time(modes=MODES, of=timed_tasks())),
    st.randoms(use_true_random=False),
)
def test_in_each_epoch_it_answers_what_brute_force_does(call: Call, dice: Random) -> None:
    """Also in the middle of actions and head starts, with plans that are followed and others that are not."""
    options, asked = call.options.but(horizon=None), call.keywords(horizon=None)
    session = Session(call.task, human_plan=call.human_entries, **asked)
    for passed in range(3):
        try:
            answer = session.plan()
        except (UsageError, PlanError):
            return
        moment, entries, left = session.task, session.human_plan, max(0, options.head_start - passed)
        again = fresh(session, **{**asked, "head_start": left})
        assert [getattr(answer, name) for name in _FIGURES] == [getattr(again, name) for name in _FIGURES]
        assert answer.saving_alone or session.plan().objective == answer.objective
        if entries is not None:
            plan = moment.plan_from_names(entries, left)
            found = best(moment, options.but(head_start=left), plan)
            cost = None if found.cost is None else float(found.cost)
            assert (answer.status, answer.cost, answer.window) == (found.status, cost, found.window)
        try:
            session.execute(now(answer) if dice.random() < 0.4 else _anything(moment, dice))
        except UsageError:
            return


def _anything(moment: Task, dice: Random) -> list[str]:
    """Something that can begin, rather long than short."""
    possible = [action for action in moment.actions if action.applicable(moment.init)]
    chosen = dice.choices(possible, [action.duration**2 for action in possible]) if possible else []
    return [action.name for action in chosen]


@pytest.mark.parametrize("head_start", [0, 1])
def test_the_rest_of_a_plan_may_wait_at_its_end(head_start: int) -> None:
    """It was said to miss the goal, which what happens anyway brings about."""
    wash = task(goal="on done", actions={"fill h": "-> full", "start h": "full -> on", "aid r": "-> full"})
    session = Session(wash.with_script(Script(facts=[(5, "done")])), head_start=head_start)
    while not session.task.goal.holds(session.task.init):
        answer = session.plan()
        session.execute(now(answer))
        assert answer.cost is not None
        assert session.plan().cost == answer.cost - sum(s.cost for s in answer.plan or () if s.epoch == 1)


def lane() -> Session:
    """A walk of three epochs, a door that opens with epoch 6, and a robot that may open it in two."""
    walk = task(
        init="a",
        goal="c",
        actions={
            "walk h": "a -> !a / b @ 1 [3]",
            "pass h": "b open -> c @ 1",
            "unlock r": " -> open @ 1 [2]",
        },
    )
    return Session(walk.with_script(Script(facts=[(6, "open")])), mode="composite")


def test_what_has_begun_goes_on_and_is_paid() -> None:
    session = lane()
    assert session.plan().cost == 2
    session.execute(["walk h", "unlock r"])
    assert session.plan().cost == 1
    with pytest.raises(UsageError, match=r"'unlock r'.*can't begin in epoch 1: 'unlock r' goes on"):
        session.execute(["unlock r"])
    session.execute([])
    assert "open" in {session.task.facts[fact] for fact in session.task.init}
    assert session.plan().human_entries == ((5, "pass h"),), "as it was predicted"
    session.follow(None)
    assert session.plan().human_entries == ((2, "pass h"),)
    assert session.plan().horizon == 2


def test_what_robots_are_in_the_middle_of_is_waited_for() -> None:
    """The human's own plan reckons with it, as with what bystanders do."""
    ways = {"walk h": "p -> q !p @ 2", "jump h": "p open -> q !p @ 1", "open r": " -> open @ 1 [3]"}
    session = Session(task(init="p", goal="q", actions=ways), mode="individual")
    assert session.plan().cost == 2
    session.execute(["open r"])
    session.follow(None)
    answer = session.plan()
    assert (answer.cost, answer.human_entries) == (1, ((3, "jump h"),))
    assert best(session.task, answer.options, None).cost == 1


def test_the_script_comes_nearer() -> None:
    session = lane()
    session.plan()
    assert session.human_plan == ((1, "walk h"), (7, "pass h"))
    session.execute(["walk h"])
    assert session.human_plan == ((6, "pass h"),)
    assert [(one.epoch, one.true) for one in session.task.script.facts] == [(5, True)]
    session.change({"open": True})
    assert session.plan().cost == 1
    assert session.plan(time_limit=0).status == "optimal"


def test_who_is_late_is_later_by_as_much_and_who_is_early_waits_for_the_rest() -> None:
    plan = [(2, "walk h"), (7, "pass h")]
    late, early = lane(), lane()
    for session in (late, early):
        session.follow(plan)
    early.execute(["walk h"])
    assert early.human_plan == ((6, "pass h"),)
    late.execute([])
    late.execute([])
    assert late.human_plan == ((1, "walk h"), (6, "pass h"))
    late.execute(["unlock r"])
    late.execute(["walk h"])
    assert late.human_plan == ((5, "pass h"),)


def test_what_is_left_of_the_last_answer() -> None:
    session = lane()
    answer = session.plan()
    assert session.rest == answer.plan
    session.execute(now(answer))
    assert [(step.epoch, step.action) for step in session.rest or ()] == [
        (step.epoch - 1, step.action) for step in answer.plan or () if step.epoch > 1
    ]
    session.execute(["unlock r"])
    assert session.rest is None


def test_a_session_in_time_is_restored_with_the_task_that_it_began_with() -> None:
    session = Session(serendipity.example("office"))
    assert Session.restore(session.task, session.snapshot()).task == session.task
    session.execute([])
    with pytest.raises(serendipity.InputError, match=r"expected the task that it began with$"):
        Session.restore(session.task, session.snapshot())
    assert Session.restore(serendipity.example("office"), session.snapshot()).task == session.task
    without = Session(serendipity.example("room2"))
    without.execute([])
    assert Session.restore(without.task, without.snapshot()).task == without.task


def test_what_goes_on_in_a_snapshot_is_something_that_may() -> None:
    session = Session(lane().task)
    session.execute(["walk h"])
    whole = session.snapshot()
    (going,) = whole["time"]["going"]
    for wrong in ({"epochs": 1.5}, {"epochs": -1}, {"epochs": 10**18}, {"variant": -1}, {"variant": True}):
        time = {**whole["time"], "going": [{**going, **wrong}]}
        with pytest.raises(serendipity.InputError, match="snapshot: expected"):
            Session.restore(lane().task, {**whole, "time": time})
    assert Session.restore(lane().task, whole).task.script == session.task.script


def test_a_head_start_is_over_when_so_many_epochs_are() -> None:
    session = Session(lane().task, mode="composite", head_start=2)
    assert session.plan().human_entries == ((3, "walk h"), (7, "pass h"))
    assert session.human_plan == ((1, "walk h"), (5, "pass h")), "from the end of the head start"
    session.execute([])
    assert session.plan().options.head_start == 1
    again = Session.restore(lane().task, json.loads(json.dumps(session.snapshot())))
    for one in (session, again):
        one.execute(["unlock r"])
        assert one.human_plan == ((1, "walk h"), (5, "pass h"))
        one.execute([])
        assert one.human_plan == ((1, "walk h"), (5, "pass h")), "later by as much"
        assert one.plan().options.head_start == 0


def test_who_is_up_early_does_the_rest_when_they_planned_to() -> None:
    ways = {"rise h": "bed -> up !bed @ 1", "eat h": "up -> fed @ 1"}
    session = Session(task(init="bed", goal="fed", actions=ways), head_start=2)
    assert session.plan().human_entries == ((3, "rise h"), (4, "eat h"))
    session.execute(["rise h"])
    assert session.human_plan == ((2, "eat h"),)
    assert session.plan().human_entries == ((3, "eat h"),)


def test_a_plan_that_is_given_begins_behind_the_head_start() -> None:
    """The door is still closed now."""
    door = task(goal="in", actions={"pass h": "open -> in"}).with_script(Script(facts=[(2, "open")]))
    answer = serendipity.plan(door, human_plan=["pass h"], head_start=2)
    assert answer.human_entries == ((3, "pass h"),)
    session = Session(door, human_plan=["pass h"], head_start=2)
    session.execute([])
    assert session.plan().human_entries == ((2, "pass h"),)


@pytest.mark.parametrize("early", [0, 1, 3])
def test_an_epoch_that_never_comes_is_refused_at_once(early: int) -> None:
    """It was taken, and gave way to a predicted plan with the next epoch."""
    office = serendipity.example("office")
    first, *more = serendipity.plan(office).human_entries or ()
    session = Session(office, human_plan=[first, *more])
    for epoch, until in ((-early, "on"), (10**6 + 1 + early, "to 1000000")):
        message = rf"^human plan, step 1: '{first[1]}': expected an epoch from 1 {until}, got {epoch}$"
        wrong = [(epoch, first[1]), *more]
        with pytest.raises(serendipity.PlanError, match=message):
            serendipity.plan(office, human_plan=wrong)
        with pytest.raises(serendipity.PlanError, match=message):
            Session(office, human_plan=wrong)
        with pytest.raises(serendipity.PlanError, match=message):
            session.follow(wrong)
    assert session.human_plan == (first, *more), "as it was"


@pytest.mark.parametrize(
    ("plan", "step", "least"),
    [
        ([(2, "walk h"), (2, "eat h")], 2, 4),
        ([(2, "walk h"), (3, "eat h"), (9, "eat h")], 2, 4),
        ([(2, "walk h"), (3, "noop")], 2, 4),
        ([(3, "noop"), (3, "walk h")], 2, 4),
    ],
    ids=["equal", "before-it-ends", "waiting", "after-waiting"],
)
def test_epochs_that_do_not_rise_are_refused_at_once(plan: list[PlanEntry], step: int, least: int) -> None:
    """The next call said so, which knew no more than this one."""
    lunch = task(init="out", goal="fed", actions={"walk h": "out -> in !out [2]", "eat h": "in -> fed"})
    session = Session(lunch, human_plan=[(1, "walk h"), (4, "eat h")])
    named = plan[step - 1]
    message = rf"^human plan, step {step}: '{named[1]}': expected an epoch from {least} on, got {named[0]}$"
    for refused in (serendipity.plan, Session):
        with pytest.raises(serendipity.PlanError, match=message):
            refused(lunch, human_plan=plan)
    with pytest.raises(serendipity.PlanError, match=message):
        session.follow(plan)
    assert session.plan().human_entries == ((1, "walk h"), (4, "eat h"))


@pytest.mark.parametrize("early", [0, 1, 3])
def test_going_on_with_something_is_no_waiting(early: int) -> None:
    session = Session(lane().task, mode="individual", waiting_cost="0.5")
    session.execute(["walk h"])
    session.follow(None)
    now = session.task
    answer = proved(now, mode="individual", waiting_cost="0.5", head_start=early)
    assert answer.cost == answer.human_cost == 1 + 3 * 0.5
    assert best(now, answer.options).cost == answer.cost


@pytest.mark.long
@given(calls_in_time(modes=(*MODES, "communication")), st.randoms(use_true_random=False))
def test_answers_in_the_middle_of_actions_are_proved(call: Call, dice: Random) -> None:
    changes = {"horizon": None, "nobody_pays": False}
    options = {**call.keywords(), **changes, "preservation": "kernel", "human_plan": None}
    session = Session(call.task.with_goal(call.task.goal, Condition()), **options)
    for _ in range(3):
        try:
            answer = session.plan()
        except UsageError:
            return  # it needs a horizon
        task = replace(session.task)
        assert serendipity.verify(task, answer).verdict == "proved"
        if answer.lower_bound:
            dearer = replace(answer, lower_bound=answer.lower_bound + 1, objective=answer.lower_bound + 1)
            assert serendipity.verify(task, dearer).verdict == "refuted"
        possible = [action.name for action in task.actions if action.applicable(task.init)]
        own = [dice.choice(possible)] if possible and dice.random() < 0.4 else now(answer)
        try:
            session.execute(own)
        except UsageError:
            return  # what goes on is in its way


def test_what_takes_effect_at_other_times_shares_an_epoch() -> None:
    both = {"walk h": " -> done !calm @ 1 [2]", "rest r": " -> calm @ 1"}
    session = Session(task(goal="done", actions=both))
    session.execute(["walk h", "rest r"])
    with pytest.raises(UsageError, match=r"epoch: .*change the same fact"):
        session.execute(["rest r"])


@pytest.mark.long
@given(calls_in_time(modes=("serendipity", "composite")), st.randoms(use_true_random=False))
def test_a_restored_session_goes_on_in_the_middle_of_actions(call: Call, dice: Random) -> None:
    options = call.keywords(horizon=None)
    begun = call.task.with_goal(call.task.goal, Condition())
    session = Session(begun, **options)
    for _ in range(4):
        answer = session.plan()
        own = [name for name in now(answer) if dice.random() < 0.8]
        try:
            session.execute(own)
        except UsageError:
            return  # without the others it is not possible
        other = Session.restore(replace(begun), json.loads(json.dumps(session.snapshot())))
        assert (other.task.init, other.task.script) == (session.task.init, session.task.script)
        assert (other.human_plan, other.rest) == (session.human_plan, session.rest)
        one, again = session.plan(), other.plan()
        assert [getattr(one, name) for name in _FIGURES] == [getattr(again, name) for name in _FIGURES]


def test_what_is_no_snapshot_in_time_is_refused() -> None:
    session = Session(serendipity.example("morning"))
    session.execute([])
    whole = session.snapshot()
    wrong = ({"passed": 1}, {"passed": 1, "going": "x"}, {"passed": 1, "going": [{}]}, 3)
    for bad in wrong:
        with pytest.raises(serendipity.InputError, match="snapshot: expected"):
            Session.restore(serendipity.example("morning"), {**whole, "time": bad})
    times = {"passed": (-1, 10**18, "x", 1.5), "asleep": (-1, 10**12)}
    for more in ({name: value} for name, values in times.items() for value in values):
        with pytest.raises(serendipity.InputError, match=r"^snapshot: \w+: expected a whole number"):
            Session.restore(serendipity.example("morning"), {**whole, "time": {**whole["time"], **more}})
    with pytest.raises(serendipity.InputError, match="another task"):
        Session.restore(serendipity.example("morning").with_script(Script(facts=[(3, "coffee")])), whole)
