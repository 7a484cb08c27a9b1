"""Hand-checked help for goals that are not known."""

import pytest

import serendipity
from serendipity.model import InputError, Result, Task, UsageError, Window
from serendipity_testing.builders import task as build
from serendipity_testing.cases import CASE_3_PLAN, case_3
from tests.model.test_parts_of_results import rivals


def workshop(keep: str) -> Task:
    """p costs 5, or 1 once the robot has lifted; z is another goal, reached by ``keep``."""
    return build(
        goal="p",
        actions={
            "do1 h": "-> p @ 5",
            "do2 h": "q -> p @ 1",
            "lift r": "-> q @ 1",
            "prepare h": "-> ready @ 1",
            "keep h": keep,
        },
    )


def helped(task: Task, p: object, z: object, **more: object) -> Result:
    goals = [{"name": "p", "goal": ["p"], "prior": p}, {"name": "z", "goal": ["z"], "prior": z}]
    return serendipity.plan(task, goals=goals, horizon=2, **more)  # type: ignore[arg-type]


def test_help_that_leaves_the_other_plan_alone() -> None:
    answer = helped(workshop("!q -> z @ 5"), 1, 1)
    assert (answer.status, answer.opportunity) == ("optimal", True)
    assert (answer.cost, answer.human_cost, answer.saving) == (4, 5, 1)  # (2 + 6) / 2
    assert [(step.epoch, step.action) for step in answer.plan or ()] == [(1, "lift r")]
    p, z = answer.goals or ()
    assert (p.cost, p.window) == (2, Window(1, 2))
    assert (z.cost, z.window) == (6, None)
    assert answer.agent_costs == {"h": 3, "r": 1}


def test_a_goal_served_at_no_gain() -> None:
    """Lifting saves 8 if the human wants p; for z they can't ``keep`` beside it but have to ``mend``."""
    goals = [{"name": "p", "goal": ["p"]}, {"name": "z", "goal": ["z"]}]
    answer = serendipity.plan(rivals(), goals=goals, horizon=3, interference="strict")
    p, z = answer.goals or ()
    assert (answer.opportunity, p.cost, z.cost) == (True, 1.0, 5.0)
    assert z.window is not None
    assert [step.action for step in z.plan or ()] == ["lift r", "mend h"]


@pytest.mark.parametrize(("p", "z", "cost"), [(9, 1, 2.4), (1, 3, 5), ("1/4", "3/4", 5), (1, 9, 5)])
def test_the_less_sure_the_less_help(p: object, z: object, cost: float) -> None:
    """Lifting costs 1 and saves 4 with p: at odds of 1 to 3 it is a tie, and no opportunity."""
    answer = helped(workshop("!q -> z @ 5"), p, z)
    assert answer.cost == cost
    assert answer.opportunity == (cost < 5)
    assert (answer.plan == ()) == (cost == 5)


def test_no_considered_plan_is_broken() -> None:
    """Lifting would make the second action of the human's plan for z inapplicable, however unlikely z is."""
    answer = helped(workshop("ready !q -> z @ 4"), 1_000_000, 1)
    assert (answer.status, answer.opportunity, answer.cost, answer.plan) == ("optimal", False, 5, ())
    assert [goal.window for goal in answer.goals or ()] == [None, None]


def test_impossible_goals_are_not_considered() -> None:
    task = workshop("ready !q -> z @ 4")
    assert helped(task, 1, 0).cost == 2
    unexplained = helped(task, 1, 1, observed=["do2 h"])  # the human can't without the robot
    assert unexplained.cost == 5
    assert not unexplained.recognition.explained


def test_what_was_seen_settles_the_goal() -> None:
    """After ``keep`` once more, p is possible but dear, and lifting no longer pays."""
    task = workshop("!q -> z @ 5")
    assert helped(task, 1, 1).opportunity
    answer = helped(task, 1, 1, observed=["keep h"])
    p, z = answer.recognition.goals
    assert (p.with_observed, p.without_observed) == (10, 5)
    assert (z.with_observed, z.without_observed) == (5, None)
    assert not answer.opportunity


def test_an_observed_plan_is_the_plan() -> None:
    """Case 3: the robot knows which of two plans the human follows, as if it had been given."""
    task = case_3()
    goal = [{"name": "it", "goal": [task.facts[f] for f in task.goal.positive]}]
    seen = serendipity.plan(task, goals=goal, observed=CASE_3_PLAN, discount="0.9", window_weight=0)
    given = serendipity.plan(task, human_plan=CASE_3_PLAN, discount="0.9", window_weight=0)
    assert (seen.cost, seen.window, seen.human_plan) == (given.cost, given.window, given.human_plan)
    assert seen.cost == 5.2


def test_one_source_for_his_plan() -> None:
    with pytest.raises(UsageError, match="human_plan"):
        serendipity.plan(workshop("-> z"), goals=[{"goal": ["p"]}], human_plan=["do1 h"])
    with pytest.raises(InputError, match="at least one goal"):
        serendipity.plan(workshop("-> z"), goals=[])


@pytest.mark.parametrize(("discount", "cost"), [("0", 7), ("0.9", 0.5)])
def test_idle_robots_are_the_answer_without_them(discount: str, cost: float) -> None:
    """What was seen is a detour: alone the human gains 3, and help has to beat that, not their plans."""
    task = build(
        goal="p",
        actions={"detour h": "-> seen @ 3", "do1 h": "-> p @ 4", "do2 h": "-> z @ 4", "push r": "-> p z @ 5"},
    )
    answer = helped(task, 1, 1, observed=["detour h"], window_weight=0, discount=discount)
    assert (answer.human_cost, answer.saving_alone) == (7, 3)
    assert (answer.cost, answer.opportunity) == (cost, cost < 4)
