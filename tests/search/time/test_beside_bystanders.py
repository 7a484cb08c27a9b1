"""Small tasks beside a bystander: what they undo, whom they are in the way of, and when they can't go on."""

from fractions import Fraction

import pytest

import serendipity
from serendipity import Task
from serendipity.model import Options, Script
from serendipity_testing.builders import task
from serendipity_testing.call import Call
from serendipity_testing.oracle import best
from tests.search.exact_answers import assert_answered, proved
from tests.verify.edits.corpus import shop

AGENTS = {"agents": "h r q", "human": "h"}


def test_robots_goals_that_a_bystander_undoes_later_are_not_reached() -> None:
    actions = {"a h": "-> f", "b r": "-> g", "c q": "-> !g"}
    wanted = task(**AGENTS, goal="f", robot_goal="g", actions=actions)
    undone = wanted.with_script(Script(people={"q": [(2, "c q")]}))
    assert serendipity.plan(wanted, horizon=2).status == "optimal"
    answer = serendipity.plan(undone, horizon=2)
    assert answer.status == best(undone, Options(horizon=2)).status == "infeasible"


def test_robots_goals_that_the_human_reaches_unless_a_bystander_does() -> None:
    """Help spares the human what would reach the robots' goal, too; the bystander sees to that later."""
    built = task(
        **AGENTS,
        init="dirty",
        goal="done",
        robot_goal="!dirty",
        actions={"do h": "-> done !dirty @ 2", "help r": "-> done @ 1", "sweep q": "-> !dirty [3]"},
    ).with_script(Script(people={"q": [(1, "sweep q")]}))
    answer = serendipity.plan(built, horizon=3)
    assert (answer.cost, answer.opportunity) == (1, True)
    assert serendipity.verify(built, answer).verdict == "proved"


def test_robots_goals_that_a_bystander_reaches_once_the_human_is_done() -> None:
    actions = {"a h": "-> f @ 3", "b r": "k -> f !k", "c q": "-> g"}
    later = task(**AGENTS, init="k", goal="f", robot_goal="g", actions=actions).with_script(
        Script(people={"q": [(3, "c q")]})
    )
    options = {"horizon": 3, "discount": "0.5", "window_weight": 0}
    assert_answered(Call(later, Options(**options)))


def test_what_robots_do_last_in_a_window_may_be_for_a_bystander() -> None:
    """They borrow what the bystander needs after it, and bring it back."""
    borrowed = task(
        **AGENTS,
        init="k",
        goal="f",
        actions={"walk h": "-> e", "jump h": "m e -> f", "go h": "e -> f @ 4"}
        | {"take r": "-> m !k", "put r": "-> k", "use q": "k -> g"},
    ).with_script(Script(people={"q": [(3, "use q")]}))
    answer = serendipity.plan(borrowed, horizon=3)
    assert answer.cost == best(borrowed, Options(horizon=3)).cost == 4
    assert serendipity.verify(borrowed, answer).verdict == "proved"


def blocked() -> Task:
    """A human whose only way is where a bystander is at first, under strict interference."""
    built = task(
        **AGENTS, goal="f", actions={"a h": "!k -> f", "b r": "-> g", "c q": "-> k", "d q": "k -> !k"}
    )
    return built.with_script(Script(people={"q": [(1, "c q"), (2, "d q")]}))


@pytest.mark.parametrize(("interference", "epochs"), [("paper", 1), ("strict", 3)])
def test_under_strict_interference_nobody_acts_on_what_a_bystander_changes(
    interference: str, epochs: int
) -> None:
    assert serendipity.plan(blocked(), mode="individual", interference=interference).horizon == epochs


def test_without_a_plan_after_a_head_start_the_team_may_have_one() -> None:
    built = task(**AGENTS, init="k", goal="f", actions={"a h": "k -> f", "b r": "-> f", "c q": "-> !k"})
    gone = built.with_script(Script(people={"q": [(1, "c q")]}))
    assert serendipity.plan(gone, head_start=1).status == "infeasible"
    options = Options(mode="composite", horizon=3, head_start=1, discount="0.5")
    answer = serendipity.plan(gone, mode="composite", horizon=3, head_start=1, discount="0.5")
    assert (answer.status, answer.cost, answer.human_plan) == ("optimal", 0.5, None)
    assert best(gone, options).cost == Fraction(1, 2)


def test_what_the_script_changes_back_is_counted_among_what_help_may_wait_for() -> None:
    """A way is blocked for a while; the ramp that a robot lays saves the human the door at its end."""
    assert serendipity.plan(shop(), discount=0.5).cost == 3.5
    assert best(shop(), Options(discount="0.5")).cost == Fraction(7, 2)


def test_what_the_script_brings_costs_robots_nothing() -> None:
    steps = {"a h": "at0 -> at1 !at0", "b h": "at1 -> at2 !at1", "c h": "at2 !shut -> at3 !at2"}
    built = task(agents="h r", human="h", init="at0", goal="at3", actions={**steps, "d r": "-> !shut"})
    scripted = built.with_script(Script(facts=[(1, "shut"), (1, "at2")]))
    options = {"mode": "composite", "discount": 0, "horizon": "inf"}
    assert serendipity.plan(scripted, **options).cost == best(scripted, Options(**options)).cost == 2


def test_who_rests_in_their_plan_may_wait_before_a_window_instead() -> None:
    """The goal comes by itself in epoch 3; a robot wants something else, for which the human has to wait."""
    actions = {"a h": "m -> !n @ 0", "b r": "k -> m @ 1/2"}
    later = task(init="k n", goal="g", robot_goal="!n", actions=actions).with_script(Script(facts=[(3, "g")]))
    options = {"window_weight": "0.25", "waiting_cost": "0.5", "horizon": 4}
    assert_answered(Call(later, Options(**options)))
    proved(later, **options)
