"""Answers under rules of help: what it may cost, leave behind, disturb, and has to show (semantics 12 to 14).

The call is answered without them first: where the best answer keeps them, that is the answer.  Else it is
answered with what has to be kept as goals of the robots, and with a task that allows nothing else.
"""

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import replace
from fractions import Fraction
from typing import Final

from search import PreparedTask
from search.modes.scenarios import Candidate, solve_scenarios
from serendipity.facade.call import Request
from serendipity.facade.kept import (
    Kept,
    Literal,
    is_kept,
    kept,
    kept_by,
    left,
    left_by,
    with_goals,
    with_literals,
)
from serendipity.facade.leftovers import OnePlan, beating_alone, priced
from serendipity.facade.leftovers_over_scenarios import Literals, OverScenarios, PricedScenarios, at_worst
from serendipity.model import Condition, Deadline, HumanPlan, Options, Step, Task, UsageError
from serendipity.model.answers.answer import Answer, ServedGoal
from serendipity.model.errors import LIMITS, limit_reason
from serendipity.model.options import INFINITE
from serendipity.model.task.disturbance import DisturbanceTask, disturbance_from
from serendipity.model.task.gate import is_bound, require_metered
from serendipity.model.task.horizon import common_horizon
from serendipity.model.task.leftovers import leftovers
from serendipity.model.task.metered import Metered
from serendipity.model.task.noticed import Noticed
from serendipity.model.task.protected import interfering_plainly, protected
from serendipity.model.task.single_epochs import epochs

_SHARE: Final = 0.5
"""The share of the time for the call without the rule, where its best answer breaks it."""

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
        known = _is_known(call, call.task, answer, int(answer.horizon or 0))
        rule = kept_by(call, answer)
        return known and is_kept(call.task, rule, answer) and not left(call, rule, answer)

    def keeping(free: Answer) -> Iterator[Answer]:
        rule = kept_by(call, free)
        if not rule.prices:
            return map(_proved_against_alone, _keeping(call, free, rule, solve))
        asked = OnePlan(call, rule)
        return priced(call.options, asked, lambda literals, _: _keeping(call, free, rule, solve, literals))

    soon = _soon(call)
    return _disturbing(call, _answers(call, soon, solve(soon, plan), keeps, keeping))


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
        return all(
            is_kept(call.task, rule, served, last)
            and _is_known(call, call.task.with_goal(one.goal), served, last)
            and not left_by(call.task, rule, served.steps or (), last)
            for one, served, rule in zip(candidates, answer.goals or (), rules, strict=True)
        )

    def keeping(_free: Answer) -> Iterator[Answer]:
        under, asked = [*_under_rules(call, candidates, rules)], _plain(call)
        if not any(rule.prices for rule in rules):
            return _solved(asked, under)
        if call.options.risk != "mean":
            return at_worst(asked, candidates, rules, last, lambda kept: [*_keeping_more(under, kept)])
        idle = next(_solved(call, candidates))
        question = OverScenarios(PricedScenarios(call.task, call.options, candidates, rules, last), idle)
        return priced(
            call.options, question, lambda literals, _: _solved(asked, [*_keeping_more(under, literals)])
        )

    if call.options.risk == "regret":  # what it compares with keeps the rule, too
        found = (answer._replace(is_bound=True) for answer in keeping(Answer("unknown")))
        return _disturbing(call, found)
    soon = _soon(call)
    return _disturbing(call, _answers(call, soon, _solved(soon, candidates), keeps, keeping))


def _disturbing(call: Request, found: Iterator[Answer]) -> Iterator[Answer]:
    """Answers that say how much they disturb the human, where that counts; at most, over scenarios."""
    if call.options.disturbance is None and call.options.max_disturbance is None:
        return found

    def amount(answer: Answer) -> Fraction:
        return max(disturbance_of(call, one) for one in answer.goals or (answer,))

    return (one if one.cost is None else one._replace(disturbed=amount(one)) for one in found)


def _solved(call: Request, candidates: Sequence[Candidate]) -> Iterator[Answer]:
    return solve_scenarios(call.prepared, call.options, candidates, call.deadline)


def _soon(call: Request) -> Request:
    return call._replace(deadline=call.deadline.part(_SHARE))


def _answers(
    call: Request,
    soon: Request,
    found: Iterable[Answer],
    keeps: Callable[[Answer], bool],
    keeping: Callable[[Answer], Iterator[Answer]],
) -> Iterator[Answer]:
    """The answers without the rule that keep it; and where the last one does not, those with it.

    The call without it has all the time that there is, until its best answer is one that breaks it.

    Args:
        call: the call.
        soon: the one without the rule, which has a share of the time.
        found: answers without the rule, no better than which is any with it.
        keeps: whether one keeps it.
        keeping: answers with it, given the last one without.
    """
    free, best, share = Answer("unknown"), None, soon.deadline.within()
    soon.deadline.renew(call.deadline)
    for free in found:
        is_kept = free.cost is not None and keeps(free)
        if is_kept:
            best = _on_the_way(call.options, free)
            yield best
        soon.deadline.renew(call.deadline if is_kept else share)
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
            answer = _at_least(answer, free)
            yield answer._replace(without_rule=None if least is None else free.cost, is_bound=True)
    except LIMITS as limit:
        yield best or Answer("unknown", human_plan=free.human_plan, reason=limit_reason(limit))


def _refuse_infinite(options: Options) -> None:
    if options.nobody_pays or leftovers(options) is not None or options.max_disturbance is not None:
        raise UsageError("horizon: expected a number of epochs, by which nobody may have paid")


def _on_the_way(options: Options, answer: Answer) -> Answer:
    """An answer that may not be the best, with a bound for those without a window, too."""
    least = answer.lower_bound or Fraction(0)
    if options.windowed and not answer.opportunity:
        least = max(Fraction(0), least - options.window_weight)
    return answer._replace(status="feasible", lower_bound=least)


def _at_least(answer: Answer, free: Answer) -> Answer:
    """An answer with the rule, bounded by one without it of the same kind."""
    if answer.cost is None or answer.status != "feasible" or answer.opportunity is not free.opportunity:
        return answer
    least = max(answer.lower_bound or Fraction(0), free.lower_bound or Fraction(0))
    return answer._replace(lower_bound=least, status="optimal" if least == answer.objective else "feasible")


def _keeping(
    call: Request, free: Answer, rule: Kept, solve: Solve, literals: Iterable[Literal] = ()
) -> Iterator[Answer]:
    """Answers to the call with the rule, and more that has to be kept, given the last one without it.

    Raises:
        LimitReachedError: there was no time to put it together.
    """
    plan, task = free.human_plan, with_goals(call.task, rule.facts, literals)
    optimum = call.optimum if call.given is not None or plan is None else call.task.cost_of(plan)
    asked = _plain(call)._replace(optimum=optimum, predicts=plan is not None, question=None)
    layers = _Layers(call, task, plan, rule.most if call.task.robot_goal else None)
    given = None if plan is None else layers.plan(plan)
    found = solve(asked._replace(prepared=PreparedTask(layers.task)), given)
    answers = (_told(layers, answer) for answer in found)
    if call.given is None or call.task.robot_goal:
        return answers
    # What they gain alone is what they gain whatever they leave: not what the goals of the rule make of it.
    return (one._replace(saving_alone=None if one.cost is None else free.saving_alone) for one in answers)


def _proved_against_alone(answer: Answer) -> Answer:
    """An answer with the rule, as far as it is known what the human gains alone; else it helps nobody."""
    if answer.baseline is None or answer.cost is None:
        return answer
    if answer.saving_alone is not None:
        found = beating_alone(answer)
        return found._replace(lower_bound=found.objective) if found.status == "optimal" else found
    found = beating_alone(answer._replace(saving_alone=answer.baseline))
    least = min(answer.lower_bound or Fraction(0), found.objective or Fraction(0))
    return found._replace(saving_alone=None, status="feasible", lower_bound=least)


def _plain(call: Request) -> Request:
    """The call for tasks with layers on them."""
    return call._replace(options=interfering_plainly(call.options))


class _Layers:
    """A task that allows nothing but what rules of help do.

    Args:
        plan: the human's, or None without one.
        most: that they may pay; None: anything.
    """

    def __init__(self, call: Request, task: Task, plan: HumanPlan | None, most: Fraction | None) -> None:
        self.task, self._layers = task, list[Noticed | Metered | Calm]()
        original = call.original or call.task
        if call.options.noticed and plan is not None:
            self._add(Noticed(task, plan, original))
        self._metered = None if most is None else Metered(self.task, most, call.deadline)
        if self._metered is not None:
            self._add(self._metered)
        if call.options.max_disturbance is not None:
            self._add(Calm(self.task, original, call.options, call.deadline))
        self.task = protected(self.task, call.options, len(original.facts))

    def _add(self, layer: "Noticed | Metered | Calm") -> None:
        self.task = layer.task
        self._layers.append(layer)

    def plan(self, plan: HumanPlan) -> HumanPlan:
        """The human's plan by ids of this task."""
        for layer in self._layers:
            plan = layer.plan(plan)
        return plan

    def goal(self, goal: Condition, most: Fraction | None) -> Condition:
        """A goal with which they have paid no more than so much."""
        return goal if self._metered is None or most is None else self._metered.goal(goal, most)

    def back(self, plan: Sequence[int]) -> tuple[int, ...]:
        """A plan by ids of the task that was given."""
        for layer in reversed(self._layers):
            plan = layer.back(plan)
        return tuple(plan)


class Calm:
    """A task in which help disturbs the human no more than it may (semantics 13)."""

    def __init__(self, task: Task, original: Task, options: Options, deadline: Deadline) -> None:
        self._weighed = DisturbanceTask(task, disturbance_from(options.disturbance), original)
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


def _under_rules(
    call: Request, candidates: Sequence[Candidate], rules: Sequence[Kept]
) -> Iterator[Candidate]:
    """Scenarios with what each has to keep, and with a task of its own, one where that is the same."""
    most = max((rule.most for rule in rules if rule.most is not None), default=None)
    known: dict[object, tuple[_Layers, PreparedTask]] = {}
    for one, rule in zip(candidates, rules, strict=True):
        task, asked = call.task, (one.goal, one.plan) if call.options.noticed else None
        if asked is not None:
            task = task.with_goal(one.goal)
        if asked not in known:
            layers = _Layers(call, task, one.plan, most)
            known[asked] = layers, PreparedTask(layers.task)
        layers, own = known[asked]
        goal = layers.goal(one.goal if asked is None else layers.task.goal, rule.most)
        original = layers.back(range(len(layers.task.actions)))
        plan = layers.plan(one.plan)
        yield replace(one, goal=goal, plan=plan, kept=rule.facts, own=own, original=original)


def _keeping_more(candidates: Sequence[Candidate], literals: Literals) -> Iterator[Candidate]:
    """Scenarios of which some keep more."""
    for k, one in enumerate(candidates):
        more = (literal for number, literal in literals if number == k)
        yield replace(one, kept=with_literals(one.kept, more))


def _told(layers: _Layers, answer: Answer) -> Answer:
    """An answer about a task with some layers on it as one about the task itself."""
    plan, steps = answer.human_plan, answer.steps
    if steps is not None:
        actions = layers.back([step.action for step in steps])
        steps = tuple(Step(step.epoch, action) for step, action in zip(steps, actions, strict=True))
    return answer._replace(human_plan=None if plan is None else layers.back(plan), steps=steps)


def _order(answer: Answer) -> tuple[bool, Fraction, Fraction]:
    return not answer.opportunity, answer.objective or Fraction(0), answer.cost or Fraction(0)


# -- what an answer keeps


def _is_known(call: Request, task: Task, answer: Answer | ServedGoal, last: int) -> bool:
    """Whether an answer disturbs the human no more than it may, and they see what they leave their plan for.

    Args:
        task: of the answer.
        last: ``T``.
    """
    most, plan = call.options.max_disturbance, answer.human_plan
    if most is not None and disturbance_of(call, answer) > most:
        return False
    if not call.options.noticed or plan is None:
        return True
    return Noticed(task, plan, call.original or call.task).allows(answer.steps or (), last)


def disturbance_of(call: Request, answer: Answer | ServedGoal) -> Fraction:
    """How much an answer disturbs the human."""
    task = call.task
    weighed = DisturbanceTask(task, disturbance_from(call.options.disturbance), call.original or task)
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
