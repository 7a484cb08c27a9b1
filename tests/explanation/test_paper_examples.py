"""The examples of sections III-B to III-D, explained rightly."""

from fractions import Fraction

import pytest

import serendipity
from serendipity import Explanation, UsageError
from serendipity.testing import cases
from serendipity.testing.builders import task


def explained(name: str, **options: object) -> Explanation:
    return serendipity.explain(serendipity.example(name), **options)


def reasons(found: Explanation) -> dict[int, str]:
    return {moment.start: moment.why for moment in found.moments}


def test_room2_is_helped_in_hall4() -> None:
    found = explained("room2", discount="0.6")
    assert found.removal.removed == (
        "move_reverse commx hall4 hall3",
        "move_reverse commx hall3 hall2",
        "move_reverse commx hall2 room2",
        "pick_up_medkit commx mk1 room2",
        "move commx room2 hall2",
    )
    assert found.removal.replacement[0] == "hand_over robot commx mk2 hall4"
    assert (found.parts.human, found.parts.robots) == (11, 4)
    assert reasons(found) == (
        dict.fromkeys(range(1, 6), "not-in-time")
        | {6: "chosen"}
        | dict.fromkeys((7, 8), "costs-more")
        | dict.fromkeys(range(9, 14), "prefix")
    )
    assert (found.discount.value, found.discount.included) == (Fraction(1, 2), False)
    assert [c.opportunity for c in found.discount.confirmed] == [False, False, True]
    assert found.announcement.cost == found.answer.cost == 12.6
    assert not any("is not told" in text for _, text in found.sentences)
    assert found.misses == ()


def test_room2_at_a_half_costs_as_much_as_it_saves() -> None:
    found = explained("room2", discount="0.5")
    assert not found.answer.opportunity
    assert set(reasons(found).values()) == {"costs-more", "prefix"}
    assert found.misses == ()
    assert any("above a discount of 0.5" in text for _, text in found.sentences)


def test_room7_needs_a_word() -> None:
    found = explained("room7", discount="0.6")
    assert not found.answer.opportunity
    assert found.discount.value is None
    assert found.announcement.cost == 12.6
    assert {miss.rule for miss in found.misses} == {"window-length", "prefix"}
    assert {(miss.cost, miss.saving) for miss in found.misses} == {(12.6, 0.4)}
    for miss in found.misses:
        assert (miss.window.start, miss.window.end) == (3, 7)
        assert "pick_up_medkit commx mk1 room7" in miss.removal.removed
        assert "hand_over robot commx mk2 hall4" in miss.removal.replacement
    assert (found.window_weight.value, found.window_weight.included) == (Fraction(2, 15), True)
    assert [c.opportunity for c in found.window_weight.confirmed] == [True, True, False]


def test_room5_is_helped_without_meeting() -> None:
    found = explained("room5", discount="0.9")
    assert (found.parts.human, found.parts.robots) == (11, 5)
    assert (found.discount.value, found.discount.included) == (Fraction(3, 5), False)
    assert found.announcement.cost == 11.4
    assert any("would gain 0.1" in text for _, text in found.sentences)
    assert any("commx is not told" in text for _, text in found.sentences)


def test_room5_at_0_6_only_breaks_even() -> None:
    found = explained("room5", discount="0.6")
    assert not found.answer.opportunity
    assert {miss.rule for miss in found.misses} == {"window-length", "prefix"}
    assert found.misses[0].cost == 12.6


def test_an_answer_is_explained_under_its_own_options() -> None:
    task = serendipity.example("room2")
    answer = serendipity.plan(task, discount="0.9")
    found = serendipity.explain(task, serendipity.Result.from_dict(answer.to_dict()))
    assert found.answer.cost == answer.cost == 11.4
    assert found.discount == explained("room2", discount="0.9").discount
    with pytest.raises(UsageError, match="both"):
        serendipity.explain(task, answer, discount="0.9")


@pytest.mark.parametrize("options", [{"mode": "individual"}, {"mode": "assistance"}])
def test_what_has_no_explanation(options: dict[str, str]) -> None:
    with pytest.raises(UsageError, match="explain"):
        explained("room2", **options)


def test_a_human_without_a_plan() -> None:
    found = serendipity.explain(cases.case_8())
    assert next(text for topic, text in found.sentences if topic == "help").startswith(
        "h can't reach the goal"
    )
    assert found.to_dict()["reason"] == "no-human-plan"
    together = serendipity.explain(cases.case_8(), mode="composite")
    assert "Together they can: for 2." in dict(together.sentences).values()


def test_a_goal_that_holds_already() -> None:
    there = task(init="g", goal="g", actions={"undo h": "g -> !g", "do r": "!g -> g"})
    words = [text for topic, text in serendipity.explain(there).sentences if topic == "help"]
    assert words == ["The goal of h holds already, so there is nothing to help with."]


def test_help_that_pays_at_every_discount() -> None:
    found = serendipity.explain(cases.case_9())
    assert (found.discount.value, found.discount.included) == (0, True)
    assert any("every discount" in text for _, text in found.sentences)
