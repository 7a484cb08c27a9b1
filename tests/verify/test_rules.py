"""The rule checker accepts the worked cases and refutes doctored ones with the right rule."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from serendipity.model import Condition, Options, PlanStep, Result, Task, Window
from tests.builders import task as build
from tests.cases import case_2, case_4, case_7, case_9, case_10
from tests.oracle import Alone as OracleAlone
from tests.oracle.epochs import after
from tests.strategies import tasks
from tests.verify.results import moved, result, step, with_steps
from verify import check
from verify.rules import CLAIMS, RULES
from verify.rules.alone import Alone

CASE_4_PI_H = (
    "move h a b",
    "move h b c",
    "move h c r",
    "pick_up_medkit h k2 r",
    "move h r c",
    "move h c d",
    "move h d g",
    "conduct_triage h g",
)
CASE_2_PI_H = (
    "move h a b",
    "move h b c",
    "move h c s",
    "move h s u",
    "pick_up_medkit h k u",
    "move h u s",
    "move h s c",
    "move h c g",
    "conduct_triage h g",
)


@dataclass(frozen=True, slots=True)
class Given:
    """A task with a valid result."""

    task: Task
    result: Result


def helped(**options: Any) -> Given:
    """Case 4: handed over in c at epoch 3, cost 6.2."""
    task = case_4()
    plan = {
        1: "move h a b; pick_up_medkit rob k2 r",
        2: "move h b c; move rob r c",
        3: "hand_over rob h k2 c",
        4: "move h c d",
        5: "move h d g",
        6: "conduct_triage h g",
    }
    return Given(task, result(task, plan, human_plan=CASE_4_PI_H, window=(3, 4), discount="0.9", **options))


def fetched(**options: Any) -> Given:
    """Case 2 with K = 0: the human waits at c, window [3, 6), cost 7."""
    task = case_2()
    plan = {
        1: "move h a b; move rob s u",
        2: "move h b c; pick_up_medkit rob k u",
        3: "move rob u s",
        4: "move rob s c",
        5: "hand_over rob h k c",
        6: "move h c g",
        7: "conduct_triage h g",
    }
    fixed = {"discount": "0.5", "window_weight": "0", **options}
    return Given(task, result(task, plan, human_plan=CASE_2_PI_H, window=(3, 6), **fixed))


def idle() -> Given:
    """Case 4 at discount 0.5: no opportunity."""
    task = case_4()
    plan = dict(enumerate(CASE_4_PI_H, start=1))
    return Given(task, result(task, plan, human_plan=CASE_4_PI_H))


def announced(**options: Any) -> Given:
    """Case 4 in communication mode."""
    task = case_4()
    steps = {
        1: "move h a b; pick_up_medkit rob k2 r",
        2: "move h b c; move rob r c",
        3: "hand_over rob h k2 c",
        4: "move h c d",
        5: "move h d g",
        6: "conduct_triage h g",
    }
    fixed = {"mode": "communication", "discount": "0.9", "communication_weight": "0.5", **options}
    return Given(task, result(task, steps, human_plan=CASE_4_PI_H, **fixed))


def lifted(**options: Any) -> Given:
    """Case 10: two robots lift together; T = 2, discount 0.5."""
    task = case_10()
    plan = {1: "lift r1 r2", 2: "do2 h"}
    fixed = {"discount": "0.5", "horizon": 2, **options}
    return Given(task, result(task, plan, human_plan=("do1 h",), window=(1, 2), **fixed))


def lifted_with_a_goal() -> Given:
    """Case 10 where the robots want q themselves."""
    task = case_10()
    wanted = Condition((task.facts.index("q"),), ())
    return Given(replace(task, robot_goal=wanted), lifted().result)


def together() -> Given:
    """Case 9: a joint action in [1, T+1)."""
    task = case_9()
    return Given(task, result(task, {1: "do_together h r"}, human_plan=("do h",), window=(1, 2)))


def alone() -> Given:
    """Case 9 in mode individual."""
    task = case_9()
    return Given(task, result(task, {1: "do h"}, human_plan=("do h",), mode="individual"))


def jumping(**options: Any) -> Given:
    """pi_H of three steps; a robot does the first two in one, the last is left."""
    task = build(
        init="a",
        goal="d",
        actions={
            "one h": "a -> b @ 2",
            "two h": "b -> c @ 2",
            "three h": "c -> d @ 2",
            "slow h": "c -> e @ 1",
            "end h": "e -> d @ 3",
            "both r": "-> b c @ 1",
            "skip r": "-> c @ 1",
        },
    )
    plan = {1: "both r", 2: "three h"}
    return Given(task, result(task, plan, human_plan=("one h", "two h", "three h"), window=(1, 2), **options))


VALID: tuple[Callable[[], Given], ...] = (
    helped,
    fetched,
    idle,
    announced,
    lambda: announced(communication_weight="0"),
    lambda: helped(preservation="state"),
    lambda: jumping(preservation="state"),
    lifted,
    lifted_with_a_goal,
    together,
    alone,
    jumping,
    lambda: jumping(suffix="subplan"),
    lambda: jumping(interference="strict"),
    lambda: helped(max_window=1, max_cost="human"),
    lambda: fetched(max_window=3),
)


@pytest.mark.parametrize("make", VALID)
def test_valid_results_pass(make: Callable[[], Given]) -> None:
    built = make()
    report = check(built.task, built.result)
    assert report.ok, str(report.first)
    assert not report.unchecked


def _set(make: Callable[[], Given], **fields: Any) -> Given:
    built = make()
    return Given(built.task, replace(built.result, **fields))


def _change(make: Callable[[], Given], change: Callable[[Result], Result]) -> Given:
    built = make()
    return Given(built.task, change(built.result))


def _renamed(name: str, **fields: Any) -> Callable[[Result], Result]:
    def change(given: Result) -> Result:
        index, old = step(given, name)
        return with_steps(given, (index, replace(old, **fields)))

    return change


def _dropped(name: str) -> Callable[[Result], Result]:
    return lambda given: with_steps(given, (step(given, name)[0], None))


def _added(epoch: int, agent: str, name: str, cost: float) -> Callable[[Result], Result]:
    return lambda given: replace(given, plan=(*(given.plan or ()), PlanStep(epoch, (agent,), name, cost)))


def _plan(make: Callable[[], Given], plan: dict[int, str], window: tuple[int, int], **options: Any) -> Given:
    """Another plan for the same call, with figures that fit it."""
    built = make()
    old = built.result
    fixed = {"discount": old.options.discount, "mode": old.mode, "horizon": old.options.horizon, **options}
    return Given(built.task, result(built.task, plan, human_plan=old.human_plan, window=window, **fixed))


def _options(make: Callable[[], Given], **changes: Any) -> Given:
    built = make()
    return Given(built.task, replace(built.result, options=built.result.options.but(**changes)))


SLOW = {1: "both r", 2: "slow h", 3: "end h"}
WAITING = {
    1: "move h a b; pick_up_medkit rob k2 r",
    2: "move h b c; move rob r c",
    3: "hand_over rob h k2 c",
    4: "move h c d",
    6: "move h d g",
    7: "conduct_triage h g",
}
DOCTORED: dict[str, tuple[str, Callable[[], Given]]] = {
    "another human": ("mode-and-human", lambda: _set(helped, human="rob")),
    "mode changed after the fact": ("mode-and-human", lambda: _set(helped, mode="communication")),
    "pi_H with an unknown step": ("human-plan", lambda: _set(helped, human_plan=("fly h",))),
    "pi_H with a robot's step": ("human-plan", lambda: _set(lifted, human_plan=("lift r1 r2", "do2 h"))),
    "pi_H not applicable": ("human-plan", lambda: _set(helped, human_plan=CASE_4_PI_H[1:])),
    "pi_H cut off": ("human-plan", lambda: _set(helped, human_plan=CASE_4_PI_H[:-1])),
    "pi_H kept back": ("human-plan", lambda: _set(announced, human_plan=None)),
    "a plan left out": ("status-and-plan", lambda: _set(helped, plan=None)),
    "infeasible with a plan": ("status-and-plan", lambda: _set(helped, status="infeasible")),
    "no cost": ("status-and-plan", lambda: _set(helped, cost=None)),
    "infeasible though pi_H is an answer": (
        "infeasible",
        lambda: _set(
            helped, status="infeasible", plan=None, cost=None, objective=None, window=None, opportunity=False
        ),
    ),
    "reason contradicts pi_H": ("infeasible", lambda: _set(helped, reason="no-human-plan")),
    "horizon other than pi_H's": ("horizon", lambda: _set(helped, horizon=9)),
    "horizon other than asked for": ("horizon", lambda: _set(lifted, horizon=3)),
    "an epoch past T": ("epoch-range", lambda: _change(helped, lambda r: moved(r, "conduct_triage h g", 9))),
    "an unknown action": (
        "unknown-action",
        lambda: _change(helped, _renamed("move rob r c", action="fly rob")),
    ),
    "another agent": ("wrong-agents", lambda: _change(helped, _renamed("move rob r c", agents=("h",)))),
    "an agent of a joint action missing": (
        "wrong-agents",
        lambda: _change(helped, _renamed("hand_over rob h k2 c", agents=("rob",))),
    ),
    "an action dropped": ("precondition", lambda: _change(helped, _dropped("pick_up_medkit rob k2 r"))),
    "an action too early": (
        "precondition",
        lambda: _change(helped, lambda r: moved(r, "hand_over rob h k2 c", 1)),
    ),
    "two actions swapped": (
        "precondition",
        lambda: _change(helped, lambda r: moved(moved(r, "move h c d", 5), "move h d g", 4)),
    ),
    "an agent busy twice": (
        "agent-busy-twice",
        lambda: _change(helped, _added(1, "rob", "move rob r c", 0.1)),
    ),
    "an action twice in an epoch": (
        "agent-busy-twice",
        lambda: _change(helped, _added(4, "h", "move h c d", 1.0)),
    ),
    "conflicting deletes": ("conflict", lambda: _conflicting()),
    "strict interference ignored": ("conflict", lambda: _strictly_conflicting()),
    "the goal missed": ("human-goal", lambda: _change(helped, _dropped("conduct_triage h g"))),
    "the robots' goal missed": ("robots-goal", lambda: _robots_goal_missed()),
    "a robot in mode individual": ("individual", lambda: _individual_with_robot()),
    "human_cost wrong": ("human-cost", lambda: _set(helped, human_cost=7.0)),
    "a step's cost wrong": ("step-cost", lambda: _change(helped, _renamed("move rob r c", cost=0.05))),
    "a cheaper cost": ("cost", lambda: _set(helped, cost=6.1)),
    "discount changed after the fact": ("step-cost", lambda: _options(helped, discount="0.8")),
    "agent_costs wrong": ("agent-costs", lambda: _set(helped, agent_costs={"h": 6.2, "rob": 0.0})),
    "agent_costs of a stranger": ("agent-costs", lambda: _set(helped, agent_costs={"eve": 1.0})),
    "a cheaper objective": ("objective", lambda: _set(helped, objective=6.2, lower_bound=6.2)),
    "K changed after the fact": ("objective", lambda: _options(helped, window_weight="10")),
    "communication for free": ("objective", lambda: _set(announced, objective=6.2, lower_bound=6.2)),
    "dearer than max_cost": ("max-cost", lambda: _options(helped, max_cost="6")),
    "saving wrong": ("saving", lambda: _set(helped, saving=2.0)),
    "saving without an opportunity": ("saving", lambda: _set(idle, saving=1.0)),
    "saving_alone with an optimal pi_H": ("saving-alone", lambda: _set(helped, saving_alone=0.5)),
    "an opportunity denied": ("opportunity", lambda: _set(announced, opportunity=False, saving=0.0)),
    "an opportunity made up": ("opportunity", lambda: _set(idle, opportunity=True)),
    "an opportunity without a window": (
        "window-presence",
        lambda: _set(helped, window=None, objective=6.2, lower_bound=6.2),
    ),
    "a window in a mode without": ("window-presence", lambda: _windowed_communication()),
    "pi_H not followed where nothing helps": ("idle-answer", lambda: _other_plan_without_opportunity()),
    "a window that starts after pi_H": ("window-range", lambda: _plan_with_late_window()),
    "a window past T": ("window-range", lambda: _window(together, 1, 3)),
    "a window that is too long": ("window-length", lambda: _options(fetched, max_window=2)),
    "a window that starts late: joint action before": ("joint-in-prefix", lambda: _window(helped, 4, 5)),
    "a window shifted": ("prefix", lambda: _window(fetched, 5, 6)),
    "a window cut short": ("robot-in-suffix", lambda: _window(fetched, 3, 5)),
    "a window that ends before the help": ("robot-in-suffix", lambda: _window(helped, 2, 3)),
    "a dearer suffix": ("suffix-replan", lambda: _plan(jumping, SLOW, (1, 2))),
    "a suffix with a pause": ("suffix-replan", lambda: _plan(helped, WAITING, (3, 4))),
    "a suffix off pi_H": ("suffix-subplan", lambda: _off_plan_suffix()),
    "a suffix that repeats pi_H": ("suffix-subplan", lambda: _repeating_suffix()),
    "a state that is not preserved": (
        "preserved-state",
        lambda: _plan(jumping, {1: "skip r", 2: "three h"}, (1, 2), preservation="state"),
    ),
    "a suffix that is no end of pi_H": (
        "preserved-state",
        lambda: _plan(jumping, SLOW, (1, 2), preservation="state"),
    ),
    "a bound above the objective": (
        "bound-and-objective",
        lambda: _set(helped, status="feasible", lower_bound=1006.3),
    ),
    "optimal below its bound": ("bound-and-status", lambda: _set(helped, lower_bound=1006.1)),
}


def _window(make: Callable[[], Given], start: int, end: int) -> Given:
    """The window replaced, the objective following it."""
    built = make()
    old = built.result
    assert old.cost is not None
    objective = float(old.cost + old.options.window_weight * (end - start))
    return Given(
        built.task, replace(old, window=Window(start, end), objective=objective, lower_bound=objective)
    )


def _conflicting() -> Given:
    task = replace(case_7(), goal=Condition())
    plan = {1: "pick_up_medkit h k1 a; pick_up_medkit rob k2 a"}
    return Given(task, result(task, plan, human_plan=(), horizon=1, mode="communication"))


def _strictly_conflicting() -> Given:
    task = build(init="p", goal="q", actions={"use h": "p -> q", "take r": "-> !p"})
    plan = {1: "use h; take r"}
    return Given(task, result(task, plan, human_plan=("use h",), mode="communication", interference="strict"))


def _robots_goal_missed() -> Given:
    built = together()
    task = replace(built.task, robot_goal=Condition((), (0,)))
    return Given(task, built.result)


def _individual_with_robot() -> Given:
    task = case_9()
    return Given(task, result(task, {1: "do_together h r"}, human_plan=("do h",), mode="individual"))


def _windowed_communication() -> Given:
    built = announced(communication_weight="0")
    return Given(built.task, replace(built.result, window=Window(3, 4), objective=6.2))


def _other_plan_without_opportunity() -> Given:
    task = build(goal="p", actions={"do h": "-> p @ 3", "do2 h": "-> p @ 3"})
    return Given(task, result(task, {1: "do2 h"}, human_plan=("do h",)))


def _plan_with_late_window() -> Given:
    return _plan(lifted, {1: "lift r1 r2", 2: "do2 h"}, (2, 3), horizon=2)


def _off_plan_suffix() -> Given:
    return _plan(jumping, SLOW, (1, 2), suffix="subplan")


def _repeating_suffix() -> Given:
    return _plan(jumping, {1: "both r", 2: "three h", 3: "three h"}, (1, 2), suffix="subplan", discount="1")


@pytest.mark.parametrize("name", DOCTORED)
def test_doctored_results_are_refuted_with_the_right_rule(name: str) -> None:
    rule, make = DOCTORED[name]
    built = make()
    report = check(built.task, built.result)
    assert report.first is not None
    assert report.first.rule == rule, str(report.first)


def test_every_rule_refutes_something() -> None:
    refuted = {rule for rule, _ in DOCTORED.values()}
    assert {rule.name for rule in RULES} - refuted == {"ties-mean"}


def test_expected_cost_has_to_be_the_mean() -> None:
    built = idle()
    answers = [{"cost": 6.2, "opportunity": True}, {"cost": 8.0, "opportunity": False}]
    mean = replace(
        built.result,
        options=Options(discount="0.9", ties="expected"),  # type: ignore[arg-type]
        plan=None,
        opportunity=True,
        cost=7.1,
        saving=0.9,
        statistics={"ties": answers},
    )
    assert check(built.task, mean).ok
    for doctored in (replace(mean, cost=7.0), replace(mean, statistics={}), replace(mean, opportunity=False)):
        report = check(built.task, doctored)
        assert report.first is not None
        assert report.first.rule == "ties-mean"


def test_a_violation_names_epoch_and_action() -> None:
    built = _change(helped, _dropped("pick_up_medkit rob k2 r"))
    first = check(built.task, built.result).first
    assert first is not None
    assert (first.epoch, first.action) == (3, "hand_over rob h k2 c")
    assert "'has rob k2' is false" in str(first)


def test_without_a_replay_cost_and_window_are_left_unchecked() -> None:
    built = _change(helped, _dropped("pick_up_medkit rob k2 r"))
    report = check(built.task, built.result)
    assert set(report.unchecked) == {"cost", "window"}
    assert report.of("replay") is report.first
    assert report.of("lower_bound") is None


def test_rules_stand_in_the_order_of_their_claims() -> None:
    claims = [rule.claim for rule in RULES]
    assert claims == sorted(claims, key=CLAIMS.index)
    assert len({rule.name for rule in RULES}) == len(RULES)


@given(tasks(), st.data())
def test_his_optimal_cost_alone_equals_the_oracle(task: Task, data: st.DataObject) -> None:
    """From a random state that a few arbitrary actions lead to."""
    state = task.init
    for _ in range(data.draw(st.integers(0, 3))):
        ready = [action for action in task.actions if action.applicable(state)]
        if ready:
            state = after(state, [data.draw(st.sampled_from(ready))])
    assert Alone(task).optimum(state) == OracleAlone(task).worth(state)
