"""Where goals speak of what robots change, too: the kernel's bounds, and where it has none."""

from collections.abc import Callable, Iterator
from dataclasses import replace
from typing import Any

import pytest
from hypothesis import given, settings

import search.classical.planner
import search.classical.team
import serendipity
from search.classical.planner import ClassicalPlanner
from search.classical.team import Sets, Team
from search.kernel.library import library
from serendipity.model import Deadline, LimitReachedError, Options, Task, UsageError
from serendipity.model.options import INFINITE
from serendipity_testing.builders import task as build
from serendipity_testing.oracle import best
from serendipity_testing.strategies import Call, calls, family_tasks
from tests.search.exact_answers import assert_answered, proved


@pytest.mark.parametrize("mode", ["individual", "serendipity", "communication", "composite"])
def test_goals_that_exclude_each_other(mode: str) -> None:
    """The kernel was given a goal that asks for two values of one variable, which it can't write down."""
    task = build(
        init="on_c_a",
        goal="clear_a",
        robot_goal="on_b_a",
        actions={"put r": "clear_a -> on_b_a !clear_a @ 2.5", "lift h": "on_c_a -> clear_a !on_c_a @ 3"},
    )
    answer = serendipity.plan(task, mode=mode)
    assert answer.status == best(task, Options(mode=mode)).status  # type: ignore[arg-type]


def test_what_the_human_gains_alone() -> None:
    """No way of theirs was found while robots are idle, so that what they gain alone was taken for help."""
    task = build(
        init="at_b_p2",
        goal="at_b_p1",
        actions={
            "drive h": "-> at_h_p1 @ 0.1",
            "back h": "-> !at_h_p1 @ 0.1",
            "load h": "at_b_p2 -> in_b_h !at_b_p2 @ 3",
            "unload h": "in_b_h -> at_b_p1 !in_b_h @ 0.1",
            "unload r": "-> at_b_p1 @ 3",
        },
    )
    answer = proved(task, human_plan=["drive h", "back h", "drive h", "load h", "unload h"])
    assert (answer.cost, answer.saving_alone, answer.saving) == (3.0, 0.3, 0.4)


@pytest.mark.parametrize("earlier", [{"window_weight": "0.75"}, {"communication_weight": "0.25"}])
def test_an_earlier_call_in_a_smaller_unit(earlier: dict[str, str]) -> None:
    """The team of an earlier call was taken, whose costs stood for others."""
    task = build(
        goal="a b", actions={"go h": "-> p", "back h": "p -> a !p", "end h": "p -> b", "end r": "-> b @ 3"}
    )
    call = {"mode": "communication", "discount": "1/3"}
    given = ["go h", "back h", "go h", "end h", "back h"]
    expected = serendipity.plan(replace(task), human_plan=given, **call)  # type: ignore[arg-type]
    serendipity.plan(task, **call, **earlier)  # type: ignore[arg-type]
    answer = serendipity.plan(task, human_plan=given, **call)  # type: ignore[arg-type]
    assert (answer.cost, answer.saving, answer.saving_alone) == (
        expected.cost,
        expected.saving,
        expected.saving_alone,
    )


def test_where_the_kernel_has_no_bound_on_the_team(monkeypatch: pytest.MonkeyPatch) -> None:
    """Then there was no bound at all on the human's way to the goal but that there is none."""
    monkeypatch.setattr(search.classical.team, "team_planner", lambda *_, **__: None)

    @given(calls(modes=("serendipity", "communication", "composite"), ties=False, of=family_tasks()))
    def law(call: Call) -> None:
        assert_answered(call)

    law()


def test_a_fact_that_two_must_add_at_once() -> None:
    """Both need it to be false and make it true, which is no conflict: a circle that was missed."""
    task = build(goal="a b", actions={"left h": "!c -> a c @ 1", "right r": "!c -> b c @ 1"})
    answer = serendipity.plan(task, mode="composite", horizon="inf")
    assert (answer.status, answer.cost) == ("optimal", 2)


@given(calls(modes=("serendipity", "communication"), ties=False, of=family_tasks()))
def test_with_answers_on_the_way(call: Call) -> None:
    """Where time is limited, composite plans and short windows give answers first; the last is the same."""
    try:
        optimum = best(call.task, call.options, call.human_plan)
    except UsageError:
        return
    asked = call.keywords(time_limit=60)
    *early, answer = serendipity.plan_anytime(call.task, human_plan=call.human_plan_names, **asked)
    expected = None if optimum.cost is None else float(optimum.cost)
    assert (answer.status, answer.cost) == (optimum.status, expected)
    for some in early:
        assert serendipity.check(call.task, some).refuted is None


def test_where_the_joint_optimum_is_interrupted_and_goes_on(monkeypatch: pytest.MonkeyPatch) -> None:
    """As soon as it is looked for; other ways to an answer are tried before it goes on."""
    if library() is None:
        pytest.skip("there is no kernel here")
    whole, went_on = ClassicalPlanner.cheapest_plan, []

    def hasty(self: ClassicalPlanner, state: int, deadline: Deadline, *rest: object) -> list[int] | None:
        return whole(self, state, deadline.within(0), *rest)  # type: ignore[arg-type]

    def going_on(self: Team, *given: Any) -> Iterator[Sets]:
        went_on.append(self.planner.is_open)
        return whole_rest(self, *given)

    whole_rest = Team.go_on
    monkeypatch.setattr(search.classical.planner, "SLICE", 1e-6)
    monkeypatch.setattr(ClassicalPlanner, "cheapest_plan", hasty)
    monkeypatch.setattr(Team, "go_on", going_on)

    @settings(max_examples=50)  # not each has anything to go on with
    @given(calls(modes=("serendipity", "communication", "composite"), ties=False, of=family_tasks()))
    def law(call: Call) -> None:
        if call.options.horizon == INFINITE:
            return  # then there is nothing else to try, and the call ends where it is interrupted
        assert_answered(replace(call, options=call.options.but(time_limit=60.0, window_weight=0)))

    law()
    assert any(went_on), "else this test says nothing"


@pytest.mark.skipif(library() is None, reason="there is no kernel here")
@pytest.mark.parametrize(("bridge", "status", "most"), [("de", "optimal", 12), ("", "infeasible", 0)])
def test_what_only_others_bring(bridge: str, status: str, most: int) -> None:
    """The human's own distances say nothing of what has to come first; there are 36 states before."""
    actions = {"open h": "box_f lid_f -> done"}
    for thing in ("box", "lid"):
        for here, there in filter(None, ("ab", "bc", "cd", bridge, "ef")):
            actions[f"push_{thing}_{here} r"] = f"{thing}_{here} -> {thing}_{there} !{thing}_{here}"
            actions[f"pull_{thing}_{here} s"] = f"{thing}_{there} -> {thing}_{here} !{thing}_{there}"
    task = build(agents="h r s", init="box_a lid_a", goal="done", actions=actions)
    answer = serendipity.plan(task, mode="composite", horizon=INFINITE)
    assert answer.status == status
    assert answer.statistics["expanded"] <= most


def _street(cabs: int, length: int = 8) -> Task:
    """Somebody walks along a street, or is taken by cabs that come from its end and have to keep apart."""
    actions = {}
    places = range(length)
    for a, b in [(i, j) for i in places for j in places if abs(i - j) == 1]:
        actions[f"walk {a} {b} h"] = f"at_{a} -> at_{b} !at_{a}"
        for cab in "rs"[:cabs]:
            actions[f"drive {a} {b} {cab}"] = f"{cab}_{a} free_{b} -> {cab}_{b} !{cab}_{a} free_{a} !free_{b}"
    for i in places:
        for cab in "rs"[:cabs]:
            actions[f"enter {cab}_ {i} h"] = f"at_{i} {cab}_{i} -> in_{cab} !at_{i}"
            actions[f"leave {cab}_ {i} h"] = f"in_{cab} {cab}_{i} -> at_{i} !in_{cab}"
    last, free = length - 1, " ".join(f"free_{i}" for i in places[:-2])
    init = f"at_0 r_{last - 1} {free} " + (f"s_{last}" if cabs == 2 else f"free_{last}")
    return build(agents="h r s"[: 1 + 2 * cabs], init=init, goal=f"at_{last}", actions=actions)


@pytest.mark.skipif(library() is None, reason="there is no kernel here")
@pytest.mark.parametrize(("cabs", "cost"), [(1, 3.3), (2, 4.2)])
def test_where_robots_have_more_to_do_than_come(cabs: int, cost: float) -> None:
    """The bound tells what it takes until a cab has come, not what it takes until it is there.

    A second cab stands at the end, so that the human has to walk there from the place before.
    """
    task = _street(cabs)
    answers = list(serendipity.plan_anytime(task, mode="composite", horizon=INFINITE, discount="0.9"))
    last, bounds = answers[-1], [answer.lower_bound for answer in answers]
    assert (last.status, last.cost, last.saving) == ("optimal", cost, 7 - cost)
    assert last.statistics["expanded"] < 100
    assert bounds == sorted(bounds)
    assert all(answer.cost <= 7 for answer in answers), "they could walk"
    assert serendipity.verify(task, last).verdict == "proved"


def _interrupted(plans: list[list[tuple[int, ...]]]) -> Callable[..., Iterator[list[tuple[int, ...]]]]:
    """A team that comes by some plans until a limit comes."""

    def better_plans(*_: object) -> Iterator[list[tuple[int, ...]]]:
        yield from plans
        raise LimitReachedError("time-limit")

    return better_plans


@pytest.mark.skipif(library() is None, reason="there is no kernel here")
@pytest.mark.parametrize("detour", [0, 1])
def test_what_was_known_before_the_kernel_went_on_is_kept(
    detour: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    task = _street(2, 16)
    numbers = {action.name: number for number, action in enumerate(task.actions)}
    steps = ["walk 0 1 h", "walk 1 0 h"] * detour + [f"walk {i} {i + 1} h" for i in range(15)]
    dearer = [[(numbers[name],) for name in steps]] * detour
    monkeypatch.setattr(search.classical.team.Team, "better_plans", _interrupted(dearer))
    *_, answer = serendipity.plan_anytime(task, mode="composite", horizon=INFINITE, discount="0.9")
    assert (answer.status, answer.cost, answer.human_cost) == ("feasible", 15, 15)
    assert 2 < answer.lower_bound < 4.2
