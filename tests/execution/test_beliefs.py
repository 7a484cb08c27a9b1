"""Beliefs in a hurry."""

from typing import Any

import pytest

from serendipity.execution.beliefs import Beliefs
from serendipity.model import Deadline, LimitReachedError
from serendipity.model.task.actions import apply
from serendipity.recognition.recognise import candidate_goals
from serendipity.testing.builders import task as build


def test_without_time_for_exact_costs_bounds_tell_goals_apart(monkeypatch: pytest.MonkeyPatch) -> None:
    ways = {
        "go h a b": "a -> b !a",
        "go h b c": "b -> c !b",
        "go h a d": "a -> d !a",
        "go h d a": "d -> a !d",
    }
    home = build(init="a", goal="c", actions={**ways, "go h b a": "b -> a !b"})
    beliefs = Beliefs(home, candidate_goals(home, [{"goal": ["c"]}, {"goal": ["d"]}]), 1)

    def too_late(*_: Any, **__: Any) -> None:
        raise LimitReachedError("time")

    monkeypatch.setattr(beliefs.explainer, "explain", too_late)
    (action,) = home.named["go h a b"]
    beliefs.saw(action, [action])
    beliefs.update(apply(home.init, home.actions[action]), Deadline())
    c, d = beliefs.weights
    assert float(c) == pytest.approx(0.5 / (0.5 + 1 / (1 + 2.718281828459045**2)))
    assert c + d == 1
