"""A maker of false results: answers to other tasks and calls, fitted to the one that was asked."""

from collections.abc import Iterator
from contextlib import suppress
from dataclasses import dataclass, fields, replace
from fractions import Fraction
from random import Random
from typing import Any, Final

from serendipity.facade.planning import plan
from serendipity.model import Condition, Options, PlanStep, Result, SerendipityError, Task
from serendipity.model.keywords import CHOICES
from serendipity.model.task.plans import PlanEntry
from serendipity_testing.by_hand import result as by_hand
from serendipity_testing.crosscheck.doctored import doctored, without_plan
from serendipity_testing.crosscheck.other_tasks import CHANGES, IN_TIME, TRIFLES
from serendipity_testing.generator.calls import PlanCall, random_options
from serendipity_testing.generator.human_plans import plan_after_detour
from serendipity_testing.oracle.truth import Truth, UnknownTruthError

_GAMES, _GOALS = 0.1, 0.05
"""Shares of calls about silent assistance, and about goals that are not known."""

_DISCOUNTS: Final = ("0", "0.25", "1/3", "0.6", "0.9", "1")


@dataclass(frozen=True, slots=True)
class Forgery:
    """A result that claims what is not so.

    Attributes:
        kind: where it is from.
        task: the task that it is presented with.
        result: the result.
        fault: what is not so.
        source: the task and the answer that it was made from, where that is right of another call.
    """

    kind: str
    task: Task
    result: Result
    fault: str
    source: tuple[Task, Result] | None = None


@dataclass(frozen=True, slots=True)
class _Asked:
    """A call, perhaps about goals that are not known."""

    call: PlanCall
    goals: tuple[dict[str, Any], ...] | None = None

    def answer(self) -> Result:
        call = self.call
        return plan(call.task, human_plan=call.human_plan, goals=self.goals, **call.keywords())

    def but(self, **options: str) -> "_Asked":
        """The same with some options changed."""
        return replace(self, call=replace(self.call, options=self.call.options | options))

    def about(self, task: Task, human_plan: tuple[PlanEntry, ...] | None = None) -> "_Asked":
        """The same about another task, or another plan of the human's."""
        return replace(self, call=replace(self.call, task=task, human_plan=human_plan))


def forgeries(call: PlanCall, dice: Random) -> Iterator[Forgery]:
    """False results for a call, or for one about its task in another mode."""
    asked = _asked(call, dice)
    try:
        right = asked.answer()
    except SerendipityError:
        return
    truth = Truth(asked.call.task, right.recognition)
    for kind, source, result in _Forger(asked, right, dice).results():
        with suppress(UnknownTruthError, SerendipityError):
            fault = truth.fault(result)
            if fault is not None:
                yield Forgery(kind, asked.call.task, result, fault, source)


def _asked(call: PlanCall, dice: Random) -> _Asked:
    share, task = dice.random(), replace(call.task, robot_goal=Condition())
    if task.needs_time:
        return _Asked(call)
    if share < _GAMES:
        options = {
            "mode": "assistance",
            "ties": dice.choice([ties for ties in CHOICES["ties"] if ties != "watched"]),
            "no_block": dice.choice(("true", "false")),
        }
        actions = tuple(action for action in task.actions if max(action.participants) < 2)
        return _Asked(PlanCall(replace(task, agents=task.agents[:2], actions=actions), options))
    if share < _GAMES + _GOALS:
        options = {
            name: value for name, value in call.options.items() if name in ("discount", "window_weight")
        } | {name: dice.choice(CHOICES[name]) for name in ("policy", "risk")}
        fact = dice.randrange(len(task.facts))
        prior = dice.choice((Fraction(1, 2), Fraction(1, 3), Fraction(9, 10)))
        own = [*task.goal.literals(task.facts)]
        other = f"!{task.facts[fact]}" if fact in task.init else task.facts[fact]
        goals = {"own": (own, prior), other: ([other], 1 - prior)}
        given = tuple({"name": name, "goal": goal, "prior": str(p)} for name, (goal, p) in goals.items())
        return _Asked(PlanCall(task, options), given)
    return _Asked(call)


class _Forger:
    """Makes results that may be false.

    Args:
        asked: the call that they are presented for.
        right: its answer.
    """

    def __init__(self, asked: _Asked, right: Result, dice: Random) -> None:
        self.asked, self.right, self.dice = asked, right, dice
        self.task = asked.call.task

    def results(self) -> Iterator[tuple[str, tuple[Task, Result] | None, Result]]:
        """Kind, what it was made from, and the result."""
        for kind, other in self._others():
            try:
                answer = other.answer()
            except SerendipityError:
                continue
            for made in self._fitted(answer):
                source = other.call.task, answer
                yield kind, source, made
                less = without_plan(made, "unknown", "time-limit", made.objective)
                yield kind, source, replace(made, status="feasible") if self.dice.random() < 0.5 else less
        for kind, made in doctored(self.right, self._denied(), self.dice):
            yield kind, None, made

    def _others(self) -> Iterator[tuple[str, _Asked]]:
        """Other tasks, and other calls."""
        for kind, change in 2 * [*CHANGES.items(), *(IN_TIME.items() if self.task.needs_time else ())]:
            with suppress(SerendipityError):  # two things at once, perhaps
                yield kind, self.asked.about(change(self.dice, self.task, self.right))
        for kind, options in self._other_options():
            yield kind, self.asked.but(**options)
        for entries in self._other_plans():
            yield "another plan of the human's", self.asked.about(self.task, entries)

    def _other_plans(self) -> Iterator[tuple[PlanEntry, ...]]:
        times, late = self.right.human_plan_times, self.right.options.head_start
        if not self.task.needs_time:
            given = plan_after_detour(self.dice, self.task)
            if given is not None:
                yield tuple(self.task.actions[i].name for i in given)
        elif times is not None and times.starts:
            first = self.dice.randrange(len(times.starts))
            starts = [start - late + (number >= first) for number, start in enumerate(times.starts)]
            yield tuple(zip(starts, self.right.human_plan or (), strict=True))

    def _other_options(self) -> Iterator[tuple[str, dict[str, str]]]:
        dice, right = self.dice, self.right
        discount = min(Fraction(1), self._near("discount"))
        yield "another discount", {"discount": str(discount)}
        yield "another discount", {"discount": dice.choice(_DISCOUNTS)}
        for name in ("window_weight", "communication_weight"):
            yield "another K", {name: str(self._near(name))}
            yield "another K", {name: dice.choice(("0", "1", "1000", "1000000000"))}
        if self.task.needs_time:
            yield "another head start", {"head_start": str(dice.randint(0, 2))}
            yield "another price of waiting", {"waiting_cost": dice.choice(("0", "0.5", "1", "2"))}
        if isinstance(right.horizon, int):
            for more in (-1, 1, 2):
                yield "another horizon", {"horizon": str(max(0, right.horizon + more))}
        for name, value in dice.sample([*random_options(dice).items()], 2):
            yield "other options", {name: value}
        for ties in CHOICES["ties"] if right.options.ties != "fixed" else ():
            yield "other ties", {"ties": ties}

    def _near(self, name: str) -> Fraction:
        changed = getattr(self.right.options, name) + self.dice.choice((-1, 1)) * self.dice.choice(TRIFLES)
        return abs(Fraction(changed))

    def _fitted(self, answer: Result) -> Iterator[Result]:
        """An answer under the call's own header: with its figures as they are, and worked out anew."""
        right = self.right
        if answer.status == "infeasible":
            yield without_plan(right, "infeasible", answer.reason)
            return
        about_pi_h = ("human_plan", "human_plan_times", "human_cost", "saving_alone")
        plain = self._headed(answer, "mode", "human", "options", "horizon", "recognition", "bystanders")
        if right.mode == "assistance":
            yield replace(self._headed(plain, *about_pi_h[:3]), plan=None, window=None)
            return
        if right.goals is not None:
            yield from self._goals_fitted(plain)
            return
        yield plain
        yield self._headed(plain, *about_pi_h)
        for human_plan in {answer.human_entries, right.human_entries}:
            with suppress(SerendipityError, KeyError):
                yield self._worked_out(answer, human_plan)

    def _headed(self, answer: Result, *names: str) -> Result:
        """An answer with some fields of the right one."""
        return replace(answer, **{name: getattr(self.right, name) for name in names})

    def _worked_out(self, answer: Result, human_plan: tuple[PlanEntry, ...] | None) -> Result:
        """An answer's plan, with what it costs here.

        Raises:
            SerendipityError: the human's plan is none here.
            KeyError: an action of the plan is none here.
        """
        right, options = self.right, self.right.options
        self.task.plan_from_names(human_plan or ())
        steps: dict[int, str] = {}
        for step in answer.plan or ():
            steps[step.epoch] = f"{steps[step.epoch]}; {step.action}" if step.epoch in steps else step.action
        window = answer.window if options.windowed else None
        given = {each.name: getattr(options, each.name) for each in fields(Options)}
        span = None if window is None else (window.start, window.end)
        made = by_hand(self.task, steps, human_plan=human_plan, window=span, **given)
        helps = made.opportunity and (window is not None or not options.windowed or bool(right.realised))
        same = human_plan == right.human_entries
        return replace(
            made,
            horizon=right.horizon if same else answer.horizon,
            opportunity=helps,
            saving=made.saving if helps or made.saving is None else 0.0,
            saving_alone=right.saving_alone if same else made.saving_alone,
            ties=answer.ties or right.ties,
            optimal_plans=answer.optimal_plans or right.optimal_plans,
            realised=answer.realised,
            bystanders=right.bystanders,
        )

    def _denied(self) -> Result | None:
        """Doing nothing, said to be the best."""
        right = self.right
        if right.human_plan is None or right.plan is None or right.goals is not None:
            return None
        times = right.human_plan_times
        starts = range(1, len(right.human_plan) + 1) if times is None else times.starts
        begun = zip(starts, right.human_plan, strict=True)
        steps = tuple(PlanStep(t, (right.human,), name, 0.0) for t, name in begun)
        made = self._worked_out(replace(right, plan=steps, window=None), right.human_entries)
        realised = dict.fromkeys(right.realised, True)
        return replace(made, opportunity=False, saving=0.0, realised=realised)

    def _goals_fitted(self, plain: Result) -> Iterator[Result]:
        """An answer for several goals, with the right probabilities, and the mean that follows from them."""
        said, right = plain.goals or (), self.right.goals or ()
        yield plain
        if len(said) == len(right):
            goals = tuple(replace(a, probability=b.probability) for a, b in zip(said, right, strict=True))
            cost = sum(goal.probability * (goal.cost or 0) for goal in goals)
            yield replace(plain, goals=goals, cost=cost)
            yield replace(plain, goals=goals, cost=cost, objective=cost, lower_bound=cost)
