"""Regret is what the proof says, harm is seen, and the same season has the same table."""

from dataclasses import replace
from fractions import Fraction
from random import Random
from typing import Any

import pytest

from serendipity.model import UsageError
from serendipity_testing.league import League, league, season
from serendipity_testing.league.play import played
from serendipity_testing.league.protocol import AskedRobots, Helper
from serendipity_testing.league.scores import interval, score
from serendipity_testing.tests.league.small import ALONE, DOOR, LEAST, at_the_door, does

FAMILIES = ("buildings", pytest.param("homes", marks=pytest.mark.slow), "competition")


@pytest.mark.long
def test_the_same_season_has_the_same_table() -> None:
    names = ("idle", "greedy", "random", "ours-policy")
    asked = {"families": ["buildings", "competition"], "cases": 2, "deadline": None}
    first, again, other = (league(name, names, **asked) for name in ("spring", "spring", "fall"))
    assert (first.to_json(), str(first), first.page()) == (again.to_json(), str(again), again.page())
    assert first.rows[0].case == "spring buildings 1"
    assert [row.alone for row in first.rows] != [row.alone for row in other.rows]


@pytest.mark.long
@pytest.mark.parametrize("family", FAMILIES)
def test_the_optimal_helper_has_no_regret_and_idle_that_of_all_that_can_be_saved(family: str) -> None:
    found = league(
        "spring", ["ours-policy", "ours-fixed", "ours", "idle"], families=[family], cases=2, deadline=None
    )
    for row in found.rows:
        assert row.proved and row.optimum <= row.alone, row
        if row.helper in ("ours-policy", "ours") or (row.plans == 1 and row.helper != "idle"):
            assert (row.regret, row.lost, row.bad) == (0, 0, 0), row
        if row.helper == "idle":
            assert (row.regret, row.harm, row.later) == (pytest.approx(row.alone - row.optimum), 0, 0), row


@pytest.mark.long
@pytest.mark.parametrize("family", FAMILIES)
def test_nobody_does_better_than_the_optimum(family: str) -> None:
    """Whatever robots do and the person is asked, by chance: the optimum is one for all of that."""
    for case in season("fall", [family], 4):
        assert case.proved
        for seed in range(8):
            persons = list(played(case, Helper("dice", lambda case, _: _by_dice(case, seed)), None))  # noqa: B023
            paid = sum((one.scenario.probability * one.paid for one in persons), Fraction(0))
            in_time = all(one.arrived is not None and one.arrived <= case.horizon for one in persons)
            assert paid >= case.optimum or not in_time, (case.name, seed)
            assert score("dice", case, persons).regret >= 0


def _by_dice(case: Any, seed: int) -> AskedRobots:
    """The same wherever it sees the same."""
    human = [a.name for a in case.task.actions if a.participants == (case.task.human,)]
    plans = {one.name: [case.task.actions[i].name for i in one.plan] for one in case.scenarios}

    def ask(seen: dict[str, Any]) -> Any:
        dice = Random(f"{seed} {seen['history']}")
        alone = {
            r: [n for n in names if sum(other in n.split() for other in seen["task"]["robots"]) == 1]
            for r, names in seen["legal"].items()
        }
        actions = {robot: dice.choice([None, *names]) for robot, names in alone.items()}
        wishes = {name: dice.choice([None, dice.choice(human), *plan]) for name, plan in plans.items()}
        return {"actions": actions, "human": wishes if dice.random() < 0.3 else {}}

    return AskedRobots(case, ask)


def test_a_helper_that_helps_saves_what_can_be_saved() -> None:
    row = at_the_door(does("unlock robot"))
    assert (row.alone, row.optimum, row.paid, row.regret, row.bad) == (ALONE, LEAST, LEAST, 0, 0)


def test_who_is_locked_out_is_harmed() -> None:
    row = at_the_door(does("bar robot"))
    assert (row.paid, row.regret, row.harmed, row.harm) == (10, 8, 1, 5)


def test_who_is_asked_for_what_is_dear_is_harmed_and_comes_later() -> None:
    def waves(seen: dict[str, Any]) -> Any:
        return {"human": {"plan 1": "wave ann"}} if seen["epoch"] == 1 else None

    row = at_the_door(waves)
    assert (row.paid, row.harm, row.later) == (12, 7, 1)


def test_who_never_gets_there_counts_as_harmed() -> None:
    row = at_the_door(lambda _: {"human": {"plan 1": None}})
    assert (row.lost, row.harmed, row.regret, row.decisions) == (1, 1, 2 * ALONE - LEAST, 6)


def test_without_a_proof_regret_is_from_the_bound_and_marked() -> None:
    (case,) = season("small", tasks=[DOOR])
    open_ = replace(case, result=replace(case.result, status="feasible", lower_bound=1.0))
    persons = list(played(open_, Helper("idle", lambda case, _: AskedRobots(case, lambda _: None)), None))
    row = score("idle", open_, persons)
    assert (row.optimum, row.regret, row.proved) == (1, 4, False)
    shown = str(League("small", None, (row,)))
    assert "4.00*" in shown and "not proved" in shown


def test_intervals_hold_the_mean_and_are_the_same_each_time() -> None:
    values = [0.0, 0.0, 1.0, 5.0, 2.0]
    low, high = interval(values, "seed")
    assert low < 1.6 < high and interval(values, "seed") == (low, high)
    assert interval([3.0, 3.0], "seed") == (3, 3)


@pytest.mark.long
def test_where_goals_differ_nobody_tells_when_one_is_reached() -> None:
    """So a run goes on as long as anybody with another goal might still be on the way."""
    cases = season("spring", ["homes"], 3)
    case = next(case for case in cases if case.torn)
    for one in played(case, Helper("idle", lambda case, _: AskedRobots(case, lambda _: None)), None):
        assert one.epochs == case.horizon and one.arrived == len(one.scenario.plan)


def test_what_is_asked_wrongly_is_said_in_a_line() -> None:
    with pytest.raises(
        UsageError, match="families: expected some of buildings, homes, competition, got 'ships'"
    ):
        league("spring", ["idle"], families=["ships"])
    with pytest.raises(UsageError, match="helpers: two are named 'idle'"):
        league("spring", ["idle", "idle"], tasks=[DOOR])
    with pytest.raises(UsageError, match="door: expected a person who has 2 to 25 actions"):
        league("spring", ["idle"], tasks=[DOOR.at(DOOR.init | {DOOR.facts.index("inside")})])


def test_tasks_of_one_name_are_told_apart() -> None:
    """What was planned or learnt for one of them is not taken for the other."""
    other = DOOR.at(DOOR.init | {DOOR.facts.index("open")})
    found = league("small", ["ours-policy"], tasks=[DOOR, other])
    assert [(row.alone, row.paid, row.lost) for row in found.rows] == [(ALONE, LEAST, 0), (2, 2, 0)]
    assert len({row.case for row in found.rows}) == 2
