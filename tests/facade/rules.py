"""Rules of help: what to ask for, tasks of three rooms, and answers held against brute force."""

from fractions import Fraction
from typing import Any

import pytest
from hypothesis import assume, reject
from hypothesis import strategies as st

import serendipity
from search.modes.scenarios import Candidate
from serendipity import Condition, GroundAction, Options, Result, Script, Task, Timing, UsageError
from serendipity_testing.generator.in_time import with_durations
from serendipity_testing.oracle import best
from serendipity_testing.oracle.scenarios import best_policy
from serendipity_testing.strategies.tasks import DICE
from tests.search.modes.scenarios.test_in_time import library

_FREE = st.sampled_from([None, None, "at *"])
_SILENT = {"suffix": st.just("replan"), "preservation": st.just("kernel")}
RULES: dict[str, st.SearchStrategy[dict[str, Any]]] = {
    "nobody pays": st.fixed_dictionaries(
        {
            "nobody_pays": st.sampled_from([None, True]),
            "leave_free": st.sampled_from([None, "nothing", "at *", "*0*"]),
            **_SILENT,
        }
    ),
    "noticed": st.fixed_dictionaries({"noticed": st.just(True), "leave_free": _FREE, **_SILENT}),
    "disturbance": st.fixed_dictionaries(
        {
            "max_disturbance": st.sampled_from([0, "0.5", 1, 2, 3]),
            "disturbance": st.sampled_from([None, "ask=2", "sight=1", "meet=1, ask=0.5"]),
            "leave_free": _FREE,
        }
    ),
    "leftovers": st.fixed_dictionaries(
        {
            "leave_price": st.sampled_from(["*=0.31", "at *=0.17, lit *=0.53, *=2.9", "*0*=0.07, *=1.13"]),
            "leave_free": st.sampled_from([None, "at r*"]),
        }
    ),
}
"""Options of each rule of help (semantics 12 to 14)."""

_UNSAID = "where several ask for a fact to be false"
"""What effects can't say of strict interference is refused."""


def _keywords(options: Options) -> dict[str, Any]:
    return {name: getattr(options, name) for name in options.__dataclass_fields__}


def proved_as_brute_force_has_it(task: Task, options: Options) -> Result:
    """The answer, which is proved; no example where effects can't say what is asked, or both refuse it."""
    try:
        expected = best(task, options)
    except UsageError:
        with pytest.raises(UsageError):
            serendipity.plan(task, **_keywords(options))
        reject()
    try:
        answer = serendipity.plan(task, **_keywords(options))
    except UsageError as error:
        assume(_UNSAID not in str(error))
        raise
    if expected.cost is None or expected.objective is None:
        assert answer.status == expected.status
        return answer
    found = (answer.status, answer.cost, answer.objective, answer.opportunity)
    assert found == (expected.status, float(expected.cost), float(expected.objective), expected.opportunity)
    assert serendipity.verify(task, answer).verdict == "proved"
    return answer


def policy_as_brute_force_has_it(
    task: Task, options: Options, candidates: list[Candidate], horizon: int
) -> Result | None:
    """The answer; None where the one without the rule comes first, beside plans that are not optimal."""
    expected = best_policy(task, options, candidates, horizon)
    try:
        answer = serendipity.plan(task, plans=library(task, candidates), **_keywords(options))
    except UsageError as error:
        assert _UNSAID in str(error)
        return None
    assert answer.status == "optimal"
    if answer.saving_alone and not answer.statistics.get("rule_binds"):
        return None
    assert (answer.objective, answer.cost) == pytest.approx((float(expected.objective), float(expected.cost)))
    assert answer.opportunity == expected.opportunity
    return answer


_PLACED = tuple(f"{what} p{i}" for what in ("at h", "at r", "lit") for i in range(3))
_FACTS = (*_PLACED, "done")
_IDS = {name: i for i, name in enumerate(_FACTS)}


def action(
    name: str, who: tuple[int, ...], pre: str, add: str, delete: str = "", cost: int = 1
) -> GroundAction:
    def ids(text: str) -> tuple[int, ...]:
        return tuple(sorted(_IDS[fact.strip()] for fact in text.split(",") if fact.strip()))

    return GroundAction(name, who, ids(pre), (), ids(add), ids(delete), Fraction(cost))


@st.composite
def rooms(draw: st.DrawFn, *, timed: bool = True) -> Task:
    """Three rooms in a row, in which both walk; work is quick where a robot has lit a lamp, or helps.

    Args:
        draw: chooses.
        timed: whether walks may take two epochs.
    """
    found, slow = [], timed and draw(st.booleans())
    for agent, name in enumerate("hr"):
        for p, q in ((0, 1), (1, 2), (1, 0), (2, 1)):
            walk = f"move {name} p{p} p{q}"
            found.append(action(walk, (agent,), f"at {name} p{p}", f"at {name} p{q}", f"at {name} p{p}"))
            if slow and draw(st.booleans()):
                left = Timing(2, start_delete=found[-1].delete)
                found[-1] = GroundAction(walk, (agent,), found[-1].pre, (), found[-1].add, (), timing=left)
    for p in range(3):
        where = f"at r p{p}" if draw(st.booleans()) else ""
        found.append(action(f"light r p{p}", (1,), where, f"lit p{p}", cost=draw(st.integers(0, 1))))
    goal, lamp, desk = (draw(st.integers(0, 2)) for _ in range(3))
    found.append(action(f"work h p{goal}", (0,), f"at h p{goal}", "done", cost=5))
    found.append(action(f"work-lit h p{goal}", (0,), f"at h p{goal}, lit p{lamp}", "done"))
    found.append(action(f"give h r p{desk}", (0, 1), f"at h p{desk}, at r p{desk}", "done"))
    start = frozenset({_IDS[f"at h p{draw(st.integers(0, 2))}"], _IDS[f"at r p{draw(st.integers(0, 2))}"]})
    actions = tuple(sorted(found, key=lambda each: each.key))
    return Task("rooms", ("h", "r"), 0, _FACTS, start, Condition((_IDS["done"],)), actions)


@st.composite
def rooms_in_time(draw: st.DrawFn) -> Task:
    """The same, where anything may take its time, and lamps go on and off by themselves."""
    task = with_durations(draw(DICE), draw(rooms()), (1, 1, 1, 2))
    lamps = st.sampled_from([f"{true}lit p{room}" for true in ("", "!") for room in range(3)])
    changes = draw(st.dictionaries(st.integers(1, 5), lamps, max_size=2))
    return task.with_script(Script(facts=changes.items()))
