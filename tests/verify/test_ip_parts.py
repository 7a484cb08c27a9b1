"""The parts of the integer programs, each against its definition."""

from fractions import Fraction

import pytest
from hypothesis import given

from serendipity.model import Deadline, Options, Task
from serendipity_testing.builders import task as build
from serendipity_testing.cases import case_4
from serendipity_testing.oracle import best, human_plans
from serendipity_testing.strategies import tasks
from verify.base.optimal_plans import OptimalPlans
from verify.base.relevance import Relevant, relevant_part
from verify.base.subproblem import FREE, WINDOW, Subproblem, prices
from verify.calls.solve import solve
from verify.exhaustive.team_problem import circles
from verify.limits import limited
from verify.programs.agents.product import automata
from verify.programs.automata.encoding import AutomataEncoding
from verify.programs.paper import PaperEncoding
from verify.solvers.mip import optimise


def _question(task: Task, horizon: int = 4, **options: object) -> Subproblem:
    chosen = Options(mode="composite", **options)  # type: ignore[arg-type]
    return Subproblem(task, chosen, FREE, (), horizon, prices(task, chosen, ()))


def _part(task: Task) -> Relevant | None:
    return relevant_part(_question(task))


# -- automata


def test_an_automaton_that_would_be_too_large_leaves_facts_out() -> None:
    task = case_4()
    part = _part(task)
    assert part is not None
    groups = [frozenset(variable.facts) for variable in task.variables]
    whole = automata(task, part, groups, Deadline())[task.human]
    with limited(automaton_states=10, states_a_value=0):
        small = automata(task, part, groups, Deadline())[task.human]
    assert len(small.states) <= 10 < len(whole.states)
    assert small.facts < whole.facts


# -- the human alone


@given(tasks())
def test_optimal_plans_in_order(task: Task) -> None:
    expected = [plan for plan, _ in zip(human_plans(task), range(20), strict=False)]
    found = [plan for plan, _ in zip(OptimalPlans(task).plans(), range(20), strict=False)]
    assert found == expected
    assert OptimalPlans(task).canonical() == (expected[0] if expected else None)


# -- suffixes that are replanned

DETOUR = {
    "do h": "-> p @ 5",
    "quick h": "q -> p @ 3",
    "slow1 h": "q -> s1 @ 0.5",
    "slow2 h": "s1 -> s2 @ 0.5",
    "slow3 h": "s2 -> p @ 0.5",
    "help r": "-> q @ 0.5",
}


@pytest.mark.parametrize("encoding", ["automata", "paper"])
@pytest.mark.parametrize(
    ("horizon", "cost", "opportunity"),
    [(2, 5.0, False), (3, 5.0, False), (4, 2.0, True)],
    ids=["T=2", "T=3", "T=4"],
)
def test_his_optimal_plan_has_to_fit(encoding: str, horizon: int, cost: float, opportunity: bool) -> None:
    """The human would do the three slow steps: with fewer epochs left, the quick one is no answer."""
    task = build(goal="p", actions=DETOUR)
    answer = solve(task, Options(horizon=horizon, max_window=1), encoding=encoding)
    assert (answer.cost, answer.opportunity) == (cost, opportunity)
    assert best(task, Options(horizon=horizon, max_window=1)).cost == cost


@pytest.mark.parametrize("encoding", ["automata", "paper"])
@pytest.mark.parametrize("weight", ["0", "0.25", "0.5", "2"])
def test_a_suffix_that_saves_talk_is_no_optimal_plan(encoding: str, weight: str) -> None:
    """Once helped the human does ``short``, though the two steps of ``pi_H`` need no talk."""
    actions = {
        "zero h": "-> z @ 3",
        "one h": "z -> m @ 2",
        "two h": "m -> p @ 1.5",
        "short h": "z k -> p @ 3",
        "help h r": "-> z k @ 0.5",
    }
    task = build(goal="p", actions=actions)
    options = Options(
        mode="communication", keep_prefix=True, communication_weight=Fraction(weight), max_window=1
    )
    answer, expected = solve(task, options, encoding=encoding), best(task, options)
    assert (answer.cost, answer.opportunity) == (float(expected.cost or 0), expected.opportunity)
    assert answer.objective == float(expected.objective or 0)


@pytest.mark.parametrize("encode", [AutomataEncoding, PaperEncoding])
def test_a_bound_on_a_suffix_cuts_that_suffix_only(encode: type[AutomataEncoding | PaperEncoding]) -> None:
    task = build(goal="p", actions=DETOUR)
    options = Options(horizon=2, max_window=1)
    plan = OptimalPlans(task).canonical() or ()
    question = Subproblem(task, options, WINDOW, plan, 2, prices(task, options, plan))

    def least(bounds: list[tuple[int, frozenset[int], int | None]]) -> float | None:
        encoding = encode(question)
        for bound in bounds:
            encoding.bound_suffix(*bound)
        assert encoding.model is not None
        outcome = optimise(encoding.model)
        if outcome.values is None:
            return None
        objective, _ = question.measure(*encoding.plan(outcome.values))
        return float(question.prices.cost(objective)) - 1000

    unit = question.prices.scale
    helped = frozenset((task.facts.index("q"),))
    assert least([]) == 3.5  # help and quick
    assert least([(2, helped, None)]) == 5.0
    assert least([(2, helped, 3 * unit)]) == 3.5
    assert least([(2, helped, 4 * unit)]) == 5.0  # no suffix from there weighs as much
    assert least([(2, frozenset(), None)]) == 3.5


# -- shared epochs


def test_actions_that_disable_each_other_need_one_epoch() -> None:
    """Each takes what the other needs: in one epoch both can, one after the other neither."""
    task = build(init="a b", goal="x y", actions={"left h": "a b -> x !a", "right r": "a b -> y !b"})
    numbered = list(enumerate(task.actions))
    assert circles(numbered, task, Deadline()) == [(0, 1)]
    answer = solve(task, Options(mode="composite"))
    assert (answer.status, answer.cost, answer.horizon) == ("optimal", 2.0, "inf")
    assert {step.epoch for step in answer.plan or ()} == {1}
    strict = solve(task, Options(mode="composite", interference="strict"))
    assert strict.status == "infeasible"


def test_circles_of_three() -> None:
    task = build(
        agents="h r q",
        init="a b c",
        goal="x",
        actions={"one h": "a -> x !b", "two r": "b -> y !c", "three q": "c -> z !a"},
    )
    assert circles(list(enumerate(task.actions)), task, Deadline()) == [(0, 1, 2)]
