"""An operator of an optimal plan adds something for a later one: what that saves."""

import pytest

from search.classical.canonical import canonical_plan
from search.kernel.library import library
from serendipity.model import Deadline, Task
from serendipity.testing.builders import task as build
from tests.search.classical.test_kernel_equals_brute_force import planner_of
from tests.search.small_tasks import packed_of

pytestmark = pytest.mark.skipif(library() is None, reason="there is no kernel here")


def _views() -> Task:
    """Things to look at through one lens, then another, changed at the desk: it is in vain to turn to a thing
    with the wrong lens.
    """
    views = {f"q{i}": "one" for i in range(4)} | {f"p{i}": "two" for i in range(4)}
    places = ["start", "desk", *views]
    actions = {f"turn {a} {b} h": f"{b} -> {a} !{b}" for a in places for b in places if a != b}
    actions |= {f"view {place} h": f"{place} {lens} -> seen_{place}" for place, lens in views.items()}
    actions |= {"change h": "desk one -> two !one"}
    return build(init="start one", goal=" ".join(f"seen_{place}" for place in views), actions=actions)


def test_most_steps_in_vain_are_refuted_without_a_search() -> None:
    task = _views()
    packed = packed_of(task)
    planner = planner_of(packed)
    found = canonical_plan(planner, packed.init, Deadline())
    names = [" ".join(task.actions[packed.own[number].action].key) for number in found]
    assert " ".join(name.split()[1] for name in names[::2]) == "q0 q1 q2 q3 desk p0 p1 p2 p3"
    assert planner.counts()[0] < 30, "51 where each of them is tried"
