"""Human plans with times, replayed by the model beside durations and a script.

Scripts by name: what tasks make of them, and what is wrong with others.
"""

import pickle
from fractions import Fraction
from itertools import pairwise

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from serendipity.model import GroundAction, PlanError, Script, Task, TimedFact, TimedPlan, Timing, UsageError
from serendipity.model.task.course import BrokenPlanError, PlayedPlan
from serendipity.model.task.plans_in_time import outlasts, plan_in_time
from serendipity_testing.builders import task
from serendipity_testing.oracle.moments import Moment, OracleWorld
from serendipity_testing.strategies import tasks_in_time


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
    world, moment = OracleWorld(built, strict=strict), Moment(built.init)
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


def street() -> Task:
    """A human, a robot, and Carol, who walks and shops."""
    return task(
        agents="h r carol",
        init="open",
        goal="done",
        actions={
            "do h": "open -> done",
            "help r": " -> done",
            "walk carol": " -> there @ 1 [2]",
            "shop carol": "there -> bought",
            "carry h carol": "there -> done",
        },
    )


def test_bystanders_are_neither_robots_nor_anybody_whose_actions_can_be_chosen() -> None:
    with_carol = street().with_script(Script(people={"Carol": ["walk carol", "shop carol"]}))
    assert (with_carol.agents, with_carol.robots) == (("h", "r", "carol"), (1,))
    assert [action.name for action in with_carol.actions] == ["do h", "help r"]
    assert [(deed.epoch, deed.end, deed.name) for deed in with_carol.script.deeds] == [
        (1, 2, "walk carol"),
        (3, 3, "shop carol"),
    ]
    assert with_carol.needs_time


def test_tasks_tell_of_time() -> None:
    plans = {"carol": ["walk carol", "shop carol"]}
    timed = street().with_script(Script(facts=[(9, "!open")], people=plans))
    assert "actions of one epoch; a script of 1 facts and the plans of carol, until epoch 9" in str(timed)


def test_a_bystander_who_does_nothing_is_one() -> None:
    idle = street().with_script(Script(people={"carol": []}))
    assert (idle.robots, idle.needs_time) == ((1,), False)


def test_scripts_add_up() -> None:
    first = street().with_script(Script(facts=[(5, "!open"), (2, "there")]))
    both = first.with_script(Script(facts=[(5, "!open"), (7, "open")]))
    open_, there = street().facts.index("open"), street().facts.index("there")
    facts = [TimedFact(2, there, True), TimedFact(5, open_, False), TimedFact(7, open_, True)]
    assert (list(both.script.facts), both.script.last) == (facts, 7)
    assert both.script.changes(5) == (frozenset(), frozenset({open_}))


def test_facts_that_the_script_changes_are_in_no_group() -> None:
    moved = task(init="a", goal="b", actions={"go h": "a -> b !a", "back h": "b -> a !b"})
    assert [variable.boolean for variable in moved.variables] == [False]
    assert [v.boolean for v in moved.with_script(Script(facts=[(3, "!a")])).variables] == [True, True]


@pytest.mark.parametrize(
    ("script", "message"),
    [
        ({"facts": [(0, "open")]}, "script: expected an epoch from 1 to 1000000, got 0"),
        ({"facts": [(1_000_001, "open")]}, "script: expected an epoch from 1 to 1000000, got 1000001"),
        ({"facts": [(3, "opened")]}, "script: there is no fact 'opened' in the task"),
        ({"facts": [(3, "open"), (3, "!open")]}, "script: a fact becomes true and false with epoch 3"),
        ({"facts": [("3", "open")]}, "script: facts: expected a whole epoch, got '3'"),
        ({"facts": "open"}, "script: facts: expected pairs of an epoch and a fact, got 'open'"),
        ({"people": ["carol"]}, "script: people: expected plans by name, got ['carol']"),
        ({"people": {"dave": []}}, "script: expected one of h, r, carol, got 'dave'"),
        ({"people": {"h": []}}, "script: 'h' is the human, whose plan is no part of it"),
        ({"people": {"carol": ["do h"]}}, "script: 'do h' is not an action that carol can do alone"),
        ({"people": {"carol": ["carry h carol"]}}, "script: 'carry h carol' is not an action that carol can"),
        (
            {"people": {"carol": [(1, "walk carol"), (2, "shop carol")]}},
            "script: 'shop carol' begins in epoch 2, but 'walk carol' takes until the end of epoch 2",
        ),
        ({"people": {"carol": [(-1, "walk carol")]}}, "script: expected an epoch from 1 to 1000000, got -1"),
    ],
)
def test_what_is_wrong_is_said_in_a_line(script: dict[str, object], message: str) -> None:
    with pytest.raises(UsageError) as caught:
        street().with_script(Script(**script))  # type: ignore[arg-type]
    assert str(caught.value).startswith(message)
    assert "\n" not in str(caught.value)


def test_nobody_has_two_plans() -> None:
    with_carol = street().with_script(Script(people={"carol": ["walk carol"]}))
    with pytest.raises(UsageError, match="has a plan already"):
        with_carol.with_script(Script(people={"carol": ["shop carol"]}))
    with pytest.raises(UsageError, match="'carol' is the human"):
        with_carol.with_human("carol")
