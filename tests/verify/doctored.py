"""Doctored results by name, and what has to refute each: a registry for tests and for the table.

``RULE_BROKEN`` break a rule of the plan's execution, its figures or its window; the rule
checker names it.  Those of :mod:`tests.verify.untrue` keep every rule.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

import serendipity
from serendipity.model import Condition, Deadline, Options, PlanStep, Policy, Result, Task, Window
from serendipity.model.answers.result_parts import TiedAnswer
from serendipity_testing.builders import task as build
from serendipity_testing.by_hand import moved, result, step, with_steps
from serendipity_testing.cases import case_7, case_8, case_9
from serendipity_testing.crosscheck.doctored import without_plan
from tests.verify.edits.corpus import walk
from tests.verify.untrue import UNTRUE
from tests.verify.valid import (
    CASE_4_PI_H,
    Given,
    announced,
    endless,
    fetched,
    helped,
    idle,
    jumping,
    lifted,
    together,
)
from verify.calls.single_epochs import SingleEpochs
from verify.calls.solve import solve
from verify.rules import RULES


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


def _infeasible(given: Result) -> Result:
    return without_plan(given, "infeasible", "no-plan-within-horizon")


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


def stuck() -> Given:
    """Case 8: no plan of the human alone."""
    return Given(case_8(), solve(case_8(), Options()))


def _not_among_the_ties() -> Given:
    built = _options(helped, ties="robust")
    listed = (TiedAnswer(CASE_4_PI_H, cost=8.0, opportunity=False),)
    return Given(built.task, replace(built.result, ties=listed))


SLOW = {1: "both r", 2: "slow h", 3: "end h"}
WAITING = {
    1: "move h a b; pick_up_medkit rob k2 r",
    2: "move h b c; move rob r c",
    3: "hand_over rob h k2 c",
    4: "move h c d",
    6: "move h d g",
    7: "conduct_triage h g",
}


def _unfinished() -> Given:
    """A robot is still at something at the end."""
    task = walk()
    found = serendipity.plan(task, mode="composite")
    longer = replace(found, plan=(*(found.plan or ()), PlanStep(4, ("r",), "lay r", 1.0, 2)))
    epochs = SingleEpochs(task, longer, Deadline())
    return Given(epochs.task, epochs.result())


RULE_BROKEN: dict[str, tuple[str, Callable[[], Given]]] = {
    "another human": ("mode-and-human", lambda: _set(helped, human="rob")),
    "mode changed after the fact": ("mode-and-human", lambda: _set(helped, mode="communication")),
    "pi_H with an unknown step": ("human-plan", lambda: _set(helped, human_plan=("fly h",))),
    "pi_H with a robot's step": ("human-plan", lambda: _set(lifted, human_plan=("lift r1 r2", "do2 h"))),
    "pi_H not applicable": ("human-plan", lambda: _set(helped, human_plan=CASE_4_PI_H[1:])),
    "pi_H cut off": ("human-plan", lambda: _set(helped, human_plan=CASE_4_PI_H[:-1])),
    "pi_H kept back": ("human-plan", lambda: _set(announced, human_plan=None)),
    "pi_H kept back where max_cost rests on it": ("human-plan", lambda: endless(max_cost="human")),
    "a plan left out": ("status-and-plan", lambda: _set(helped, plan=None)),
    "infeasible with a plan": ("status-and-plan", lambda: _set(helped, status="infeasible")),
    "a robot at work at the end": ("at-rest", _unfinished),
    "no cost": ("status-and-plan", lambda: _set(helped, cost=None)),
    "infeasible though pi_H is an answer": ("infeasible", lambda: _change(helped, _infeasible)),
    "a reason beside a plan": ("reason", lambda: _set(helped, reason="no-human-plan")),
    "infeasible for another reason": ("reason", lambda: _set(stuck, reason="no-plan")),
    "ties without their answers": ("ties", lambda: _options(helped, ties="robust")),
    "an answer that is not among the ties": ("ties", _not_among_the_ties),
    "a policy in another mode": ("mode-and-human", lambda: _set(helped, policy=Policy((), None))),
    "no saving": ("status-and-plan", lambda: _set(helped, saving=None)),
    "no saving_alone": ("status-and-plan", lambda: _set(helped, saving_alone=None)),
    "costs of agents without a plan": ("status-and-plan", lambda: _set(stuck, agent_costs={"h": 0.0})),
    "a window under a human model": ("status-and-plan", lambda: _options(helped, human_model="observant")),
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
    "an agent busy twice": (
        "agent-busy-twice",
        lambda: _change(helped, _added(1, "rob", "move rob r c", 0.1)),
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
    "a cheaper objective": ("objective", lambda: _set(helped, objective=6.2, lower_bound=6.2)),
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
    "a dearer suffix": ("suffix-replan", lambda: _plan(jumping, SLOW, (1, 2))),
    "a suffix with a pause": ("suffix-replan", lambda: _plan(helped, WAITING, (3, 4))),
    "a suffix off pi_H": ("suffix-subplan", lambda: _plan(jumping, SLOW, (1, 2), suffix="subplan")),
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


def _repeating_suffix() -> Given:
    return _plan(jumping, {1: "both r", 2: "three h", 3: "three h"}, (1, 2), suffix="subplan", discount="1")


@dataclass(frozen=True, slots=True)
class Doctored:
    """A result that has to be refuted.

    Attributes:
        claim: the claim that falls.
        rule: the rule that is broken, or None where none is.
        make: makes task and result.
    """

    claim: str
    rule: str | None
    make: Callable[[], tuple[Task, Result]]


def _of_rule(rule: str, make: Callable[[], Given]) -> Doctored:
    def both() -> tuple[Task, Result]:
        built = make()
        return built.task, built.result

    return Doctored(next(known.claim for known in RULES if known.name == rule), rule, both)


DOCTORED: dict[str, Doctored] = {
    **{name: _of_rule(rule, make) for name, (rule, make) in RULE_BROKEN.items()},
    **{name: Doctored(claim, None, make) for name, (claim, make) in UNTRUE.items()},
}

ANOTHER_TASK = ("another human", "pi_H with an unknown step", "mode changed after the fact")
"""Doctored results that a certificate does not examine: they are refused as bad input."""
