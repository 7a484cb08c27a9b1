"""Human plans with times, replayed by the model beside durations and a script."""

import pickle
from fractions import Fraction
from itertools import pairwise

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from serendipity.model import GroundAction, PlanError, Script, Task, TimedPlan, Timing, UsageError
from serendipity.model.task.course import BrokenPlanError, PlayedPlan
from serendipity.model.task.plans_in_time import outlasts, plan_in_time
from serendipity.testing.builders import task
from serendipity.testing.oracle.moments import Moment, World
from serendipity.testing.strategies import tasks_in_time


def home() -> Task:
    """Somebody who walks to a door for two epochs, which is open from epoch 4 on, and goes through it."""
    actions = {"walk h": "bed -> !bed / door @ 1 [2]", "leave h": "door open -> out !door"}
    return task(init="bed", goal="out", actions=actions | {"open r": " -> open"}).with_script(
        Script(facts=[(4, "open")])
    )


def test_waiting_is_what_is_left_between_the_actions() -> None:
    plan = plan_in_time(home(), [(1, "walk h"), (5, "Leave  H")])
    assert isinstance(plan, TimedPlan)
    assert (home().starts_of(plan), home().epochs_of(plan)) == ((1, 5), 5)
    assert len(home().replay_alone(plan)) == 6


def test_a_plan_without_gaps_is_a_plain_tuple() -> None:
    open_home = home().at(home().init | {home().facts.index("open")})
    for entries in (["walk h", "leave h"], ["walk h", "noop", "leave h"], [(1, "walk h"), (3, "leave h")]):
        plan = plan_in_time(open_home, entries)
        assert (type(plan), open_home.starts_of(plan), open_home.epochs_of(plan)) == (tuple, (1, 3), 3)


def test_a_last_noop_says_until_when_they_wait() -> None:
    plan = plan_in_time(home(), [(1, "walk h"), (5, "leave h"), (8, "noop")])
    assert home().epochs_of(plan) == 8


def test_timed_plans_are_values() -> None:
    plan = TimedPlan((1, 0), (1, 4), 5)
    assert pickle.loads(pickle.dumps(plan)) == plan
    assert hash(plan) == hash(TimedPlan((1, 0), (1, 4), 5))
    assert plan != (1, 0)
    assert tuple(plan) == (1, 0)
    assert plan != TimedPlan((1, 0), (1, 5), 6)


@pytest.mark.parametrize(
    ("entries", "message"),
    [
        (["walk h", "leave h"], "human plan, step 2: 'leave h' is not applicable: 'open' is false"),
        (
            [(1, "walk h"), (2, "leave h")],
            "human plan, step 2: 'leave h': expected an epoch from 3 on, got 2",
        ),
        ([(0, "walk h")], "human plan, step 1: 'walk h': expected an epoch from 1 on, got 0"),
        ([(1, "walk h"), (9, "fly h")], "human plan, step 2: there is no action 'fly h' in the task"),
        ([(1, "open r")], "human plan, step 1: 'open r' is not an action that h can do alone"),
        ([(3, "walk h")], "human plan: the goal does not hold after its last step 'walk h'"),
    ],
)
def test_errors_name_the_step(entries: list[tuple[int, str]], message: str) -> None:
    with pytest.raises(PlanError) as caught:
        plan_in_time(home(), entries)
    assert str(caught.value) == message


@pytest.mark.parametrize(
    "entries", ["walk h", [3], [(1, "walk h"), "leave h"], [("1", "walk h")], [(True, "a")]]
)
def test_entries_of_another_form_are_refused(entries: object) -> None:
    with pytest.raises(UsageError, match="human plan: expected"):
        home().plan_from_names(entries)  # type: ignore[arg-type]


def test_what_does_not_last_is_said() -> None:
    flooded = home().with_script(Script(facts=[(7, "!out")]))
    plan = plan_in_time(flooded, [(1, "walk h"), (5, "leave h")])
    assert outlasts(flooded, plan, 6) is None
    assert outlasts(flooded, plan, 7) == "the goal does not hold any more"


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: Timing(1), "a whole number of epochs, at least 2, got 1"),
        (lambda: Timing(2.5), "a whole number of epochs, at least 2, got 2.5"),  # type: ignore[arg-type]
        (lambda: Timing("2"), "a whole number of epochs, at least 2, got '2'"),  # type: ignore[arg-type]
        (lambda: Timing(2, start_add=(1,), start_delete=(1,)), "both added and deleted"),
    ],
)
def test_timings_hold_what_they_say(make: object, message: str) -> None:
    with pytest.raises(UsageError, match=message):
        make()  # type: ignore[operator]


def test_durations_are_of_whole_actions() -> None:
    walk = next(action for action in home().actions if action.name == "walk h")
    assert (walk.duration, [moment.duration for moment in walk.moments]) == (2, [1, 1])
    assert GroundAction("a h", (0,), (), (), (), (), Fraction(1)).duration == 1


@pytest.mark.long
@settings(max_examples=150, deadline=None)
@given(st.data(), st.booleans())
def test_the_course_of_plans_is_that_of_brute_force(data: st.DataObject, strict: bool) -> None:
    """Both go through the same epochs, with any actions begun in them, and say the same of each."""
    built = data.draw(tasks_in_time())
    course = PlayedPlan(built.facts, built.init, built.script, strict=strict)
    world, moment = World(built, strict=strict), Moment(built.init)
    for epoch in range(1, data.draw(st.integers(1, 7)) + 1):
        begun = data.draw(st.lists(st.sampled_from(range(len(built.actions))), max_size=2, unique=True))
        wanted = tuple(sorted(begun))
        following = next(
            (then for chosen, then in world.sets(moment, epoch, wanted) if chosen == wanted), None
        )
        try:
            course.begin([built.actions[i] for i in wanted])
        except (
            BrokenPlanError
        ):  # what goes on is asked for at once by the one, before the next epoch by the other
            assert following is None or not [*world.sets(following, epoch + 1, ())]
            return
        assert following is not None
        assert course.state == following.state
        moment = following


def test_every_group_of_facts_has_one_true_in_every_state_of_a_course() -> None:
    moves = {f"move h {a} {b}": f"{a} -> {b} !{a} @ 1" for a, b in pairwise("abcd")}
    slow = task(init="a", goal="d", actions={**moves, "ride h": "a -> !a / d @ 1 [3]"})
    assert all(variable.boolean for variable in slow.variables)
    quick = task(init="a", goal="d", actions=moves)
    assert not all(variable.boolean for variable in quick.variables)
