"""Each law finds a planner that breaks it within some hundreds of calls: bugs that are planted (again)."""

from collections.abc import Callable
from copy import copy
from typing import Any

import pytest

from search.engine import best_first
from search.packed.cost_vector import Weights
from search.packed.packed_task import PackedTask
from search.spaces.windowed import Windowed
from search.strategies import outcome
from serendipity.model.task.actions import conflicting
from serendipity_testing.crosscheck import JUDGES, compare
from serendipity_testing.generator.calls import random_call
from serendipity_testing.own_laws import LAWS

Patch = pytest.MonkeyPatch


def half_an_answer(patch: Patch) -> None:
    """The incumbent is there before what the human does at its end is."""

    def end(self: Any, judged: Any, option: Any, best: Any) -> None:
        node = self._child(judged, option)
        left, limit = self.horizon - node.epoch, best.key - node.key
        rest = self.suffix.key(node.state, left, node.start, limit)
        if rest < limit and not self.keys.exceeds(node.key + rest, self.most_cost):
            best.key, best.node, best.end = node.key + rest, node, node.epoch + 1
            best.tail = self.suffix.actions(node.state, left, node.start)

    patch.setattr(Windowed, "_end", end)


def an_infinite_figure(patch: Patch) -> None:
    """An infinite bound is reported, instead of what it proves."""
    original = outcome._status

    def status(call: Any, answer: Any) -> str:
        found = original(call, answer)
        return found if call.limit is None else found.replace("infeasible", "unknown")

    patch.setattr(outcome, "_status", status)


def feasible_without_a_plan(patch: Patch) -> None:
    """Where a bound has risen, there is said to be a plan."""
    patch.setattr(best_first, "_PATIENCE", 0)  # every rise is reported
    original = outcome._status
    patch.setattr(outcome, "_status", lambda *given: original(*given).replace("unknown", "feasible"))


def interference_of_an_earlier_call(patch: Patch) -> None:
    """What is kept with the task leaves an option out."""

    def compatible(self: Any, first: int, second: int, strict: bool) -> bool:
        actions, key = self.task.actions, (first, second)
        kept = vars(self).setdefault("_compatible", {})
        if key not in kept:
            kept[key] = not conflicting(actions[first], actions[second], strict=strict)
        return bool(kept[key])

    patch.setattr(PackedTask, "compatible", compatible)


def an_earlier_state(patch: Patch) -> None:
    """Sessions go on planning from where they began."""

    def at(self: Any, task: Any) -> Any:
        moved = copy(self)
        moved.task = task
        return moved

    patch.setattr(PackedTask, "at", at)


def variants_are_actions(patch: Patch) -> None:
    """A human who planned one variant of an action and does another would have to be told."""
    original = Weights.__init__

    def init(self: Any, packed: Any, scales: Any, options: Any, plan: Any) -> None:
        original(self, packed, scales, options, plan)
        self.ids = frozenset(plan or ())

    def alone(self: Any, op: Any) -> int:
        is_told = self.announces and op.action not in self.ids
        return int(self.human[op.cost] + (self._announced[op.cost] if is_told else 0))

    patch.setattr(Weights, "__init__", init)
    patch.setattr(Weights, "alone", alone)


FOUND: dict[Callable[[Patch], None], tuple[str, int]] = {
    half_an_answer: ("limits", 396),
    an_infinite_figure: ("limits", 80),
    feasible_without_a_plan: ("on the way", 14),
    interference_of_an_earlier_call: ("again", 84),
    an_earlier_state: ("session", 0),
    variants_are_actions: ("variants", 424),
}
"""Which law finds them, and the first call in which it does."""


@pytest.mark.parametrize("bug", FOUND, ids=lambda bug: bug.__name__)
def test_bugs_are_found(bug: Callable[[Patch], None], monkeypatch: Patch) -> None:
    law, seed = FOUND[bug]
    judges, laws = {"search": JUDGES["search"]}, {law: LAWS[law]}
    assert compare(random_call(seed), judges, laws) is None
    bug(monkeypatch)
    found = compare(random_call(seed), judges, laws)
    assert found is not None, (
        f"random calls are drawn otherwise now: in FOUND, give {bug.__name__} the first seed from 0 on"
        f" for which {law!r} finds nothing without the bug, and something with it"
    )
    assert found.law == law


def test_ties_of_one_objective_are_no_disagreement() -> None:
    """A session's window began an epoch earlier than a fresh call's, where goals are shared."""
    laws = {"session": LAWS["session"]}
    assert compare(random_call(5002), {"search": JUDGES["search"]}, laws) is None
