"""What counts as an opportunity (semantics 1, 3.1), and that the verifier means the same by it."""

import pytest

import serendipity
from serendipity import Task
from serendipity.model import Options, Window
from serendipity_testing.builders import task as build
from tests.search.exact_answers import agreed, proved
from verify.calls.solve import solve


def _tidy(init: str = "", **more: str) -> Task:
    """The human could do the robots' work more cheaply than they."""
    actions = {"do h": "-> done", "tidy h": "-> tidy", "clean r": "-> tidy @ 5"}
    return build(init=init, goal="done", robot_goal="tidy", actions=actions | more)


@pytest.mark.parametrize("mode", ["serendipity", "communication", "composite"])
def test_beside_an_optimal_plan_it_is_whatever_costs_less(mode: str) -> None:
    """No robot acts; the verifier refuted it for that."""
    answer = agreed(_tidy(), mode=mode, horizon=2, window_weight=0)
    assert (answer.cost, answer.opportunity, answer.saving) == (2.0, True, 4.0)
    assert {agent for step in answer.plan or () for agent in step.agents} == {"h"}


def test_also_where_there_is_no_baseline() -> None:
    """Robots can't reach their goal without the human: there is nothing to compare with."""
    task = build(goal="done", robot_goal="tidy", actions={"do h": "-> done", "tidy h": "-> tidy done"})
    answer = agreed(task, horizon=1, window_weight=0)
    assert (answer.cost, answer.opportunity, answer.saving) == (1.0, True, None)


def test_unless_the_given_plan_is_not_optimal_and_no_robot_acts() -> None:
    """There is no saving then either; the verifier asked for one of 0."""
    tidy = {"do h": "-> done", "detour h": "-> done @ 7", "tidy h": "-> tidy done"}
    task = build(goal="done", robot_goal="tidy", actions=tidy)
    answer = agreed(task, ["detour h"], mode="communication")
    assert (answer.cost, answer.opportunity, answer.saving) == (1.0, False, None)


@pytest.mark.parametrize("mode", ["serendipity", "communication", "composite"])
def test_beside_a_plan_that_is_not_optimal_a_robot_has_to_act(mode: str) -> None:
    """What the human can do alone is no help; the planner called it that where robots have goals."""
    task = _tidy(**{"detour h": "-> done @ 7"})
    answer = agreed(task, ["detour h"], mode=mode, horizon=2, window_weight=0)
    assert (answer.opportunity, answer.saving, answer.saving_alone) == (False, 0.0, 0.0)
    assert answer.cost == (12.0 if mode == "serendipity" else 2.0)
    helped = agreed(task, ["detour h"], mode=mode, horizon=2, window_weight=0, discount="0.9")
    assert (helped.cost, helped.opportunity, helped.saving) == (1.5, True, 6.0)


@pytest.mark.parametrize("human_model", ["observant", "local"])
def test_also_under_a_human_model(human_model: str) -> None:
    """Shown a detour the human turns round alone, and does the robots' work by the way."""
    task = _tidy(**{"detour h": "-> done @ 7", "do h": "-> done tidy"})
    answer = proved(task, human_plan=["detour h"], human_model=human_model)
    assert (answer.cost, answer.opportunity, answer.saving) == (1.0, False, 0.0)


def test_a_limit_never_rejects_doing_nothing() -> None:
    """The integer program forgot that where robots have goals, and proved a worse plan best."""
    task = build(
        goal="done",
        robot_goal="tired",
        actions={"do h": "-> done @ 4", "late h": "open -> done @ 2.5", "open r": "-> open tired @ 0"},
    )
    options = {"mode": "communication", "horizon": 2, "max_cost": 3, "communication_weight": 1}
    answer = agreed(task, **options)
    assert (answer.cost, answer.objective, answer.opportunity) == (4.0, 4.0, False)


@pytest.mark.parametrize("mode", ["serendipity", "communication", "composite", "individual"])
@pytest.mark.parametrize("human_plan", [None, []])
def test_goals_that_hold_already_need_no_horizon(mode: str, human_plan: list[str] | None) -> None:
    """Only a goal of the robots' that is open does."""
    held = _tidy("done tidy")
    answer = agreed(held, human_plan, mode=mode)
    assert (answer.cost, answer.horizon, answer.opportunity) == (0.0, 0, False)
    session = serendipity.Session(held, mode=mode)
    assert session.plan().cost == session.plan().cost == 0.0


@pytest.mark.parametrize("human_model", ["observant", "local"])
def test_nor_under_a_human_model(human_model: str) -> None:
    answer = serendipity.plan(_tidy("done tidy"), human_model=human_model)
    assert (answer.cost, answer.horizon) == (0.0, 0)
    assert serendipity.verify(_tidy("done tidy"), answer).verdict == "proved"


@pytest.mark.parametrize("mode", ["serendipity", "communication"])
def test_an_open_goal_of_robots_needs_one(mode: str) -> None:
    with pytest.raises(serendipity.UsageError, match="horizon: must be given"):
        serendipity.plan(_tidy("done"), mode=mode)
    with pytest.raises(serendipity.UsageError, match="horizon: expected a number"):
        solve(_tidy("done"), Options(mode=mode))


@pytest.mark.parametrize("mode", ["communication", "composite"])
def test_without_an_opportunity_nothing_is_saved(mode: str) -> None:
    """The answer is still the optimum: what the human gains alone is ``saving_alone``."""
    task = build(goal="done", actions={"do h": "-> done @ 2", "detour h": "-> done @ 7", "aid r": "-> aided"})
    answer = agreed(task, ["detour h"], mode=mode)
    assert (answer.cost, answer.opportunity, answer.saving, answer.saving_alone) == (2.0, False, 0.0, 5.0)


@pytest.mark.parametrize("human_model", ["observant", "local"])
def test_under_a_human_model_its_optimum_counts_even_where_it_is_dearer(human_model: str) -> None:
    """The human would take the short cut that robots open by the way, and undo what these are about to do."""
    task = build(
        goal="done",
        robot_goal="tidy",
        actions={
            "go h": "-> there",
            "do h": "there -> done @ 4",
            "cut h": "there ready -> done !ready !tidy",
            "prepare r": "-> ready",
            "tidy r": "ready -> tidy",
            "scrub r": "-> tidy @ 9",
        },
    )
    baseline = agreed(task)
    assert (baseline.cost, baseline.opportunity) == (7.0, False)
    answer = proved(task, human_model=human_model)
    assert (answer.cost, answer.opportunity, answer.saving) == (14.0, False, 0.0)


def test_windows_are_those_of_the_mode() -> None:
    """The tie between a short window and a low cost goes to the lower cost."""
    answer = agreed(_tidy(), horizon=2, window_weight=4)
    assert (answer.cost, answer.window, answer.opportunity) == (2.0, Window(1, 2), True)


def test_the_human_alone_may_need_longer_than_the_given_plan() -> None:
    """Its last step was after the horizon, which was the given plan's length."""
    planned = build(
        goal="g",
        actions={"dash h": "-> g @ 3", "walk h": "-> near", "stop h": "near -> g @ 0", "help r": "-> x"},
    )
    answer = proved(planned, mode="individual", human_plan=["dash h"])
    assert (answer.cost, answer.horizon, answer.saving_alone) == (1, 2, 2)
