"""Answers under rules of help: what it may cost, leave behind, disturb, and has to show (semantics 12 to 14).

The call is answered without them first: where the best answer keeps them, that is the answer.  Else it is
answered with what has to be kept as goals of the robots, and with a task that allows nothing else.
"""

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import replace
from fractions import Fraction
from typing import Any, Final

from search import PreparedTask
from search.modes.scenarios import Candidate, solve_scenarios
from serendipity.facade.call import Request
from serendipity.facade.kept import Kept, Literal, epochs, is_kept, kept, kept_by, left, with_goals
from serendipity.facade.leftovers import priced
from serendipity.model import Deadline, HumanPlan, Options, Step, Task, UsageError
from serendipity.model.answers.answer import Answer, ServedGoal
from serendipity.model.errors import LIMITS, limit_reason
from serendipity.model.options import INFINITE
from serendipity.model.task.disturbance import Weighed, disturbance_from
from serendipity.model.task.gate import is_bound, require_metered
from serendipity.model.task.horizon import common_horizon
from serendipity.model.task.leftovers import leftovers
from serendipity.model.task.metered import Metered
from serendipity.model.task.noticed import Noticed

_SHARE: Final = 0.5
"""The share of the time for the call without the rule."""

Solve = Callable[[Request, HumanPlan | None], Iterator[Answer]]
"""Answers a call beside a plan of the human's, or the predicted one, without the rule."""


def answers(call: Request, plan: HumanPlan | None, solve: Solve) -> Iterator[Answer]:
    """Answers that keep the rule, as they get better.

    Args:
        call: the call, in single epochs where it needs time.
        plan: the human's, or None to predict it.
        solve: answers it without the rule.

    Raises:
        UsageError: the rule is asked for, and there is no horizon.
    """

    def keeps(answer: Answer) -> bool:
        if answer.horizon == INFINITE:
            _refuse_infinite(call.options)
            return True
        known, rule = _is_calm(call, answer) and _is_noticed(call, answer), kept_by(call, answer)
        return known and is_kept(call.task, rule, answer) and not left(call, rule, answer)

    def keeping(free: Answer) -> Iterator[Answer]:
        rule = kept_by(call, free)
        if not rule.prices:
            return _keeping(call, free, rule, solve)
        return priced(call, rule, lambda literals: _keeping(call, free, rule, solve, literals))

    found = _answers(call, solve(_soon(call), plan), keeps, keeping)
    if call.options.disturbance is None and call.options.max_disturbance is None:
        return found
    return (one if one.cost is None else one._replace(disturbed=disturbance_of(call, one)) for one in found)


def over_scenarios(call: Request, candidates: Sequence[Candidate]) -> Iterator[Answer]:
    """Answers over scenarios as they get better; where the rule is in force they keep it in each of these.

    Args:
        call: the call, in single epochs where it needs time.
        candidates: the scenarios.

    Raises:
        UsageError: the horizon is too short, or options that the rule does not go with.
    """
    original = call.original or call.task
    if not is_bound(original, call.options):
        return _solved(call, candidates)
    require_metered(original, call.options, scenarios=len(candidates))
    last = common_horizon(call.options, [one.plan for one in candidates])
    rules = [
        kept(call.task.with_goal(one.goal), call.options, one.plan, last, original) for one in candidates
    ]

    def keeps(answer: Answer) -> bool:
        served = zip(answer.goals or (), rules, strict=True)
        return all(is_kept(call.task, rule, one, last) for one, rule in served)

    def keeping(free: Answer) -> Iterator[Answer]:
        del free
        return _keeping_over_scenarios(call, candidates, rules)

    if call.options.risk == "regret":  # what it compares with keeps the rule, too
        return (answer._replace(is_bound=True) for answer in keeping(Answer("unknown")))
    return _answers(call, _solved(_soon(call), candidates), keeps, keeping)


def _solved(call: Request, candidates: Sequence[Candidate]) -> Iterator[Answer]:
    return solve_scenarios(call.prepared, call.options, candidates, call.deadline)


def _soon(call: Request) -> Request:
    return replace(call, deadline=call.deadline.part(_SHARE))


def _answers(
    call: Request,
    found: Iterable[Answer],
    keeps: Callable[[Answer], bool],
    keeping: Callable[[Answer], Iterator[Answer]],
) -> Iterator[Answer]:
    """The answers without the rule that keep it; and where the last one does not, those with it.

    Args:
        call: the call.
        found: answers without the rule.
        keeps: whether one keeps it.
        keeping: answers with it, given the last one without.
    """
    free, best = Answer("unknown"), None
    for free in found:
        if free.cost is not None and keeps(free):
            best = _on_the_way(call.options, free)
            yield best
    if free.cost is None:
        yield free
        return
    least = free.objective if free.status == "optimal" else None
    if best is not None and least is not None and best.objective == least and keeps(free):
        yield free._replace(without_rule=free.cost)
        return
    try:
        for answer in keeping(free):
            is_worse = answer.cost is None or (best is not None and _order(best) < _order(answer))
            if best is not None and is_worse and answer.status not in ("optimal", "infeasible"):
                answer = best
            yield answer._replace(without_rule=None if least is None else free.cost, is_bound=True)
    except LIMITS as limit:
        yield best or Answer("unknown", human_plan=free.human_plan, reason=limit_reason(limit))


def _refuse_infinite(options: Options) -> None:
    if options.nobody_pays or leftovers(options) is not None or options.max_disturbance is not None:
        raise UsageError("horizon: expected a number of epochs, by which nobody may have paid")


def _on_the_way(options: Options, answer: Answer) -> Answer:
    """An answer that may not be the best, with a bound for those without a window, too."""
    least = answer.lower_bound or Fraction(0)
    if options.windowed:
        least = max(Fraction(0), least - options.window_weight)
    return answer._replace(status="feasible", lower_bound=least)


def _keeping(
    call: Request, free: Answer, rule: Kept, solve: Solve, literals: Iterable[Literal] = ()
) -> Iterator[Answer]:
    """Answers to the call with the rule, and more that has to be kept, given the last one without it.

    Raises:
        LimitReachedError: there was no time to put it together.
    """
    plan, task = free.human_plan, with_goals(call.task, rule.facts, literals)
    optimum = call.optimum if call.given is not None or plan is None else call.task.cost_of(plan)
    asked = replace(call, optimum=optimum, predicts=plan is not None, question=None)
    layers: list[Noticed | Metered | Calm] = []
    if call.options.noticed and plan is not None:
        layers.append(Noticed(task, plan, call.original or call.task))
        task = layers[-1].task
    if call.task.robot_goal and rule.most is not None:
        layers.append(Metered(task, rule.most, call.deadline))
    if call.options.max_disturbance is not None:
        metered = layers[-1].task if layers else task
        layers.append(Calm(metered, call.original or call.task, call.options, call.deadline))
    given = plan
    for layer in layers:
        given = None if given is None else layer.plan(given)
    found = solve(replace(asked, prepared=PreparedTask(layers[-1].task if layers else task)), given)
    return (_told(layers, answer) for answer in found)


class Calm:
    """A task in which help disturbs the human no more than it may (semantics 13)."""

    def __init__(self, task: Task, original: Task, options: Options, deadline: Deadline) -> None:
        self._weighed = Weighed(task, disturbance_from(options.disturbance), original)
        most, weights = options.max_disturbance or Fraction(0), self._weighed.weights
        self._metered = Metered(self._weighed.task, most, deadline, weights, "disturbed")
        self.task = self._metered.task

    def plan(self, plan: HumanPlan) -> HumanPlan:
        """The human's plan, by ids of this task; it disturbs nobody."""
        ids = {number: new for new, number in enumerate(self._weighed.original)}
        return self._metered.plan(tuple(ids[number] for number in plan))

    def back(self, plan: Sequence[int]) -> tuple[int, ...]:
        """A plan by ids of the task that was given."""
        return tuple(self._weighed.original[number] for number in self._metered.back(plan))


def _keeping_over_scenarios(
    call: Request, candidates: Sequence[Candidate], rules: Sequence[Kept]
) -> Iterator[Answer]:
    """The same over scenarios."""
    bound = [replace(one, kept=rule.facts) for one, rule in zip(candidates, rules, strict=True)]
    mosts = [rule.most for rule in rules if rule.most is not None]
    if not mosts:
        return _solved(call, bound)
    metered = Metered(call.task, max(mosts), call.deadline)
    bound = [
        replace(one, goal=metered.goal(one.goal, most), plan=metered.plan(one.plan))
        for one, most in zip(bound, mosts, strict=True)
    ]
    found = _solved(replace(call, prepared=PreparedTask(metered.task)), bound)
    return (_told([metered], answer) for answer in found)


def _told(layers: Sequence[Noticed | Metered | Calm], answer: Answer) -> Answer:
    """An answer about a task with some layers on it as one about the task itself."""

    def original(ids: Sequence[int]) -> tuple[int, ...]:
        for layer in reversed(layers):
            ids = layer.back(ids)
        return tuple(ids)

    def back(answer: ServedGoal | Answer) -> dict[str, Any]:
        plan, steps = answer.human_plan, answer.steps or ()
        actions = original([step.action for step in steps])
        return {
            "human_plan": None if plan is None else original(plan),
            "steps": None
            if answer.steps is None
            else tuple(Step(step.epoch, action) for step, action in zip(steps, actions, strict=True)),
        }

    goals = None if answer.goals is None else tuple(replace(one, **back(one)) for one in answer.goals)
    return answer._replace(**back(answer), goals=goals)


def _order(answer: Answer) -> tuple[bool, Fraction, Fraction]:
    return not answer.opportunity, answer.objective or Fraction(0), answer.cost or Fraction(0)


# -- what an answer keeps


def _is_calm(call: Request, answer: Answer) -> bool:
    """Whether an answer disturbs the human no more than it may."""
    most = call.options.max_disturbance
    return most is None or disturbance_of(call, answer) <= most


def _is_noticed(call: Request, answer: Answer) -> bool:
    """Whether the human sees in time what an answer has them leave their plan for."""
    if not call.options.noticed or answer.human_plan is None:
        return True
    return Noticed(call.task, answer.human_plan, call.original or call.task).allows(answer.steps or ())


def disturbance_of(call: Request, answer: Answer) -> Fraction:
    """How much an answer disturbs the human."""
    task = call.task
    weighed = Weighed(task, disturbance_from(call.options.disturbance), call.original or task)
    variants: dict[int, list[int]] = {}
    for new, number in enumerate(weighed.original):
        variants.setdefault(number, []).append(new)
    ids = {id(action): number for number, action in enumerate(task.actions)}
    found = Fraction(0)
    steps = answer.steps or ()
    last = max((step.epoch for step in steps), default=0)
    for state, actions in epochs(task, steps, last):
        for action in actions:
            for new in variants[ids[id(action)]]:
                if weighed.task.actions[new].applicable(state):
                    found += weighed.weights[new]
                    break
    return found
