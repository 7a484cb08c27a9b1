"""Executions that can be followed by hand."""

from typing import Any

import pytest

import serendipity
from serendipity.execution import Execution, Moment, Omniscient, Replanner, person_of
from serendipity.execution.beliefs import Beliefs
from serendipity.model import Condition, Deadline, LimitReachedError, Task, UsageError
from serendipity.model.task.actions import apply
from serendipity.recognition.recognise import candidate_goals
from serendipity_testing.builders import task as build
from serendipity_testing.builders import usar
from tests.execution.living import lived, verdicts


def _live(run: Execution, person: Replanner | Omniscient) -> list[str]:
    return verdicts(lived(run, person))


@pytest.mark.parametrize("human_model", ["observant", "local"])
def test_the_paper_example_happens(room2: Task, human_model: str) -> None:
    run = Execution(room2, discount="0.6", human_model=human_model)
    verdicts = _live(run, Replanner(room2, human_model))
    assert verdicts[:6] == ["waits", *["helps"] * 5] and set(verdicts[6:]) == {"aside"}
    assert run.passed[5].human == "hand_over robot commx mk2 hall4"
    assert (float(run.cost), run.human_cost) == (12.6, 11)


def test_who_is_told_gets_the_plan_of_the_paper() -> None:
    task = serendipity.example("room5")  # there the plan begins with the person's own kit
    told = Execution(task, discount="0.9", human_model="omniscient", told=True)
    _live(told, Omniscient(task))
    assert float(told.cost) == 11.5
    untold = Execution(task, discount="0.9", human_model="omniscient")
    _live(untold, Replanner(task))
    assert untold.human_cost == 13


def test_the_person_turns_off(room2: Task) -> None:
    run = Execution(room2, discount="0.6")
    run.step("move commx room13 hall8")
    run.step("move_reverse commx hall8 hall7")
    assert run.passed[-1].decided.verdict == "helps"
    for action in ("move_reverse commx hall7 room7", "move_reverse commx room7 room6"):
        run.step(action)
    assert not any(step.agents == ("robot",) for step in run.passed[-1].steps), "it sees that he is late"
    assert "aside" in _live(run, Replanner(room2.at(run.state))) and run.done


def test_the_person_takes_the_kit_themselves(room2: Task) -> None:
    run = Execution(room2, discount="0.6")
    run.change({"at mk2 room3": False, "has commx mk2": True, "has_medkit commx": True})
    assert run.decided.reason == "stays out of the way: no help pays"


def test_the_person_stands_still(room2: Task) -> None:
    run = Execution(room2, discount="0.6")
    for _ in range(12):
        run.step(None)
    assert run.human_cost == 0 and not run.done
    assert _live(run, Replanner(room2)) and run.human_cost == 11


def _crossing(goal: str = "conducted_triage h g") -> Task:
    """A corridor to g with a kit behind d; the robot is one room away from another; x is next to a0.

    To meet the person in c it has to set out in epoch 2.
    """
    task = usar(
        "a0-a1-a2-a3-a4-c-d-g d-s c-r-r2 a0-x",
        human="a0",
        robots={"r": "r"},
        kits={"k1": "s", "k2": "r2"},
        triage="g",
    )
    return task.with_goal(Condition((task.facts.index(goal),)))


GOALS = [{"name": "triage", "goal": ["conducted_triage h g"]}, {"name": "visit", "goal": ["at h x"]}]


def test_with_two_goals_it_waits_until_it_is_sure() -> None:
    task = _crossing()
    run = Execution(task, discount="0.6", goals=GOALS)
    assert _live(run, Replanner(task))[:3] == ["unsure", "helps", "helps"]
    first, second = run.passed[0].decided, run.passed[1].decided
    assert first.reason.startswith("waits: not sure which goal (triage 50%, visit 50%)")
    assert second.goals["triage"] > 0.6
    assert float(run.cost) == 10.6
    other = _crossing("at h x")
    run = Execution(other, discount="0.6", goals=GOALS)
    assert _live(run, Replanner(other)) == ["unsure"] and run.cost == 1


def test_what_would_be_in_vain_for_one_goal_and_pays_in_the_mean_is_done() -> None:
    task = _crossing()
    person = ["move h a0 a1", "move h a1 a2", "move h a2 a3"]
    goals = [GOALS[0], {"name": "a3", "goal": ["at h a3"]}]
    verdicts = {}
    for discount in ("0.6", "0.9"):
        run = Execution(task, discount=discount, goals=goals)
        verdicts[discount] = [run.step(action).decided.verdict for action in person]
    assert verdicts == {"0.6": ["unsure", "unsure", "aside"], "0.9": ["unsure", "helps", "helps"]}


def _fork(work: int, goal: str = "a11") -> Task:
    """A way that forks after an epoch; from a6 there is a short cut once the robot has worked at it."""
    actions = {"go h 0 1": "s0 -> s1 !s0", "slip h": "a6 open -> a11 !a6"}
    for way in "ab":
        actions[f"go h {way} 2"] = f"s1 -> {way}2 !s1"
        actions |= {f"go h {way} {i}": f"{way}{i - 1} -> {way}{i} !{way}{i - 1}" for i in range(3, 12)}
    for i in range(work):
        actions[f"work r {i}"] = f"w{i} -> {'open' if i == work - 1 else f'w{i + 1}'}"
    return build(init="s0 w0", goal=goal, actions=actions)


FORK = [{"name": "a", "goal": ["a11"]}, {"name": "b", "goal": ["b11"]}]


@pytest.mark.parametrize(
    ("work", "discount", "begun", "costs"),
    [(5, "0.4", 2, (10, 11.6)), (4, "0.5", 3, (9, 11))],
    ids=["it begins, since it can stop", "it waits, since there is time"],
)
def test_robots_reckon_with_changing_their_mind(
    work: int, discount: str, begun: int, costs: tuple[float, float]
) -> None:
    """Five epochs of work were not begun: it would be in vain half the time, if it were not stopped."""
    runs = []
    for goal in ("a11", "b11"):
        task = _fork(work, goal)
        runs.append(lived(Execution(task, discount=discount, goals=FORK), Replanner(task)))
    first = next(passed.epoch for passed in runs[0].passed if passed.decided.actions)
    assert (first, *(float(run.cost) for run in runs)) == (begun, *costs)


def test_a_plan_may_be_spoilt_where_it_is_dropped_for_a_cheaper_one() -> None:
    task = build(
        init="a blocked",
        goal="c",
        actions={"go h": "a -> b !a", "clear h": "b blocked -> !blocked", "on h": "b !blocked -> c !b"}
        | {"clear r": "blocked -> !blocked"},
    )
    run = Execution(task, discount="0.5")
    assert _live(run, Replanner(task))[0] == "helps"
    assert (run.human_cost, run.cost) == (2, 2.5)
    unseen = Execution(task, discount="0.5", human_model="local")
    assert set(_live(unseen, Replanner(task, "local"))) == {"aside"}, (
        "who may not see it goes on with the plan"
    )


def test_robots_without_a_decision_in_time_do_nothing(room2: Task) -> None:
    run = Execution(room2, discount="0.6", deadline=0)
    assert set(_live(run, Replanner(room2))) == {"late"}
    assert run.cost == run.human_cost == 13


def test_robots_see_to_their_own_goals() -> None:
    task = build(init="a", goal="b", robot_goal="done", actions={"go h": "a -> b !a", "tidy r": " -> done"})
    run = Execution(task)
    assert run.decided.verdict == "works"
    assert [step.action for step in run.step("go h").steps] == ["go h", "tidy r"]


@pytest.mark.parametrize("lasts", ["", " [2]"])
def test_who_is_told_is_asked_to_see_to_robots_goals(lasts: str) -> None:
    """It was said that robots stay out of the way, as only the person is to do anything."""
    ways = {"go h": f"a -> b !a{lasts}", "sweep h": f"a -> b done !a @ 3{lasts}", "rest r": "-> rested"}
    task = build(init="a", goal="b", robot_goal="done", actions=ways)
    run = lived(Execution(task, told=True), person_of(task, "omniscient"))
    assert (verdicts(run)[0], run.human_cost) == ("works", 3)
    assert run.passed[0].decided.reason == "sees to goals of its own"


def test_robots_goals_are_out_of_reach_beside_somebody_who_has_nothing_to_do() -> None:
    """It was an error: whoever has nothing to do sets no horizon."""
    actions = {"go h": "a -> b !a", "rest r": "-> rested"}
    task = build(init="a", goal="b", robot_goal="done", actions=actions)
    run = Execution(task, goals=[{"name": "stay", "goal": ["a"]}])
    assert run.decided.reason == "stays out of the way: its own goals are out of reach"


def test_a_robot_that_is_out_of_order_is_not_counted_on(room2: Task) -> None:
    run = Execution(room2, discount="0.6")
    run.drop(["robot"])
    assert run.decided.verdict == "aside" and not run.decided.actions
    with pytest.raises(UsageError, match="expected one of robot, got 'commx'"):
        run.drop(["commx"])


def test_what_is_impossible_is_tried_in_vain(room2: Task) -> None:
    run = Execution(room2)
    passed = run.step("move_reverse commx hall8 hall7")
    assert passed.in_vain and not passed.changes and run.human_cost == 0
    with pytest.raises(UsageError, match="no action 'fly' that commx can do alone"):
        run.step("fly")
    with pytest.raises(UsageError, match="no action 'move robot room4 hall4' that commx can do alone"):
        run.step("move robot room4 hall4")


def test_who_has_a_plan_in_mind_keeps_it_and_goes_on_with_the_rest() -> None:
    """Of two ways that cost the same they take the one that they meant to, told so or not."""
    ways = build(
        agents="h r",
        init="a",
        goal="c",
        actions={
            "left1 h": "a -> b1 !a",
            "left2 h": "b1 -> c",
            "right1 h": "a -> b2 !a",
            "right2 h": "b2 -> c",
        },
    )
    plan = tuple(
        next(i for i, a in enumerate(ways.actions) if a.name == name) for name in ("right1 h", "right2 h")
    )
    for told in (False, True):
        person, run = Omniscient(ways, plan), Execution(ways)
        first = person.choose(Moment(run.state, (), told, "right1 h"))
        run.step(first)
        assert (first, person.choose(Moment(run.state, (), False, None))) == ("right1 h", "right2 h")
        assert Replanner(ways, plan=plan).plan == plan


def test_without_time_for_exact_costs_bounds_tell_goals_apart(monkeypatch: pytest.MonkeyPatch) -> None:
    ways = {
        "go h a b": "a -> b !a",
        "go h b c": "b -> c !b",
        "go h a d": "a -> d !a",
        "go h d a": "d -> a !d",
    }
    home = build(init="a", goal="c", actions={**ways, "go h b a": "b -> a !b"})
    beliefs = Beliefs(home, candidate_goals(home, [{"goal": ["c"]}, {"goal": ["d"]}]), 1)

    def too_late(*_: Any, **__: Any) -> None:
        raise LimitReachedError("time")

    monkeypatch.setattr(beliefs.explainer, "explain", too_late)
    (action,) = home.named["go h a b"]
    beliefs.saw(action, [action])
    beliefs.update(apply(home.init, home.actions[action]), Deadline())
    c, d = beliefs.weights
    assert float(c) == pytest.approx(0.5 / (0.5 + 1 / (1 + 2.718281828459045**2)))
    assert c + d == 1
