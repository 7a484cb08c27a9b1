"""Truth of a result's claims, by brute force, which knows neither search nor verifier."""

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, replace
from fractions import Fraction
from itertools import islice
from math import isclose
from typing import Final

from serendipity.model import Condition, HumanPlan, Options, Result, Task, UsageError, surroundings
from serendipity.model.answers.recognition import Recognition
from serendipity.model.numbers import agrees, excess
from serendipity.model.task.gate import is_bound
from serendipity.model.task.plans import PlanEntry
from serendipity.model.task.plans_in_time import cost_alone, times_of
from serendipity_testing.oracle import Alone, Moment, Optimum, best, human_plans
from serendipity_testing.oracle.answers import Solver
from serendipity_testing.oracle.assistance import by_rounds, explore, mean_over_all_policies
from serendipity_testing.oracle.best import shifted
from serendipity_testing.oracle.reactions import best_reaction
from serendipity_testing.oracle.scenarios import best_policy

_FIGURES: Final = ("cost", "objective", "opportunity", "saving", "saving_alone", "human_cost")
_MOST_POLICIES: Final = 400
_MOST_FACTS: Final = 9
_LONGEST_PLAN: Final = 4
_MOST_TIES: Final = 12
"""Limits of brute force: policies and facts of a game, horizon over several goals, the human's plans."""

_ROUNDING: Final = Fraction(1, 10**8)
"""Of means over goals."""

_OVER: Final[Mapping[str, Callable[[list[Fraction]], Fraction]]] = {
    "fixed": min,
    "optimistic": min,
    "robust": max,
    "expected": lambda amounts: sum(amounts, Fraction(0)) / len(amounts),
}
"""Aggregates over the human's optimal plans, by how ties are broken."""


class UnknownTruthError(Exception):
    """Brute force does not say, or would take too long."""


@dataclass(frozen=True, slots=True)
class _Belief:
    """A goal that the human may have, their plan for it, and how probable that is."""

    goal: Condition
    plan: HumanPlan
    weight: Fraction


class Truth:
    """True answers to calls about one task.

    Args:
        recognition: of the goals that the human may have, where there are several.
    """

    def __init__(self, task: Task, recognition: Recognition | None = None) -> None:
        self.task = task
        self.beliefs = [] if recognition is None else _beliefs(task, recognition)
        self._known: dict[object, list[Optimum]] = {}
        self._predictions: dict[object, HumanPlan | None] = {}

    def fault(self, result: Result) -> str | None:
        """A false claim of a result, in words; None if none was found.

        Whether its plan works is not looked at: only what it is said to be worth, and what is said of others.

        Raises:
            UnknownTruthError: brute force can't say.
        """
        answers = self._answers(result)
        if any(answer.cost is None for answer in answers):
            return None if result.status in ("infeasible", "unknown") else "nothing is feasible"
        costs = [answer.cost or Fraction(0) for answer in answers]
        cost = _OVER[result.options.ties](costs)
        if result.status == "infeasible":
            return f"cost {cost} is feasible"
        if result.status == "optimal" and len(answers) == 1:
            return next(self._wrong_figures(result, answers[0]), None)
        if result.status == "optimal" and not agrees(result.cost, cost):
            return f"cost is {cost}, not {result.cost}"
        mean = result.ties is not None and result.options.ties == "expected"
        if result.status == "feasible" and mean and excess(result.cost or 0.0, cost) < 0:
            return f"the mean is {cost}, not {result.cost}"
        least = _OVER[result.options.ties]([_least(result, answer) for answer in answers])
        least += _ROUNDING * max(Fraction(1), least) if self.beliefs else 0
        bound = result.lower_bound
        if result.status != "optimal" and bound is not None and excess(bound, least) > 0:
            return f"lower_bound {bound} is above {least}"
        return None

    def _wrong_figures(self, result: Result, right: Optimum) -> Iterator[str]:
        about_pi_h = result.human_plan is not None or self.beliefs
        for name in _FIGURES if about_pi_h else _FIGURES[:2]:
            true, said = getattr(right, name), getattr(result, name)
            if true is not None and not self._same(said, true):
                yield f"{name} is {true}, not {said}"

    def _same(self, said: float | None, true: Fraction | bool) -> bool:
        """True if a figure is right; means over goals are as exact as the probabilities they rest on."""
        if isinstance(true, bool):
            return said is true
        if self.beliefs and said is not None:
            return isclose(said, true, rel_tol=_ROUNDING, abs_tol=_ROUNDING)
        return agrees(said, true)

    def _answers(self, result: Result) -> list[Optimum]:
        """The answer; beside each of the human's optimal plans where it is over ties."""
        options, given = result.options, result.human_entries
        if result.ties is not None or given == self._entries(self._predicted(options)):
            given = None
        if (options, given) not in self._known:
            early = options.head_start
            plan = None if given is None else self.task.plan_from_names(_earlier(given, early), early)
            try:
                self._known[options, given] = self._solved(options, plan)
            except UsageError as error:
                raise UnknownTruthError from error
        return self._known[options, given]

    def _solved(self, options: Options, plan: HumanPlan | None) -> list[Optimum]:
        if self.beliefs:
            return [self._expected(options)]
        if options.mode == "assistance":
            return [self._assisted(options)]
        if options.human_model != "omniscient":
            return [self._replanned(options, plan)]
        if plan is not None and self.task.robot_goal and is_bound(self.task, options):
            late = shifted(self.task, plan, options.head_start)
            if Solver(self.task, options, late, given=True).improvable:
                raise UnknownTruthError  # where the best answer without the rule keeps it counts first
        plans = [plan]
        if options.ties != "fixed" and options.mode in ("serendipity", "communication") and plan is None:
            if self.task.needs_time:
                return [best(self.task, options)]
            plans = list(islice(human_plans(self.task), _MOST_TIES)) or plans
            if len(plans) == _MOST_TIES:
                raise UnknownTruthError
        return [best(self.task, options.but(ties="fixed"), plan) for plan in plans]

    def _replanned(self, options: Options, plan: HumanPlan | None) -> Optimum:
        optimum = self._predicted(options)
        plan = optimum if plan is None else shifted(self.task, plan, options.head_start)
        unasked = options.ties != "fixed" or options.max_cost not in (None, "human")
        if not plan or not optimum or self.task.robot_goal or unasked:
            raise UnknownTruthError
        alone, least_alone = (cost_alone(self.task, one, options.waiting_cost) for one in (plan, optimum))
        if least_alone < alone:
            raise UnknownTruthError  # what they gain by themselves is theirs
        cost = best_reaction(self.task, options, plan, surroundings(self.task).visible).cost
        least = alone if cost is None else min(cost, alone)
        return Optimum("optimal", least, least, opportunity=least < alone, saving=alone - least)

    def _assisted(self, options: Options) -> Optimum:
        if len(self.task.agents) > 2 or len(self.task.facts) > _MOST_FACTS:
            raise UnknownTruthError
        tree = explore(self.task, fixed=options.ties == "fixed", no_block=bool(options.no_block))
        if options.ties == "expected":
            found = mean_over_all_policies(tree, _MOST_POLICIES)
            if isinstance(found, str):
                raise UnknownTruthError
        else:
            found = by_rounds(tree, max if options.ties == "robust" else min)
        if found is None:
            return Optimum("infeasible")
        worth, total = Alone(self.task).worth(Moment(self.task.init)), found[0] + found[1]
        saving = None if worth is None else worth[0] - found[0]
        return Optimum("optimal", total, total, opportunity=bool(saving), saving=saving)

    def _expected(self, options: Options) -> Optimum:
        horizon = int(options.horizon or max(len(belief.plan) for belief in self.beliefs))
        if horizon > _LONGEST_PLAN:
            raise UnknownTruthError
        if len(self.beliefs) == 1:  # a call like any other: nothing is regretted
            options = options.but(risk="mean")
        found = best_policy(self.task, options, self.beliefs, horizon)
        return Optimum("optimal", found.cost, found.objective, opportunity=found.opportunity)

    def _predicted(self, options: Options) -> HumanPlan | None:
        """Their canonical plan, after its head start."""
        asked = options.waiting_cost, options.head_start, options.strict
        if asked not in self._predictions:
            found = human_plans(self.task, *asked[:2], strict=options.strict)
            self._predictions[asked] = next(found, None)
        return self._predictions[asked]

    def _entries(self, plan: HumanPlan | None) -> tuple[PlanEntry, ...] | None:
        if plan is None:
            return None
        times, names = times_of(self.task, plan), tuple(self.task.actions[i].name for i in plan)
        return names if times.plain else times.entries(names)


def _earlier(entries: tuple[PlanEntry, ...], epochs: int) -> tuple[PlanEntry, ...]:
    """A plan without the waiting before it."""
    return tuple(entry if isinstance(entry, str) else (entry[0] - epochs, entry[1]) for entry in entries)


def _beliefs(task: Task, recognition: Recognition) -> list[_Belief]:
    facts = {name: f for f, name in enumerate(task.facts)}
    found = []
    for goal in recognition.goals:
        if goal.plan is not None and goal.weight:
            wanted = tuple(facts[literal] for literal in goal.goal if literal in facts)
            unwanted = tuple(facts[literal[1:]] for literal in goal.goal if literal not in facts)
            condition = Condition(wanted, unwanted)
            plan = replace(task, goal=condition).plan_from_names(goal.plan)
            found.append(_Belief(condition, plan, goal.weight))
    return found


def _least(result: Result, right: Optimum) -> Fraction:
    """Greatest lower bound of the objective, net of an epoch of the window where none is claimed."""
    weight = result.options.window_weight
    least = (right.cost if right.objective is None else right.objective) or Fraction(0)
    if right.window is not None and not result.opportunity:
        return least - weight
    if right.window is None and result.opportunity and result.options.windowed:
        return least + weight * (result.horizon if isinstance(result.horizon, int) else 0)
    return least
