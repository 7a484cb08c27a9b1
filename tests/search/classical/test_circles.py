"""Which actions need one epoch: what could be a circle is told from what can't be."""

import pytest

import serendipity
from search.call.context import SearchContext
from search.call.prepared_task import PreparedTask
from search.packed.cost_vector import own_actions
from serendipity.model import Deadline, Options
from serendipity_testing.builders import task as build


def test_a_circle_counts_all_its_actions() -> None:
    """Of plans that cost nothing the one of two actions, not the circle of three."""
    circle = {"a h": "x -> ga !y", "b r": "y -> gb !z", "c q": "z -> gc !x"}
    more = {"d h": "-> ga gb", "e r": "-> gc"}
    task = build(
        agents="h r q",
        human="h",
        init="x y z",
        goal="ga gb gc",
        actions={name: f"{text} @ 0" for name, text in (circle | more).items()},
    )
    context = SearchContext(PreparedTask(task), Options(mode="composite", horizon="inf"), Deadline())
    if context.team is None:
        pytest.skip("the team's plans need the kernel")
    assert own_actions(context.team.planner.cheapest(context.packed.init, Deadline())) == 2


@pytest.mark.parametrize("alone", [{}, {f"buy_{fact} h": f"-> {fact} @ 20" for fact in "xyz"}])
def test_circles_with_an_action_in_common_need_one_epoch(alone: dict[str, str]) -> None:
    """The middle one and each of the others disable each other: any two of them rule out the third."""
    chain = {"left h": "p -> x !q @ 1", "middle r": "q s -> y !p !t @ 1", "right b": "t -> z !s @ 1"}
    task = build(agents="h r b", init="p q s t", goal="x y z", actions=chain | alone)
    answer = serendipity.plan(task, mode="composite", horizon="inf", discount="0.5")
    assert (answer.status, answer.cost) == ("optimal", 2)
    assert serendipity.verify(task, answer).verdict == "proved"


@pytest.mark.parametrize(("interference", "least"), [("paper", 1.5), ("strict", 2.5)])
@pytest.mark.parametrize("limit", [None, 60])
def test_what_one_takes_from_another_is_there_in_the_same_epoch(
    interference: str, least: float, limit: float | None
) -> None:
    """Bounds about sequences cut nothing off."""
    box = {"close h": "free -> lid !free", "cover h": "-> lid @ 2", "pack r": "free -> box"}
    task = build(init="free", goal="lid box", actions=box | {"open r": "lid -> !lid free @ 5"})
    options = {"discount": "0.5", "interference": interference, "time_limit": limit}
    assert serendipity.plan(task, mode="composite", horizon=1, **options).cost == least
