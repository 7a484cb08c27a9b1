"""Actions of one name are variants of one PDDL action; ``pi_H`` has what has a name of it (semantics 3.4)."""

import pytest

from serendipity import Task
from serendipity.model import Deadline, PlanStep, Window
from serendipity_testing.builders import task as build
from tests.search.exact_answers import agreed
from verify.rules.replay import replay


def _door() -> Task:
    """The human planned to open with the key; once the robot has unlocked, opening takes no key."""
    return build(
        goal="inside",
        actions={
            "fetch h": "-> key",
            "open h": "key -> inside @ 3 | unlocked -> inside @ 3",
            "unlock r": "-> unlocked @ 0.5",
        },
    )


def _switch() -> Task:
    """What the planned action does depends on the robot: conditional effects."""
    return build(
        goal="lit",
        actions={
            "walk h": "-> there",
            "press h": "there power !lit -> pressed lit | there !power !lit -> pressed",
            "crank h": "pressed -> lit @ 5",
            "plug r": "-> power",
        },
    )


@pytest.mark.parametrize(("task", "cost"), [(_door(), 3.5), (_switch(), 3.0)], ids=["or", "when"])
def test_another_variant_of_what_was_planned_costs_no_communication(task: Task, cost: float) -> None:
    """A human who planned to open, and opens, did not change their mind."""
    answer = agreed(task, mode="communication", communication_weight=1)
    assert answer.opportunity
    assert answer.cost == answer.objective == cost


def test_nor_does_it_leave_a_prefix_of_planned_actions() -> None:
    """With the second (7b) the human may enter before the window, whatever opens the door to them."""
    task = build(
        goal="inside",
        actions={
            "fetch h": "-> key @ 4",
            "enter h": "key -> hall | unlocked -> hall",
            "go h": "key hall -> inside | unlocked hall -> inside",
            "unlock r": "-> unlocked @ 0.5",
        },
    )
    answer = agreed(task, mode="communication", keep_prefix=True, communication_weight=1, suffix="subplan")
    assert (answer.cost, answer.objective, answer.window) == (2.5, 1002.5, Window(3, 4))


@pytest.mark.parametrize("ties", ["optimistic", "robust", "expected"])
def test_plans_of_equal_names_are_one(ties: str) -> None:
    """Two of these plans differ in which key is used, and not in name; the mean counted both."""
    task = build(
        init="gold silver",
        goal="inside",
        actions={
            "open h": "gold -> inside @ 3 | silver -> inside @ 3",
            "push h": "-> inside @ 3",
            "pull r": "-> inside @ 1",
        },
    )
    answer = agreed(task, ties=ties, max_ties=2, max_cost=3, discount="0.5")
    assert answer.optimal_plans == 2
    assert [entry.human_plan for entry in answer.ties or ()] == [("open h",), ("push h",)]


def test_a_name_means_the_variant_that_fits_beside_the_others() -> None:
    """It meant the first that is applicable, which may conflict with what the human does."""

    def office(light: str) -> Task:
        return build(init="at0 lamp", goal="at1 lit", actions={"go h": "at0 -> at1 !at0", "light r": light})

    steps = [PlanStep(1, ("h",), "go h", 1.0), PlanStep(1, ("r",), "light r", 1.0)]
    one, either = office("at0 -> lit"), office("at0 -> lit | lamp -> lit")
    assert replay(one, steps, Deadline(), strict=True).fault is not None
    for order in (steps, steps[::-1]):
        assert replay(either, order, Deadline(), strict=True).fault is None
