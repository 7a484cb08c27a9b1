"""Where all plans have an even number of steps, or all an odd one: it is so, and costs stay what they are."""

from collections import deque
from itertools import product
from random import Random

import pytest
from hypothesis import given

from search.classical import planner as planner_module
from search.classical.canonical import canonical_plan
from search.classical.parity import Parity, parity_of
from search.classical.planner import ClassicalPlanner
from search.kernel.library import library
from search.packed.operators import applicable
from search.packed.packed_task import PackedTask
from serendipity.model import Deadline, Task
from serendipity.testing.builders import task as build
from serendipity.testing.generator.families import family_task
from serendipity.testing.strategies import tasks
from tests.search.classical.exact_costs import exact, packed_of
from tests.search.classical.test_canonical_plans import first_of_all
from tests.search.classical.test_kernel_equals_brute_force import planner_of

pytestmark = pytest.mark.skipif(library() is None, reason="there is no kernel here")


def parity(packed: PackedTask) -> Parity | None:
    return parity_of(planner_of(packed).problem, packed.init, Deadline())


def lengths(packed: PackedTask, start: int, *, idle: bool = True) -> set[int]:
    """Of all ways to a goal the numbers of steps, modulo 2, by brute force; ``idle`` ones included."""
    found, waiting = {(start, 0)}, deque([(start, 0)])
    while waiting:
        state, odd = waiting.popleft()
        for op in packed.own:
            after = state & op.keep | op.put, 1 - odd
            if applicable(op, state) and (idle or after[0] != state) and after not in found:
                found.add(after)
                waiting.append(after)
    return {odd for state, odd in found if packed.goal.holds(state)}


@given(tasks())
def test_plans_are_as_long_as_it_says(task: Task) -> None:
    packed = packed_of(task)
    known = parity(packed)
    for state in exact(packed) if known else ():
        assert lengths(packed, state, idle=False) <= {known.of(state)}


@pytest.mark.parametrize("family", ["blocks", "switches"])
def test_it_is_known_where_it_is_so(family: str) -> None:
    known_for = []
    for seed in range(10):
        packed = packed_of(family_task(family, seed, 4))
        known, plans = parity(packed), lengths(packed, packed.init)
        known_for.append(known is not None)
        if plans:
            assert plans == ({0, 1} if known is None else {known.of(packed.init)})
    assert any(known_for)
    assert not all(known_for)


def walk(*ways: str, goal: str = "at_a", **others: str) -> PackedTask:
    """Somebody walks to and fro, and may do other things."""
    actions = {f"go {a} {b} h": f"at_{a} -> at_{b} !at_{a}" for way in ways for a, b in (way, way[::-1])}
    others = {f"{name} h": text for name, text in others.items()}
    return packed_of(build(init="at_b", goal=goal, actions=actions | others))


def test_on_a_grid_every_other_place_is_black() -> None:
    known = parity(packed := walk("ab", "bc", "ad", "be", "cf", "de", "ef"))
    assert known is not None
    assert known.of(packed.init) == 1


@pytest.mark.parametrize("text", ["wings at_b -> at_d !at_b", "at_c -> at_c"])
def test_what_changes_nothing_does_not_matter(text: str) -> None:
    packed = walk("ab", "bc", "cd", other=text)
    known = parity(packed)
    assert known is not None
    assert known.of(packed.init) == 1


@pytest.mark.parametrize(
    "packed",
    [
        walk("ab", "bc", "ca"),
        walk("ab", goal="seen", look="at_a -> seen", glance="at_b -> seen"),
        walk("ab", goal="at_a seen", look="at_b -> seen"),
        walk("ab", goal="at_a tall", jump="!high -> high", stand="high -> !high", measure="high -> tall"),
    ],
    ids=["a ring of three", "two places to see it from", "it can be looked at again", "it may be up or down"],
)
def test_plans_of_either_length(packed: PackedTask) -> None:
    assert parity(packed) is None
    assert lengths(packed, packed.init) == {0, 1}


def test_a_state_from_elsewhere_is_not_judged() -> None:
    """Somebody else may put the human where they would never have come to."""
    packed = walk("ab", goal="at_a", leave="away -> at_a !away")
    known = parity(packed)
    assert known is not None
    from_elsewhere = [state for state in range(packed.all_ones + 1) if known.of(state) is None]
    assert from_elsewhere
    assert packed.init not in from_elsewhere


@given(tasks())
def test_costs_stay_what_they_are(task: Task) -> None:
    packed = packed_of(task)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(planner_module, "_MANY", 0)
        patch.setattr(planner_module, "SLICE", 1e-6)
        planner = planner_of(packed)
        for state, cost in exact(packed).items():
            assert planner.cheapest(state, Deadline()) == cost


def _gathering(dice: Random, dearest: int) -> PackedTask:
    """Somebody gathers what lies about on a grid, where a step costs up to so much."""
    side = range(4)
    actions = {}
    for x, y in product(side, side):
        for there in ((x + 1, y), (x - 1, y), (x, y + 1), (x, y - 1)):
            if there[0] in side and there[1] in side:
                here, after = f"at_{x}{y}", f"at_{there[0]}{there[1]}"
                actions[f"go {here} {after} h"] = f"{here} -> {after} !{here} @ {dice.randint(1, dearest)}"
    things = dice.sample([f"{x}{y}" for x, y in product(side, side)], 4)
    actions |= {f"take {thing} h": f"at_{thing} !has_{thing} -> has_{thing} @ 1" for thing in things}
    goal = "at_33 " + " ".join(f"has_{thing}" for thing in things)
    return packed_of(build(init="at_00", goal=goal, actions=actions))


def _viewing(dice: Random) -> PackedTask:
    """Somebody turns to one thing after another, some of which want another lens, and each second turn is to
    the other side: turning to a thing is in vain with the wrong lens.
    """
    lens = {f"q{i}": dice.choice(["one", "two"]) for i in range(6)}
    places = ["start", "desk", *lens]
    dice.shuffle(places)
    sides = places[::2], places[1::2]
    turns = [(a, b) for side, other in (sides, sides[::-1]) for a in side for b in other]
    actions = {f"turn {a} {b} h": f"{a} -> {b} !{a}" for a, b in turns}
    actions |= {f"view {q} h": f"{q} {which} !seen_{q} -> seen_{q}" for q, which in lens.items()}
    actions |= {"change h": "desk one -> two !one", "change back h": "desk two -> one !two"}
    goal = "start two " + " ".join(f"seen_{q}" for q in lens)
    return packed_of(build(init="start one", goal=goal, actions=actions))


def _knowing(packed: PackedTask) -> ClassicalPlanner:
    """A planner that has looked for the parity of plans' lengths."""
    planner = planner_of(packed)
    planner.cheapest(packed.init, Deadline(), limit=1)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(planner_module, "_MANY", 0)
        planner._find_parity(Deadline())
    return planner


@pytest.mark.parametrize("seed", range(6))
def test_steps_that_cost_differently(seed: int) -> None:
    """How many steps it takes says nothing of what it costs."""
    dice = Random(seed)
    packed = _gathering(dice, 9)
    assert parity(packed) is not None
    planner, costs = _knowing(packed), exact(packed)
    for state in dice.sample([*costs], 20):
        assert planner.cheapest(state, Deadline()) == costs[state]


@pytest.mark.parametrize("seed", range(12))
def test_the_canonical_plan_is_still_the_first(seed: int) -> None:
    dice = Random(seed)
    packed = _viewing(dice) if seed % 2 else _gathering(dice, 1)
    planner, costs = _knowing(packed), exact(packed)
    assert planner._parity is not None
    assert canonical_plan(planner, packed.init, Deadline()) == first_of_all(packed, planner, costs)
    for state in costs:
        assert planner.bound(state, Deadline()) <= costs[state]
        assert planner.cheapest(state, Deadline()) == costs[state]


def test_states_that_would_not_come_out_even_are_not_expanded(monkeypatch: pytest.MonkeyPatch) -> None:
    packed = packed_of(family_task("blocks", 36, 10))
    found = []
    for many in (2_000, 10**9):
        monkeypatch.setattr(planner_module, "_MANY", many)
        planner = planner_of(packed)
        found.append((planner.cheapest(packed.init, Deadline()), planner.counts()[0]))
    (cost, few), (same, all_of_them) = found
    assert cost == same
    assert few < 0.6 * all_of_them
