"""What a robot takes from others is charged where they can leave it out of what is told of themselves."""

from fractions import Fraction
from random import Random

import pytest

from search.packed.packed_task import PackedTask
from search.short_windows.independent import timeline
from serendipity.model import Task
from serendipity_testing.builders import task as build
from serendipity_testing.oracle import best
from tests.search.short_windows.independent.test_bounds_are_admissible import admissible_bound, bound_and_cost
from tests.search.small_tasks import ONE_EPOCH

_CHORES = {f"a_chore_{i} h": f"-> chore_{i} @ 1" for i in range(5)}
_DONE = " ".join(f"chore_{i}" for i in range(5))
_HELP = ONE_EPOCH.but(discount="9/10")

_LEG = {
    "load_r r": "p0 at_r_0 -> in_r !p0 @ 1",
    "go_r r": "at_r_0 -> at_r_1 !at_r_0 @ 1",
    "drop_r r": "in_r at_r_1 -> p1 !in_r @ 1",
    "load_s s": "p1 at_s_1 -> in_s !p1 @ 1",
    "go_s s": "at_s_1 -> at_s_2 !at_s_1 @ 1",
    "drop_s s": "in_s at_s_2 -> p2 !in_s @ 1",
}


def _relay() -> Task:
    """One robot brings a parcel half of the way, the other takes it from there."""
    carry = {"carry h": "p0 -> p2 !p0 @ 9"}
    init = "p0 at_r_0 at_s_1"
    return build(agents="h r s", init=init, goal=f"{_DONE} p2", actions=_CHORES | carry | _LEG)


def _gate() -> Task:
    """A gate that one robot opens for both."""
    own = {"b_one h": "-> one @ 3", "b_two h": "-> two @ 3"}
    help_ = {"open s": "-> gate @ 1", "left s": "gate -> one @ 1", "reach r": "gate -> two @ 1"}
    return build(agents="h r s", goal=f"{_DONE} one two", actions=_CHORES | own | help_)


def _none(packed: PackedTask) -> list[int]:
    return packed.fields[:0]


def test_a_parcel_that_is_handed_over() -> None:
    """The second robot is charged for loading and dropping; the way between comes for nothing."""
    assert best(_relay(), _HELP).cost == Fraction("5.6")
    found = bound_and_cost(_relay(), _HELP)
    assert found[0] == Fraction("5.5")


def test_what_is_not_charged_can_be_missed(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(timeline, "leaves", _none)
    found = bound_and_cost(_relay(), _HELP)
    assert found[0] == Fraction("5.3")


def test_what_both_robots_need_is_paid_once() -> None:
    assert best(_gate(), _HELP).cost == Fraction("5.3")
    found = bound_and_cost(_gate(), _HELP)
    assert found[0] == Fraction("5.3")


def _hand_overs(dice: Random) -> Task:
    """Things that robots bring from value to value, with a tool, through a gate or beside another one."""
    chores = dice.randint(2, 4)
    actions = {f"a_chore_{i} h": f"-> chore_{i} @ 1" for i in range(chores)}
    things = {"p": dice.randint(3, 5), "q": dice.randint(2, 3)}
    for thing, values in things.items():
        actions[f"b_carry_{thing} h"] = f"{thing}0 -> {thing}{values - 1} !{thing}0 @ {dice.randint(3, 6)}"
        actions[f"c_finish_{thing} h"] = f"{thing}1 -> {thing}{values - 1} !{thing}1 @ {dice.randint(1, 3)}"
        for robot in "rs":
            for _ in range(dice.randint(2, 5)):
                start, end = dice.sample(range(values), 2)
                needs = [f"{thing}{start}"]
                needs += [f"tool_{robot}"] * dice.choice([0, 0, 1]) + ["gate"] * dice.choice([0, 0, 0, 1])
                needs += [f"q{dice.randrange(things['q'])}"] * (thing == "p" and dice.choice([0, 0, 0, 1]))
                name = f"move_{thing}_{start}_{end}_{robot}{len(actions)} {robot}"
                effect = f"{thing}{end} !{thing}{start}"
                actions[name] = f"{' '.join(needs)} -> {effect} @ {dice.choice([1, 1, 2])}"
    for robot in "rs":
        actions[f"take_{robot} {robot}"] = f"-> tool_{robot} @ 1"
    actions["open s"] = "-> gate @ 1"
    goal = [f"chore_{i}" for i in range(chores)] + [f"{thing}{n - 1}" for thing, n in things.items()]
    return build(agents="h r s", init="p0 q0", goal=" ".join(goal), actions=actions)


@pytest.mark.parametrize(
    "seeds", [range(12), pytest.param(range(12, 48), marks=pytest.mark.slow)], ids=["some", "many"]
)
def test_no_bound_is_above_the_optimum_where_things_are_handed_over(seeds: range) -> None:
    asked = exact = 0
    for seed in seeds:
        dice = Random(seed)
        task = _hand_overs(dice)
        options = ONE_EPOCH.but(discount=dice.choice(["0", "1/2", "9/10", "9/10"]))
        found = admissible_bound(task, options)
        if found is not None:
            asked, exact = asked + 1, exact + (found[0] == found[1])
    assert asked > len(seeds) * 3 / 4
    assert exact > asked / 2
