"""Results that keep every rule and are not what they claim to be: only an optimiser can refute them."""

from collections.abc import Callable
from dataclasses import replace
from typing import Any

from serendipity.model import Condition, Options, Result, Task
from serendipity_testing.by_hand import result
from serendipity_testing.cases import CASE_3_PLAN, case_2, case_3, case_4, case_8, case_9, case_10
from tests.verify.valid import CASE_2_FETCHED, CASE_2_PI_H, CASE_4_HELP, CASE_4_PI_H
from verify.calls.solve import solve


def solved(task: Task, human_plan: tuple[str, ...] | None = None, **options: Any) -> Result:
    return solve(task, Options(**options), human_plan=human_plan)


def dearer() -> tuple[Task, Result]:
    """The plan that K = 0 is answered, claimed optimal for K = 1000."""
    task = case_2()
    return task, result(task, CASE_2_FETCHED, human_plan=CASE_2_PI_H, window=(3, 6), discount="0.5")


def _wasteful(**options: Any) -> tuple[Task, Result]:
    """A needless action of the robot before the best plan."""
    task = case_4()
    plan = dict(CASE_4_HELP)
    if options["mode"] == "communication":
        plan[4] += "; move rob c d"
        return task, result(task, plan, human_plan=CASE_4_PI_H, discount="0.9", **options)
    plan = {**plan, 3: "hand_over rob h k2 c", 4: "move h c d; move rob c d"}
    return task, result(task, plan, human_plan=CASE_4_PI_H, discount="0.9", window=(3, 5), **options)


def _denied(mode: str) -> tuple[Task, Result]:
    task = case_4()
    plan = dict(enumerate(CASE_4_PI_H, start=1))
    return task, result(task, plan, human_plan=CASE_4_PI_H, discount="0.9", mode=mode)


def _hasty_bound() -> tuple[Task, Result]:
    """``pi_H`` as the best so far, with a bound above what help would cost (6.2)."""
    task, denied = _denied("serendipity")
    return task, replace(denied, status="feasible", lower_bound=6.5)


def _tied(ties: str, **fields: Any) -> tuple[Task, Result]:
    task = case_4()
    return task, replace(solved(task, discount="0.9", ties=ties), **fields)


def _other_ties() -> tuple[Task, Result]:
    """The dearest answer as the cheapest; the others are kept quiet, or a rule would see it."""
    task, robust = _tied("robust")
    own = tuple(tied for tied in robust.ties if tied.human_plan == robust.human_plan)
    return task, replace(robust, options=robust.options.but(ties="optimistic"), ties=own)


def _infeasible(task: Task, horizon: int) -> tuple[Task, Result]:
    answer = solved(task, mode="composite", horizon=1)
    return task, replace(answer, options=answer.options.but(horizon=horizon), horizon=horizon)


def _wrong_saving_alone() -> tuple[Task, Result]:
    """A given plan with a detour, whose own improvement is denied."""
    task = case_9()
    detour = replace(
        task,
        actions=(replace(task.actions[0], name="do h slowly", cost=task.actions[0].cost + 1), *task.actions),
    )
    detour = replace(detour, actions=tuple(sorted(detour.actions, key=lambda action: action.key)))
    answer = solved(detour, ("do h slowly",))
    return detour, replace(answer, saving_alone=0.5)


def _forgotten_robots_goal() -> tuple[Task, Result]:
    """``saving`` compares with what doing nothing costs while robots reach ``G_R``."""
    task = case_10()
    wanted = replace(task, robot_goal=Condition((task.facts.index("q"),), ()))
    answer = solved(wanted, discount="0.5", horizon=2)
    return wanted, replace(answer, saving=2.5)


UNTRUE: dict[str, tuple[str, Callable[[], tuple[Task, Result]]]] = {
    "a longer window claimed optimal": ("optimal", dearer),
    "a needless action, without communication": ("optimal", lambda: _wasteful(mode="serendipity")),
    "a needless action, with communication": ("optimal", lambda: _wasteful(mode="communication")),
    "an opportunity missed, without communication": ("no_opportunity", lambda: _denied("serendipity")),
    "an opportunity missed, with communication": ("optimal", lambda: _denied("communication")),
    "an opportunity missed, composite": ("optimal", lambda: _denied("composite")),
    "a bound above the optimum": (
        "lower_bound",
        lambda: (dearer()[0], replace(dearer()[1], status="feasible", lower_bound=1008.6)),
    ),
    "a bound above an opportunity not yet found": ("lower_bound", _hasty_bound),
    "the robust answer called optimistic": ("no_opportunity", _other_ties),
    "infeasible though there is a plan": ("infeasible", lambda: _infeasible(case_8(), 2)),
    "saving_alone wrong": ("cost", _wrong_saving_alone),
    "saving wrong with a robots' goal": ("cost", _forgotten_robots_goal),
    "a dearer individual plan": (
        "optimal",
        lambda: (
            case_3(),
            result(
                case_3(),
                dict(enumerate(("move h a b", "move h b a", *CASE_3_PLAN), start=1)),
                human_plan=("move h a b", "move h b a", *CASE_3_PLAN),
                mode="individual",
            ),
        ),
    ),
}
