"""Explanations of what rules of help allow (semantics 12 to 14) say nothing that holds only without them."""

from fractions import Fraction

import serendipity
from serendipity import Explanation, Script
from serendipity.testing.builders import task


def explained(**options: object) -> Explanation:
    morning = serendipity.example("morning")
    return serendipity.explain(morning, serendipity.plan(morning, **options))


def missed(found: Explanation) -> dict[str, float]:
    return {miss.rule: miss.cost for miss in found.misses}


def test_help_that_is_not_noticed() -> None:
    found = explained(noticed=True, discount=0.9)
    assert not found.answer.opportunity
    assert (found.moments, found.window_weight) == ((), None)
    assert missed(found) == {"prefix": 29.4, "noticed": 29.4}


def test_nothing_may_be_left() -> None:
    found = explained(leave_free="", discount=0.5)
    assert (found.answer.cost, found.moments) == (36, ())  # 35, in other windows too, leaves robi elsewhere
    assert missed(explained(leave_free="", discount=0.2)) == {"leave_free": 39.2}


def test_what_is_left_has_its_price_at_every_discount() -> None:
    found = explained(leave_price="coffee=0.5, table-laid=1, *=0.5", discount=0.5)
    assert (found.parts.human, found.parts.robots, found.parts.left) == (28, 14, 1)
    assert found.to_dict()["left_part"] == 1
    assert any("what is left changed costs 1; together 36" in text for _, text in found.sentences)
    assert (found.discount.value, found.discount.included) == (Fraction(3, 14), False)
    assert [c.opportunity for c in found.discount.confirmed] == [False, False, True]


def test_somebody_else_would_pay() -> None:
    actions = {"fetch h": "-> done @ 5", "bring r": "cup -> done !cup", "drink c": "cup -> drunk"}
    built = task(init="cup", goal="done", actions=actions, agents="h r c")
    beside = built.with_script(Script(people={"c": [(3, "drink c")]}))
    found = serendipity.explain(beside, discount=0.5)
    assert not found.answer.opportunity
    assert missed(found)["nobody_pays"] == 0.5
