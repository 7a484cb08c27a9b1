"""Laws: what holds between the answers of the search to one call, however it is asked.

Each takes a call and the planner's answer to it, and says what is wrong, if anything is.
"""

from collections.abc import Callable, Iterator, Mapping
from contextlib import suppress
from dataclasses import replace
from itertools import pairwise
from random import Random
from typing import Any, Final

from serendipity.facade.call import options_from
from serendipity.facade.certify import check, verify
from serendipity.facade.planning import plan, plan_anytime
from serendipity.facade.session import Session
from serendipity.model import Deadline, Options, PlanError, Result, Task, UsageError
from serendipity_testing.countdown import Countdown
from serendipity_testing.generator.calls import PlanCall, random_options
from serendipity_testing.generator.tasks import split

Law = Callable[[PlanCall, Result], Iterator[str]]


def limited(call: PlanCall, answer: Result) -> Iterator[str]:
    """Wherever a limit comes, on a task that is new or not, the answer claims no more than is so."""
    task, dice = replace(call.task), Random(f"limits {call.seed}")
    last, looks = answer, 0
    while True:
        deadline = Countdown(looks)
        early = _plan(call, task, deadline=deadline)
        yield from (f"after {looks} looks at the time: {fault}" for fault in _faults(call, early, answer))
        if early.status == "feasible":
            last = early
        if early.status in ("optimal", "infeasible"):
            break
        looks = int(looks * dice.uniform(1.5, 3)) + 1
    yield from _differences("the next call", _plan(call, task), answer)
    for looks in (0, dice.randint(1, 40)):
        early = _plan(call, task, deadline=Countdown(looks))
        yield from (f"once more, after {looks} looks: {fault}" for fault in _faults(call, early, answer))
    if last.status == "feasible":
        refuted = verify(call.task, last).refuted
        if refuted is not None:
            yield f"status {last.status}: refuted: {refuted.claim}: {refuted.reason}"


def anytime(call: PlanCall, answer: Result) -> Iterator[str]:
    """Answers on the way get better and claim no more than is so; the last is what ``plan`` says."""
    said = list(plan_anytime(replace(call.task), human_plan=call.human_plan, **call.keywords()))
    for early in said:
        yield from _faults(call, early, answer)
    for one, other in pairwise(said):
        if (one.lower_bound or 0) > (other.lower_bound or one.lower_bound or 0):
            yield f"the bound falls from {one.lower_bound} to {other.lower_bound}"
    yield from _differences("the last one", said[-1], answer)


def repeated(call: PlanCall, answer: Result) -> Iterator[str]:
    """Tables that other calls have left with a task change nothing."""
    task, dice = replace(call.task), Random(f"other options {call.seed}")
    for _ in range(2):
        with suppress(UsageError):
            plan(task, **PlanCall(task, random_options(dice)).keywords())
    yield from _differences("after other calls", _plan(call, task), answer)


def in_session(call: PlanCall, answer: Result) -> Iterator[str]:
    """A session answers like fresh calls, also after an epoch was executed."""
    session = Session(replace(call.task), human_plan=call.human_plan, **call.keywords())
    yield from _differences("in a session", session.plan(), answer)
    session.execute([step.action for step in answer.plan or () if step.epoch == 1])
    fresh = replace(call.task, init=session.task.init)
    if call.options.get("human_model") == "local":  # what they see hangs on the variables, which are kept
        fresh = call.task.at(session.task.init)
    given = session.human_plan
    expected = _or_error(lambda: plan(fresh, human_plan=given, **call.keywords()))
    found = _or_error(session.plan)
    if isinstance(expected, str) or isinstance(found, str):
        if expected != found:
            yield f"a session says {found}, a fresh call {expected}"
        return
    yield from _differences("after an epoch", _same_rank(fresh, found, expected), expected)


def in_variants(call: PlanCall, answer: Result) -> Iterator[str]:
    """An action written as two, where some fact is true and where it is false, is the same action.

    Not so where ``pi_H`` is followed in the variant that was planned, as in a prefix and beside
    goals of robots, nor where conditions interfere.
    """
    options, task, dice = options_from(call.keywords()), call.task, Random(f"variants {call.seed}")
    theirs = {f for a in task.actions if task.human not in a.participants for f in (*a.add, *a.delete)}
    if options.windowed or options.strict or task.robot_goal or not theirs or not task.human_actions:
        return
    i, fact = dice.choice(task.human_actions), dice.choice(sorted(theirs))
    if fact in (*task.actions[i].pre, *task.actions[i].neg):
        return
    found = _plan(call, split(task, i, fact))
    for name in ("status", "cost", "objective", "opportunity", "saving"):
        if getattr(found, name) != getattr(answer, name):
            yield f"{name} is {getattr(found, name)} with '{task.actions[i].name}' in two variants"


LAWS: Final[Mapping[str, Law]] = {
    "limits": limited,
    "on the way": anytime,
    "again": repeated,
    "session": in_session,
    "variants": in_variants,
}
"""Laws by what they say is asked otherwise."""


def _plan(call: PlanCall, task: Task, deadline: Deadline | None = None) -> Result:
    return plan(task, human_plan=call.human_plan, deadline=deadline, **call.keywords())


def _or_error(ask: Callable[[], Result]) -> Result | str:
    try:
        return ask()
    except (UsageError, PlanError) as error:
        return str(error)


def _differences(where: str, found: Result, expected: Result) -> Iterator[str]:
    one, other = _told(found), _told(expected)
    for name, value in one.items():
        if value != other[name]:
            yield f"{where}: {name} is {value}, not {other[name]}"


def _told(answer: Result) -> dict[str, Any]:
    """Fields of an answer, without the figures of its call."""
    data = answer.to_dict()
    exact = {name: texts for name, texts in data.get("exact", {}).items() if name != "statistics"}
    return data | {"statistics": {}, "exact": exact}


def _same_rank(task: Task, found: Result, expected: Result) -> Result:
    """``found``, with the expected plan where its own is another one of the same rank (semantics 3.1).

    A session keeps variables that a fresh call doesn't find, which may decide between the two.  Where goals
    are shared, ties of one objective are settled as far as the search got (semantics, Decisions).
    """
    shared = _is_shared(task)

    def rank(each: Result) -> tuple[object, ...]:
        return (each.objective, each.cost) if shared else (each.cost, each.window, len(each.plan or ()))

    if rank(found) != rank(expected) or check(task, found).refuted is not None:
        return found
    return _with(found, expected, "plan", "window", "agent_costs", "realised")


def _faults(call: PlanCall, early: Result, final: Result) -> Iterator[str]:
    """False claims of an answer that a limit may have cut short."""
    refuted = check(call.task, early).refuted
    if refuted is not None:
        yield f"refuted: {refuted.claim}: {refuted.reason}"
    if early.status in ("optimal", "infeasible"):
        if early.realised.items() <= final.realised.items():  # verdicts come after the proof
            early = _with(early, final, "realised")
        if early.human_plan is None and early.mode == "composite" and early.horizon == final.horizon:
            # The joint optimum waits neither for pi_H nor for what is counted from it (semantics, Decisions).
            early = _with(early, final, "human_plan", "human_cost", "saving", "saving_alone", "opportunity")
        if _is_shared(call.task) and (early.objective, early.cost) == (final.objective, final.cost):
            # The proof is of the objective; ties are settled as far as the search got (semantics, Decisions).
            early = _with(early, final, "plan", "window", "agent_costs", "realised")
        if early.mode == "individual" and call.human_plan is None and early.cost == final.cost:
            # Their cost is proved; the plan is the canonical one only as far as the search got.
            early = _with(early, final, "human_plan", "horizon", "plan", "agent_costs", "realised")
        yield from _differences(early.status, early, final)
        return
    if final.status == "infeasible":
        if early.status != "unknown":
            yield f"status {early.status}, though nothing is feasible"
        return
    if _above(early.lower_bound, final.objective):
        yield f"lower_bound {early.lower_bound}, but the optimum is {final.objective}"
    if early.status == "feasible" and _comparable(call) and _above(_rank(final), _rank(early)):
        yield f"objective {early.objective}, but the optimum is {final.objective}"
    if early.opportunity and call.options.get("ties", "fixed") == "fixed":
        yield from _opportunity_faults(early, final)


def _with(answer: Result, other: Result, *names: str) -> Result:
    """An answer with some of another one's fields."""
    return replace(answer, **{name: getattr(other, name) for name in names})


def _is_shared(task: Task) -> bool:
    """True if actions without the human change what goals ask for."""
    wanted = {f for goal in (task.goal, task.robot_goal) for f in (*goal.positive, *goal.negative)}
    others = (action for action in task.actions if task.human not in action.participants)
    return any(wanted.intersection((*action.add, *action.delete)) for action in others)


def _opportunity_faults(early: Result, final: Result) -> Iterator[str]:
    if early.saving_alone not in (None, final.saving_alone):  # None: not known yet
        yield f"an opportunity with saving_alone {early.saving_alone}, which is {final.saving_alone}"
    if early.saving is not None and early.saving <= (final.saving_alone or 0):
        yield f"an opportunity that saves {early.saving}, without robots {final.saving_alone}"
    if final.saving_alone and not any(step.agents != (early.human,) for step in early.plan or ()):
        yield "an opportunity in which no robot acts"


def _comparable(call: PlanCall) -> bool:
    """True if objectives with and without a window can be set against each other."""
    options = options_from(call.keywords())
    means = options.ties != "fixed" and options.mode in ("serendipity", "communication")
    return not (options.windowed and (call.task.robot_goal or means))


def _rank(answer: Result) -> float | None:
    """The objective, as if doing nothing had a window of one epoch (semantics 3.1)."""
    if answer.objective is None or answer.window is not None or not answer.human_plan:
        return answer.objective
    options: Options = answer.options
    replans = options.human_model != "omniscient"
    return answer.objective + (float(options.window_weight) if options.windowed and not replans else 0)


def _above(one: float | None, other: float | None) -> bool:
    """True if a figure exceeds another by more than rounding."""
    return one is not None and other is not None and one > other + 1e-9 * max(1.0, abs(other))
