"""Bounds on moves drop those out of reach of windows, of robots or of what may be paid."""

from fractions import Fraction

import pytest

from serendipity.model import Options, Task
from serendipity_testing.builders import task
from verify.base.relevance import relevant_part
from verify.base.subproblem import WINDOW, Subproblem, prices
from verify.limits import limited
from verify.programs.agents.product import Automaton, automata, private_facts
from verify.programs.automata import encoding
from verify.programs.automata.windows import keep_within_windows, longest_window
from verify.programs.promising import TeamMoves, keep_promising

# -- windows


_WAY = {
    "go-1 h": "p0 -> p1 !p0",
    "go-2 h": "p1 -> p2 !p1",
    "go-3 h": "p2 -> p3 !p2",
    "stray-1 h": "p0 -> q1 !p0",
    "stray-2 h": "q1 -> q2 !q1",
    "back h": "q2 -> p3 !q2",
    **{f"meet-{place} h r": f"{place} -> ready" for place in ("p0", "p1", "p2", "p3", "q1", "q2")},
    "done h": "ready -> goal",
    "slow h": "p3 -> goal @ 9",
}


def _meeting_places(way: Task, longest: int | None, **options: object) -> set[str]:
    """Where the human's automaton lets them meet the robot, with windows of that length."""
    names = ("go-1 h", "go-2 h", "go-3 h", "slow h")
    plan = way.plan_from_names(names)
    asked = Options(max_window=longest, **options)  # type: ignore[arg-type]
    question = Subproblem(way, asked, WINDOW, plan, len(plan), prices(way, asked, plan))
    part = relevant_part(question)
    assert part is not None
    groups = [frozenset(variable.facts) for variable in way.variables]
    owner = private_facts(way, part, question.deadline)
    machine: Automaton = automata(way, part, groups, question.deadline, owner)[0]
    keep_within_windows(question, machine)
    return {
        way.actions[i].name.split()[0].removeprefix("meet-")
        for each in machine.moves
        for i, _ in each
        if len(way.actions[i].participants) > 1
    }


def test_one_meets_no_further_from_the_plan_than_a_window_is_long() -> None:
    way = task(init="p0", goal="goal", actions=_WAY)
    plan = {"p0", "p1", "p2", "p3"}
    assert _meeting_places(way, 1) == plan
    assert _meeting_places(way, 2) == plan | {"q1"}
    assert _meeting_places(way, 3) == _meeting_places(way, None) == plan | {"q1", "q2"}


def test_a_prefix_in_any_order_leads_anywhere() -> None:
    way = task(init="p0", goal="goal", actions=_WAY)
    everywhere = _meeting_places(way, None)
    assert _meeting_places(way, 1, mode="communication", keep_prefix=True) == everywhere


def test_a_price_of_epochs_limits_windows() -> None:
    way = task(init="p0", goal="goal", actions=_WAY)
    plan = way.plan_from_names(("go-1 h", "go-2 h", "go-3 h", "slow h"))
    options = Options(window_weight=Fraction(10))
    question = Subproblem(way, options, WINDOW, plan, len(plan), prices(way, options, plan))
    found = {most: longest_window(question.but(most=most)) for most in (9, 19, 29, None)}
    assert found == {9: 0, 19: 1, 29: 2, None: 4}


# -- what is dropped at once


def _is_promising(way: Task, names: tuple[str, ...], most: int, longest: int) -> bool:
    """Whether bounds leave anything of plans within a limit, with windows of that length."""
    plan = way.plan_from_names(names)
    options = Options(max_window=longest, window_weight=Fraction(0), discount=Fraction(9, 10))
    question = Subproblem(way, options, WINDOW, plan, len(plan), prices(way, options, plan), most=most)
    said = []

    def listen(team: TeamMoves) -> bool:
        with limited(many_moves=0):
            said.append(keep_promising(team))
        return said[-1]

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(encoding, "keep_promising", listen)
        encoding.AutomataEncoding(question)
    return said[-1]


_LATE = {
    **{f"go-{k} h": f"p{k} -> p{k + 1} !p{k}" for k in range(4)},
    "slow h": "p4 -> goal @ 9",
    **{f"come-{k} r": f"r{k} -> r{k + 1} !r{k}" for k in range(3)},
}


def test_robots_are_there_while_a_window_is_open() -> None:
    names = ("go-0 h", "go-1 h", "go-2 h", "go-3 h", "slow h")
    early = task(init="p0 r0", goal="goal", actions={**_LATE, "meet h r": "p1 r3 -> goal"})
    assert not _is_promising(early, names, 120, 1)
    assert not _is_promising(early, names, 120, 2)
    assert _is_promising(early, names, 120, 3), "they wait for the robot"
    late = task(init="p0 r0", goal="goal", actions={**_LATE, "meet h r": "p3 r3 -> goal"})
    assert _is_promising(late, names, 120, 1)


def test_until_robots_have_provided_for_it_the_human_goes_on_as_planned() -> None:
    """What a robot leaves behind at the start is there when the human is not."""
    names = ("go-0 h", "go-1 h", "go-2 h", "go-3 h", "slow h")
    back = {f"back-{k} h": f"p{k + 1} -> p{k} !p{k + 1}" for k in range(4)}
    actions = {**_LATE, **back, "put r": "r2 -> kit !r2", "short h": "p0 kit -> goal @ 8"}
    way = task(init="p0 r0", goal="goal", actions=actions)
    assert not _is_promising(way, names, 105, 1), "two moves there, two back, and 8"
    assert _is_promising(way, names, 129, 1)


def test_the_human_does_not_take_what_they_would_have_to_have_put_there() -> None:
    actions = {
        "go h": "p -> q !p @ 5",
        "back h": "q -> p !q @ 5",
        "take-p h": "p kit-p -> has !kit-p",
        "take-q h": "q kit-q -> has !kit-q",
        "put-p h": "p has -> kit-p !has",
        "done h": "p has -> goal",
        "bring r": "kit-q -> kit-p !kit-q @ 200",
    }
    way = task(init="p kit-q", goal="goal", actions=actions)
    assert not _is_promising(way, ("go h", "take-q h", "back h", "done h"), 11, 1)
