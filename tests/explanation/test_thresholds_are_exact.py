"""Help exists on one side of a reported threshold, and not on the other.

The examples of sections III-B to III-D of the paper are explained rightly.
"""

from fractions import Fraction

import pytest
from hypothesis import given
from hypothesis import strategies as st

import serendipity
from serendipity import Explanation, PlanError, UsageError
from serendipity.model import Options
from serendipity_testing import cases
from serendipity_testing.builders import task
from serendipity_testing.strategies import Call, calls, calls_in_time

WINDOWED = st.one_of(calls(modes=("serendipity",), ties=False), calls_in_time(modes=("serendipity",)))
DISCOUNTS = st.fractions(0, 1, max_denominator=12)
WEIGHTS = st.fractions(0, 6, max_denominator=12)


def explained(call: Call) -> Explanation | None:
    """The explanation of a call; None where it is an error, as planning is."""
    try:
        return serendipity.explain(call.task, human_plan=call.human_entries, **call.keywords())
    except (UsageError, PlanError):
        with pytest.raises((UsageError, PlanError)):
            serendipity.plan(call.task, human_plan=call.human_entries, **call.keywords())
        return None


def helped(call: Call, **changes: object) -> bool:
    keywords = call.keywords(**changes)
    return serendipity.plan(call.task, human_plan=call.human_entries, **keywords).opportunity


@given(
    st.one_of(
        calls(modes=("serendipity", "communication", "composite"), ties=False),
        calls_in_time(modes=("serendipity", "communication", "composite")),
    ),
    DISCOUNTS,
)
def test_help_begins_at_the_reported_discount(call: Call, discount: Fraction) -> None:
    found = explained(call)
    if found is None or found.discount is None:
        return
    value = found.discount.value
    pays = value is not None and (discount > value or (discount == value and found.discount.included))
    assert helped(call, discount=discount) == pays
    for confirmation in found.discount.confirmed:
        assert helped(call, discount=confirmation.value) == confirmation.opportunity


@given(WINDOWED, WEIGHTS)
def test_longer_windows_help_up_to_the_reported_weight(call: Call, weight: Fraction) -> None:
    found = explained(call)
    if found is None or found.window_weight is None:
        return
    value = found.window_weight.value
    pays = value is not None and (weight < value or (weight == value and found.window_weight.included))
    assert helped(call, window_weight=weight) == pays


@pytest.mark.long
@given(WINDOWED)
def test_relaxed_rules_give_what_is_said(call: Call) -> None:
    found = explained(call)
    if found is None:
        return
    assert not (found.misses and found.answer.opportunity)
    for miss in found.misses:
        changes = (
            {"window-length": {"window_weight": 0}, "prefix": {"mode": "communication"}}.get(miss.rule)
            # All others are options, and the default is the loosest.
            or {miss.rule: getattr(Options(), miss.rule)}
        )
        keywords = call.keywords(**changes)
        answer = serendipity.plan(call.task, human_plan=call.human_entries, **keywords)
        assert (answer.cost, answer.saving) == (miss.cost, miss.saving)
        assert answer.opportunity


@given(WINDOWED)
def test_every_start_of_the_window_is_judged(call: Call) -> None:
    found = explained(call)
    if found is None or found.answer.human_plan is None:
        return
    starts, times = [moment.start for moment in found.moments], found.answer.human_plan_times
    epochs = len(found.answer.human_plan) if times is None else times.epochs
    assert starts == list(range(1, epochs + 1)) or found.answer.horizon == 0
    chosen = [moment for moment in found.moments if moment.why == "chosen"]
    assert [moment.window for moment in chosen] == ([found.answer.window] if found.answer.window else [])
    for text in dict(found.sentences).values():
        assert text.endswith(".")


def of_example(name: str, **options: object) -> Explanation:
    return serendipity.explain(serendipity.example(name), **options)


def reasons(found: Explanation) -> dict[int, str]:
    return {moment.start: moment.why for moment in found.moments}


def test_room2_is_helped_in_hall4() -> None:
    found = of_example("room2", discount="0.6")
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
    found = of_example("room2", discount="0.5")
    assert not found.answer.opportunity
    assert set(reasons(found).values()) == {"costs-more", "prefix"}
    assert found.misses == ()
    assert any("above a discount of 0.5" in text for _, text in found.sentences)


def test_room7_needs_a_word() -> None:
    found = of_example("room7", discount="0.6")
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
    found = of_example("room5", discount="0.9")
    assert (found.parts.human, found.parts.robots) == (11, 5)
    assert (found.discount.value, found.discount.included) == (Fraction(3, 5), False)
    assert found.announcement.cost == 11.4
    assert any("would gain 0.1" in text for _, text in found.sentences)
    assert any("commx is not told" in text for _, text in found.sentences)


def test_room5_at_0_6_only_breaks_even() -> None:
    found = of_example("room5", discount="0.6")
    assert not found.answer.opportunity
    assert {miss.rule for miss in found.misses} == {"window-length", "prefix"}
    assert found.misses[0].cost == 12.6


def test_an_answer_is_explained_under_its_own_options() -> None:
    task = serendipity.example("room2")
    answer = serendipity.plan(task, discount="0.9")
    found = serendipity.explain(task, serendipity.Result.from_dict(answer.to_dict()))
    assert found.answer.cost == answer.cost == 11.4
    assert found.discount == of_example("room2", discount="0.9").discount
    with pytest.raises(UsageError, match="both"):
        serendipity.explain(task, answer, discount="0.9")


@pytest.mark.parametrize("options", [{"mode": "individual"}, {"mode": "assistance"}])
def test_what_has_no_explanation(options: dict[str, str]) -> None:
    with pytest.raises(UsageError, match="explain"):
        of_example("room2", **options)


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
