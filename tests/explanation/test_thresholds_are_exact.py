"""Help exists on one side of a reported threshold, and not on the other."""

from fractions import Fraction

import pytest
from hypothesis import given
from hypothesis import strategies as st

import serendipity
from serendipity import Explanation, PlanError, UsageError
from serendipity.model import Options
from serendipity.testing.strategies import Call, calls, calls_in_time

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
