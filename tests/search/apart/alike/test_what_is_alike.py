"""Which things can be exchanged for one another, and what is counted by them."""

from dataclasses import replace

import pytest

from search.short_windows.independent.alike.robots import CountedRobots
from search.short_windows.independent.alike.tally import tally
from search.short_windows.independent.alike.things import Things
from search.call.context import SearchContext
from search.packed.packed_task import PackedTask
from search.call.prepared_task import PreparedTask
from serendipity.model import Options, Task
from serendipity.model.resources.deadline import Deadline
from serendipity.testing.builders import task as build

PLACES = ("a", "b", "c", "d")
RESTS = {f"rest_h_{place} h": f"at:h:{place} -> rested @ 1" for place in PLACES}

CARRIES = {f"carry_r_{place} r": f"at:h:{place} -> at:h:home !at:h:{place} @ 1" for place in PLACES}
CHARGED = {f"see_{place}_r r": f"at:r:{place} charged -> seen:{place} @ 1" for place in PLACES}
FOULS = {f"foul_{place}_r r": f"-> foul:{place} @ 1" for place in PLACES}
TIDIES = {f"tidy_{place}_h h": f"!foul:{place} -> tidy @ 1" for place in PLACES}


def survey(more: dict[str, str] | None = None, *, init: str = "", goal: str = "", without: str = "") -> Task:
    """A human and a robot who go from home to places and see to them; facts with names in them.

    Args:
        more: further actions.
        init: what else is true in the beginning.
        goal: what else is asked for.
        without: an action that there is not.
    """
    actions: dict[str, str] = {}
    places = ("home", *PLACES)
    for agent in ("h", "r"):
        for here in places:
            if here != "home":
                actions[f"see_{here}_{agent} {agent}"] = f"at:{agent}:{here} -> seen:{here} @ 1"
            for there in places:
                if here != there:
                    actions[f"go_{agent}_{here}_{there} {agent}"] = (
                        f"at:{agent}:{here} -> at:{agent}:{there} !at:{agent}:{here} @ 1"
                    )
    actions.pop(without, None)
    goals = " ".join(f"seen:{place}" for place in PLACES)
    built = build(
        agents="h r",
        init=f"at:h:home at:r:home {init}",
        goal=f"{goals} {goal}",
        actions=actions | (more or {}),
    )
    facts = tuple(fact.replace(":", " ") for fact in built.facts)
    return replace(built, facts=facts, known_variables=built.variables)


def alike(task: Task) -> list[list[str]]:
    deadline = Deadline()
    return Things(PackedTask(task, frozenset(), deadline), deadline).alike()


def test_places_of_which_the_same_is_said() -> None:
    assert alike(survey()) == [["a", "b", "c", "d"]]


@pytest.mark.parametrize(
    ("task", "kinds"),
    [
        (survey(init="seen:c"), [["a", "b", "d"]]),
        (survey(without="go_r_a_b r"), [["c", "d"]]),
        (survey({"fly_h_d h": "at:h:home -> at:h:d !at:h:home @ 0.5"}), [["a", "b", "c"]]),
        (survey(FOULS | TIDIES, goal="tidy !foul:a"), [["b", "c", "d"]]),
        (survey({"pass_h_a h": "!seen:a -> ready @ 1"}, goal="ready"), [["b", "c", "d"]]),
        (survey({"hide_r_b r": "at:r:b -> !seen:b @ 1"}), [["a", "c", "d"]]),
        (survey({"see_both r": "at:r:home -> seen:a seen:b @ 5"}), [["a", "b"], ["c", "d"]]),
        (survey(RESTS, goal="rested"), [["a", "b", "c", "d"]]),
    ],
    ids=["seen", "no way", "a short way", "must not be", "asked for", "undone", "two at once", "for all"],
)  # fmt: skip
def test_places_that_differ_in_one_thing(task: Task, kinds: list[list[str]]) -> None:
    assert alike(task) == kinds


def counters(task: Task) -> list[int] | None:
    """How many values each counter counts."""
    context = SearchContext(PreparedTask(task), Options(), Deadline())
    found = tally(context.packed, context.relevant, context.deadline)
    return None if found is None else [len(counter.values) for counter in found.counters]


def test_what_is_seen_is_counted() -> None:
    assert counters(survey()) == [4]
    assert counters(survey(init="seen:c")) == [3]


@pytest.mark.parametrize(
    "task",
    [
        survey({"hide_r_b r": "at:r:b -> !seen:b @ 1"}),
        survey({"hide_h_b h": "at:h:b -> !seen:b @ 1"}),
        survey({"report_r r": "seen:a -> told @ 1"}, goal="told"),
        survey({"push_h h": "at:r:a -> at:r:b !at:r:a @ 1"}),
        survey({"charge_h h": "-> charged @ 1"} | CHARGED),
        survey(CARRIES),
    ],
    ids=["it undoes it", "the human does", "asked for", "the human moves it", "charges it", "it moves them"],
)  # fmt: skip
def test_what_can_not_be_counted(task: Task) -> None:
    assert counters(task) is None


def test_nothing_is_counted_where_nothing_is_alike() -> None:
    prices = {
        f"see_{place}_h h": f"at:h:{place} -> seen:{place} @ {price}" for price, place in enumerate(PLACES, 1)
    }
    assert counters(survey(prices)) is None


def test_things_with_two_fields_that_are_counted_are_told_apart() -> None:
    """Else it would be forgotten which of them have both."""
    smells = {
        f"smell_{place}_{agent} {agent}": f"at:{agent}:{place} -> smelt:{place} @ 1"
        for place in PLACES
        for agent in ("h", "r")
    }
    task = survey(smells, goal=" ".join(f"smelt:{place}" for place in PLACES))
    assert alike(task) == [["a", "b", "c", "d"]]
    assert counters(task) is None


def test_places_of_the_robot_up_to_exchanging() -> None:
    """It is at home, at a place that it has seen to, or at one that it has not."""
    task = survey()
    context = SearchContext(PreparedTask(task), Options(), Deadline())
    plan = context.canonical_plan()
    assert plan is not None
    counted = tally(context.packed, context.relevant, context.deadline)
    assert counted is not None
    robots = CountedRobots(context, plan.actions, counted, lambda _: 1)
    assert [len(robot.edges) for robot in robots._robots] == [3]
