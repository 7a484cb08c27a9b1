"""The verifier as a planner, in time: what it answers by itself is what the search answers."""

import pytest
from hypothesis import given

import serendipity
from serendipity.model import Options, Script, Task, UsageError
from serendipity_testing.builders import task as build
from serendipity_testing.call import Call
from serendipity_testing.strategies import calls_in_time
from verify.calls.solve import solve

FIGURES = (
    *("status", "reason", "cost", "objective", "lower_bound", "opportunity", "saving", "saving_alone"),
    *("horizon", "human_cost", "human_plan", "human_plan_times", "bystanders"),
)


@pytest.mark.long
@given(calls_in_time())
def test_it_answers_what_the_search_does(call: Call) -> None:
    keywords = {**call.keywords(), "nobody_pays": False}
    given_plan = keywords.pop("human_plan", None)
    try:
        expected = serendipity.plan(call.task, human_plan=given_plan, **keywords)
    except UsageError:  # what it reaches does not last
        with pytest.raises(UsageError):
            solve(call.task, call.options.but(nobody_pays=False), human_plan=given_plan)
        return
    found = solve(call.task, call.options.but(nobody_pays=False), human_plan=given_plan)
    assert [getattr(found, name) for name in FIGURES] == [getattr(expected, name) for name in FIGURES]
    if found.plan is not None:
        assert serendipity.check(call.task, found).verdict != "refuted"


def slow() -> Task:
    return build(goal="done", actions={"do h": " -> done @ 1 [2]", "help r": " -> done"})


@pytest.mark.parametrize(
    ("options", "said"),
    [
        ({"ties": "robust"}, "ties: solved in time for 'fixed' only"),
        ({"nobody_pays": True}, "no rules of help"),
        ({"leave_free": "done"}, "no rules of help"),
    ],
)
def test_what_it_does_not_know_is_refused(options: dict[str, object], said: str) -> None:
    with pytest.raises(UsageError, match=said):
        solve(slow(), Options(**options))  # type: ignore[arg-type]
    with pytest.raises(UsageError, match="equations know no time"):
        solve(slow(), Options(), encoding="paper")


def test_who_is_in_the_middle_of_something_goes_on() -> None:
    session = serendipity.Session(slow())
    session.execute(["do h"])
    assert (solve(session.task, Options()).cost, session.plan().cost) == (0, 0)


def test_beside_bystanders_the_rule_has_to_be_left_out() -> None:
    made = build(agents="h r c", goal="done", actions={"do h": " -> done", "look c": " -> seen"})
    beside = made.with_script(Script(people={"c": [(2, "look c")]}))
    with pytest.raises(UsageError, match="--somebody-pays"):
        solve(beside, Options())
    assert solve(beside, Options(nobody_pays=False)).bystanders["c"][0].epoch == 2


def test_nothing_is_begun_after_a_head_start_where_the_goal_comes_by_itself() -> None:
    """Who begins something pays for what they waited before, and need not; an answer of cost 1 was proved."""
    made = build(goal="f", actions={"do h": " -> f @ 0", "look r": " -> seen"})
    made = made.with_script(Script(facts=[(5, "f")]))
    for mode in ("serendipity", "individual"):
        answer = serendipity.plan(made, mode=mode, waiting_cost="0.5", head_start=2)
        assert (answer.human_cost, answer.cost, answer.opportunity) == (0, 0, False)
        assert serendipity.verify(made, answer).verdict == "proved"
        assert solve(made, answer.options).cost == 0


@pytest.mark.parametrize("horizon", [None, "inf"])
def test_a_goal_that_is_undone_later_holds_at_first(horizon: str | None) -> None:
    """Without a horizon a plan of no epochs is one: the verifier looked at the states after an epoch only."""
    made = build(init="f", goal="f", actions={"look r": " -> seen"}).with_script(Script(facts=[(1, "!f")]))
    answer = serendipity.plan(made, mode="composite", head_start=2, horizon=horizon)
    assert (answer.status, answer.cost, solve(made, answer.options).cost) == ("optimal", 0, 0)
    assert serendipity.verify(made, answer).verdict == "proved"


def test_idle_robots_need_not_wait_for_a_head_start_without_a_horizon() -> None:
    """The verifier took the plan predicted after it for the best without robots, and saw an opportunity."""
    made = build(goal="f", actions={"do h": " -> f @ 5", "look r": " -> seen"})
    late = [(4, "do h")]
    answer = serendipity.plan(
        made, mode="composite", head_start=2, horizon="inf", waiting_cost=1, human_plan=late
    )
    assert (answer.human_cost, answer.cost, answer.opportunity, answer.saving_alone) == (10, 5, False, 5)
    assert serendipity.verify(made, answer).verdict == "proved"
    found = solve(made, answer.options, human_plan=late)
    assert (found.opportunity, found.saving_alone) == (False, 5)
