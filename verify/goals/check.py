"""The claims of an answer for several goals (semantics 8)."""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from fractions import Fraction
from time import perf_counter

from serendipity.model import Claim, Deadline, Result, Task
from verify.base.execution import plan_step
from verify.base.individual import IndividualOptimum
from verify.base.obligations import BY_RULES, needed
from verify.base.optimal_plans import OptimalPlans
from verify.base.undecided import UNDECIDED, UndecidedError, why
from verify.calls.call import Call
from verify.goals.beliefs import considered_plan, faults
from verify.goals.reading import Believed, MalformedError, Recognised, StatedGoal, read
from verify.goals.timelines import (
    Timeline,
    bound_fault,
    close,
    figures_fault,
    mean,
    rule_fault,
    timelines,
    together_fault,
)
from verify.goals.together import Better, Rank, Together
from verify.programs.minimise import Effort
from verify.rules.case import Case
from verify.rules.header import mode_and_human, reason, status_and_fields

_PROVED = {
    "replay": "the posterior is right, and no considered plan is broken",
    "cost": "every expectation is the sum of what it consists of",
    "window": "each goal's prefix, window and suffix are as the mode demands",
    "lower_bound": "it is consistent with status and objective",
}
_ROUNDED = 1 - Fraction(1, 10**9)
"""A bound that was summed from rounded probabilities may be too high by its last digits."""


Certify = Callable[[Task, Result], Sequence[Claim]]
"""Certifies an answer of section 3."""


def check_goals(
    task: Task, result: Result, certify: Certify, deadline: Deadline, effort: Effort | None = None
) -> Iterator[Claim]:
    """Examine an answer for goals that are not known.

    Args:
        task: the task that was asked; its own goal plays no part.
        result: an answer with ``statistics["goals"]``.
        certify: what examines the answer where one goal is left: that is section 3.
        deadline: what is not examined by then stays undecided.
        effort: the solver's settings, under the same deadline; None: rules only, no optimiser.
    """
    started = perf_counter()
    try:
        recognised, served = read(task, result)
        fault = next(faults(task, recognised, deadline), None)
        chosen = _considered(task, recognised, deadline) if fault is None else []
        if fault is None:
            fault = _selection_fault(task, result, recognised, chosen, served)
    except MalformedError as error:
        fault = str(error)
    except UNDECIDED as error:
        yield Claim("replay", "undecided", why(error), seconds=perf_counter() - started)
        others = (name for name in needed(result) if name != "replay")
        yield from (Claim(name, "undecided", f"as 'replay': {why(error)}") for name in others)
        return
    if fault is not None:
        yield Claim("replay", "refuted", fault, seconds=perf_counter() - started)
    elif not chosen:
        fault = _nothing_fault(task, result)
        if fault is not None:
            yield Claim("replay", "refuted", fault)
        else:
            yield Claim("infeasible", "proved", "no goal that is possible can be reached alone")
    elif len(chosen) == 1:
        yield from _certain(task, result, chosen[0], served[0], certify)
    else:
        goals = [believed.goal for believed in chosen]
        yield from _Claims(result, timelines(task, result, goals, served, deadline), effort).claims()


def _considered(task: Task, recognised: Recognised, deadline: Deadline) -> list[Believed]:
    """The goals that are possible and that he can reach, with the plans that are expected of him."""
    seen = recognised.observed if recognised.explained else ()
    planned = [
        replace(goal, plan=considered_plan(task, goal.goal, seen, deadline))
        for goal in recognised.goals
        if goal.posterior
    ]
    return [goal for goal in planned if goal.plan is not None]


def _selection_fault(
    task: Task,
    result: Result,
    recognised: Recognised,
    chosen: Sequence[Believed],
    served: Sequence[StatedGoal],
) -> str | None:
    """Whether the goals considered, their plans and probabilities follow from the posterior."""
    if [entry.name for entry in served] != [goal.name for goal in chosen]:
        return f"the goals to consider are {', '.join(goal.name for goal in chosen) or 'none'}"
    if not chosen:
        return (
            None if result.status == "infeasible" and result.plan is None else "no goal can be reached alone"
        )
    total = sum(goal.posterior for goal in chosen)
    for goal, entry in zip(chosen, served, strict=True):
        if not close(entry.probability, Fraction(goal.posterior / total)):
            return f"goal '{goal.name}': the probability is {goal.posterior / total:.12g}"
        if len(chosen) > 1 and entry.human_plan != goal.plan:
            return f"goal '{goal.name}': human_plan is not the canonical plan that explains the observations"
    if len(chosen) > 1:
        return _header_fault(task, result, chosen)
    seen = recognised.observed and recognised.explained
    if seen and result.human_plan != chosen[0].plan:
        return f"goal '{chosen[0].name}': pi_H is not the canonical plan that explains the observations"
    return None


def _header_fault(task: Task, result: Result, chosen: Sequence[Believed]) -> str | None:
    options = result.options
    if (result.mode, options.mode) != ("serendipity", "serendipity"):
        return "goals that are not known are for mode serendipity"
    if (options.ties, options.human_model, options.max_cost) != (
        "fixed",
        "omniscient",
        None,
    ) or task.robot_goal:
        return "ties, human models, max_cost and robots' goals are for a single goal"
    if result.status not in ("optimal", "feasible") or result.plan is None:
        return "leaving the human alone is always an answer"
    longest = max(len(goal.plan or ()) for goal in chosen)
    expected = longest if options.horizon is None else options.horizon
    if result.horizon != expected or longest > int(expected):
        return f"the horizon is {expected}, at least {longest}; the answer says {result.horizon}"
    if result.reason is not None:
        return f"status {result.status} with a reason"
    if result.window is not None or result.human_plan is not None or result.realised:
        return "windows, plans and verdicts belong to single goals"
    return None


def _nothing_fault(task: Task, result: Result) -> str | None:
    """Whether an answer that says that there is no plan says more than that."""
    own = (result.human_plan, result.human_cost, result.lower_bound, result.horizon)
    if own != (None, None, None, None):
        return "infeasible, with a plan, a cost, a bound or a horizon"
    case = Case(task, result, IndividualOptimum(task))
    found = mode_and_human(case) or status_and_fields(case) or reason(case)
    return None if found is None else found.message


def _certain(
    task: Task, result: Result, goal: Believed, entry: StatedGoal, certify: Certify
) -> Iterator[Claim]:
    """One goal is left: the answer is one of section 3."""
    same = (entry.human_plan, entry.cost, entry.window, entry.plan)
    if same != (result.human_plan, result.cost, result.window, result.plan):
        yield Claim("replay", "refuted", f"goal '{goal.name}': the entry is not the answer")
        return
    left = {k: v for k, v in result.statistics.items() if k not in ("goals", "recognition")}
    yield from certify(replace(task, goal=goal.goal), replace(result, statistics=left))


class _Claims:
    def __init__(self, result: Result, lines: Sequence[Timeline], effort: Effort | None) -> None:
        self.result = result
        self.lines = lines
        self.effort = effort

    def claims(self) -> Iterator[Claim]:
        """All claims, in order; what rules refute is not handed to an optimiser."""
        refuted: set[str] = set()
        unknown: str | None = None
        for name, fault in self._rules():
            if name in ("cost", "window") and "replay" in refuted:
                yield Claim(name, "not_in_scope", "the plans can't be replayed")
                continue
            claim = self._by_rules(name, fault, unknown)
            if claim.verdict == "refuted":
                refuted.add(name)
            if claim.verdict == "undecided" and name == "replay":
                unknown = claim.reason
            if claim.verdict != "proved" or name != "lower_bound":
                yield claim
        wanted = [name for name in needed(self.result) if name not in BY_RULES]
        out = "the answer breaks a rule already" if refuted else None
        if out is None and self.effort is None:
            out = "not examined: the rules alone can't prove it"
        if out is not None:
            yield from (Claim(name, "not_in_scope", out) for name in wanted if name not in refuted)
        elif unknown is not None:
            yield from (Claim(name, "undecided", f"as 'replay': {unknown}") for name in wanted)
        else:
            yield from self._solved(wanted)

    def _by_rules(self, name: str, fault: Callable[[], str | None], unknown: str | None) -> Claim:
        """One claim of the rules; what depends on plans that were not replayed stays undecided."""
        started = perf_counter()
        try:
            if unknown is not None:
                raise UndecidedError(f"as 'replay': {unknown}")
            found = fault()
        except UNDECIDED as error:
            verdict, reason = "undecided", why(error)
        else:
            verdict = "proved" if found is None else "refuted"
            reason = found or _PROVED[name]
        return Claim(name, verdict, reason, seconds=perf_counter() - started)

    def _rules(self) -> Iterator[tuple[str, Callable[[], str | None]]]:
        lines, result = self.lines, self.result
        yield "replay", lambda: rule_fault("replay", lines) or together_fault(result, lines)
        yield "cost", lambda: rule_fault("cost", lines) or figures_fault(result, lines)
        yield "window", lambda: rule_fault("window", lines)
        yield "lower_bound", lambda: bound_fault(result)

    def _solved(self, wanted: Sequence[str]) -> Iterator[Claim]:
        started = perf_counter()
        better: Better | None = None
        try:
            together = self._together()
            idle = together.idle()
            fault = self._idle_fault(idle[1])
            if fault is not None:
                yield Claim("cost", "refuted", fault, seconds=perf_counter() - started)
                return
            verdict, reason, better = self._best(together, idle)
        except UNDECIDED as error:
            verdict, reason = "undecided", why(error)
        bound = self.result.lower_bound if verdict == "proved" else None
        task, discount = self.lines[0].task, self.result.options.discount
        example = None if better is None else tuple(plan_step(task, s, discount) for s in better.robots)
        yield Claim(wanted[0], verdict, reason, example, perf_counter() - started, bound)
        for name in wanted[1:]:
            yield Claim(name, verdict, f"as '{wanted[0]}': {reason}", example, bound=bound)

    def _best(self, together: Together, idle: Rank) -> tuple[str, str, Better | None]:
        """Whether robots could do better than the answer says they can."""
        limit = self._limit(idle)
        if together.floor() >= limit:
            return "proved", "the best answers to each goal by itself add up to it", None
        better = together.better(limit)
        denied = self.result.status == "optimal" and not self.result.opportunity
        if better is None or (denied and better.rank[1] >= idle[1]):
            return "proved", "everything that robots can do was played beside all goals", None
        objective, cost = map(float, better.rank)
        words = f"better for all goals: expected cost {cost:.12g}, objective {objective:.12g}"
        return "refuted", words, better

    def _limit(self, idle: Rank) -> Rank:
        """What no robots' plan ranks before, if the answer is right."""
        result, window = self.result, self.result.options.window_weight
        assert result.lower_bound is not None, "a rule"
        if result.status != "optimal":  # without an opportunity it is net of the one epoch of every window
            epochs = 0 if result.opportunity else 1
            return Fraction(result.lower_bound) * _ROUNDED + window * epochs, Fraction(-1)
        if not result.opportunity:
            return idle
        cost = mean(self.lines, [line.case.cost for line in self.lines])
        return cost + window * mean(self.lines, [Fraction(line.epochs) for line in self.lines]), cost

    def _together(self) -> Together:
        assert self.effort is not None, "without an optimiser nothing is solved"
        options = self.result.options.but(horizon=self.result.horizon, time_limit=None)
        calls = []
        for line in self.lines:
            plans = OptimalPlans(line.task, line.case.alone)
            calls.append(Call(line.task, options, line.case.pi_h, plans, self.effort))
        return Together(calls, [line.weight for line in self.lines])

    def _idle_fault(self, idle: Fraction) -> str | None:
        """What he gains by himself, where observations make his plans dearer than need be."""
        said, alone = self.result.saving_alone, mean(self.lines, [line.alone for line in self.lines])
        if said is None or not close(said, alone - idle):
            return f"saving_alone is {float(alone - idle):.12g}, the answer says {said}"
        if self.result.opportunity and mean(self.lines, [line.case.cost for line in self.lines]) >= idle:
            return f"the plan costs no less than {float(idle):.12g}, robots idle"
        return None
