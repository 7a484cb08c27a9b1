"""A result in time as one in single epochs, which is what all methods look at (semantics 10).

The plan is played twice: as the text says, by durations and script, and in single epochs, by the rules.  The
tasks in single epochs are the planner's, too; that they say what section 10 does is held by plans that are
played twice, and by the brute force of the tests, which knows of no such task.
"""

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import replace
from fractions import Fraction
from itertools import chain

from serendipity.model import Claim, Condition, Deadline, HumanPlan, PlanError, PlanStep, Result, Task
from serendipity.model.answers.result_parts import GoalAnswer, TiedAnswer
from serendipity.model.numbers import agrees
from serendipity.model.task.actions import GroundAction
from serendipity.model.task.course import BrokenPlanError, PlayedPlan
from serendipity.model.task.plans import Step
from serendipity.model.task.plans_in_time import times_of
from serendipity.model.task.unit_steps import UnitSteps, unit_steps
from verify.base import wording
from verify.base.execution import (
    State,
    applicable,
    executed,
    grouped,
    is_calm,
    meant_by,
    met,
    plan_step,
    price,
)
from verify.base.obligations import kind_of, needed
from verify.base.undecided import UNDECIDED, why
from verify.rules.replay import meant
from verify.rules.report import Violation

_TEXT = "10.1"


def examined_in_time(
    task: Task, result: Result, deadline: Deadline, examine: Callable[[Task, Result], tuple[Claim, ...]]
) -> tuple[Claim, ...]:
    """The claims of a result in time.

    Args:
        result: the result, of checked types.
        examine: makes the claims of a task and a result in single epochs.
    """
    if not _is_known(result):
        return tuple(Claim(name, "undecided", wording.NOT_IN_TIME) for name in needed(result))
    try:
        epochs = SingleEpochs(task, result, deadline)
        if epochs.fault is not None:
            return (Claim(epochs.fault.claim, "refuted", str(epochs.fault)),)
        said = epochs.result()
    except UNDECIDED as error:
        return tuple(Claim(name, "undecided", why(error)) for name in needed(result))
    return tuple(map(epochs.told, examine(epochs.task, said)))


def _is_known(result: Result) -> bool:
    """Whether such a result is examined in time."""
    options = result.options
    one = kind_of(result) != "a plan for each scenario"
    return one or (options.suffix, options.preservation) == ("replan", "kernel")


class SingleEpochs:
    """A task in time and a result for it, in single epochs.

    Args:
        result: the result, of checked types.

    Attributes:
        units: the task in single epochs, and what it has to do with the one in time.
        fault: what is wrong with the plan as the text has it, or None.
    """

    def __init__(self, task: Task, result: Result, deadline: Deadline) -> None:
        self._original, self._result, self._deadline = task, result, deadline
        self.units: UnitSteps = unit_steps(task, deadline, result.options.waiting_cost)
        self._aimless = task.with_goal(Condition())
        self._several = kind_of(result) == "a plan for each scenario"
        self.fault = self._mistold() or self._played()

    @property
    def task(self) -> Task:
        """The task in single epochs."""
        return self.units.task

    def result(self) -> Result:
        """The result in single epochs: its plan with all that is due, or that of each scenario."""
        said, known = self._result, self._result.recognition
        if known is not None:
            aimed = tuple(replace(goal, goal=(*goal.goal, *self._at_rest)) for goal in known.goals)
            known = replace(known, goals=aimed)
        return replace(
            said,
            human_plan=self._names_of(said),
            human_plan_times=None,
            ties=None if said.ties is None else tuple(map(self._tied, said.ties)),
            bystanders={},
            plan=self._begun_alone(said.plan) if self._several else self._steps(said.plan),
            agent_costs=self._agent_costs(),
            goals=None if said.goals is None else tuple(map(self._served, said.goals)),
            recognition=known,
        )

    @property
    def _at_rest(self) -> tuple[str, ...]:
        """What the human's goals ask for in single epochs besides."""
        asked, task = set(self._original.goal.positive), self.task
        return tuple(task.facts[fact] for fact in task.goal.positive if fact not in asked)

    def _served(self, said: GoalAnswer) -> GoalAnswer:
        goal = None if said.goal is None else (*said.goal, *self._at_rest)
        steps, names = self._steps(said.plan), self._names_of(said)
        return replace(said, human_plan=names, human_plan_times=None, plan=steps, goal=goal)

    def _tied(self, said: TiedAnswer) -> TiedAnswer:
        names, plan = self._names_of(said) or (), self._steps(said.plan)
        return replace(said, human_plan=names, human_plan_times=None, plan=plan)

    def told(self, claim: Claim) -> Claim:
        """A claim whose counter-example is a plan of the task in time."""
        if claim.counterexample is None:
            return claim
        discount = self._result.options.discount
        return replace(claim, counterexample=begun_steps(self._original, claim.counterexample, discount))

    def _agent_costs(self) -> dict[str, float]:
        """What each agent pays; the clock nothing."""
        clock, said = self.task.agents[len(self._original.agents) :], self._result.agent_costs
        return {**said, **dict.fromkeys(clock, 0.0)} if said else said

    # -- the text

    def _mistold(self) -> Violation | None:
        """What the result says of times and of bystanders, and is not so."""
        answer = self._result
        every: list[Result | GoalAnswer | TiedAnswer] = [answer, *(answer.goals or ()), *(answer.ties or ())]
        for said in every:
            plan = self._plan_of(said)
            times = None if plan is None else times_of(self._original, plan)
            if None not in (times, said.human_plan_times) and said.human_plan_times != times:
                return Violation("times", "replay", "10.2", "the times of pi_H are not those of its actions")
            if plan and self._original.starts_of(plan)[0] <= self._result.options.head_start:
                return Violation("times", "replay", "10.2", "pi_H begins before its head start is over")
        if self._result.bystanders != bystanders_of(self._original):
            return Violation("bystanders", "replay", "10.3", "bystanders don't do what the script says")
        return None

    def _played(self) -> Violation | None:
        """The first step that can't be done when a plan says, durations and script beside it."""
        said = self._result
        plans = [goal.plan or () for goal in said.goals or ()] if self._several else [said.plan or ()]
        faults = (self._misnamed(step) for plan in (*plans, said.plan or ()) for step in plan)
        return next(filter(None, chain(faults, map(self._unplayable, plans))), None)

    def _unplayable(self, plan: Sequence[PlanStep]) -> Violation | None:
        task, by_epoch = self._original, grouped((step.epoch, step) for step in plan)
        course = PlayedPlan(task.facts, task.init, task.script, strict=self._result.options.strict)
        last = max(by_epoch, default=0)
        while course.epoch < last:
            self._deadline.check()
            try:
                course.begin(self._meant(step, course.state) for step in by_epoch.get(course.epoch + 1, ()))
            except BrokenPlanError as error:
                return Violation("in-time", "replay", _TEXT, error.reason, course.epoch, error.action.name)
        return None

    def _misnamed(self, step: PlanStep) -> Violation | None:
        task, place = self._original, (step.epoch, step.action)
        ids, fault = meant(task, step)
        if fault is not None:
            return Violation(fault.rule, "replay", _TEXT, fault.message, *place)
        action = task.actions[ids[0]]
        if step.duration != action.duration:
            words = f"it takes {action.duration} epochs, not {step.duration}"
            return Violation("duration", "replay", _TEXT, words, *place)
        cost = price(task, action, self._result.options.discount)
        if not agrees(step.cost, cost):
            words = f"costs {float(cost):g}, the result says {step.cost:g}"
            return Violation("step-cost", "cost", "1", words, *place)
        return None

    def _meant(self, step: PlanStep, state: State) -> GroundAction:
        actions = [self._original.actions[i] for i in meant_by(self._original, step.action, step.agents)]
        return next((action for action in actions if applicable(action, state)), actions[0])

    # -- single epochs

    def _plan_of(self, said: Result | TiedAnswer | GoalAnswer) -> HumanPlan | None:
        """``pi_H``; None where there is none, or it is none of the human's."""
        names, times = said.human_plan, said.human_plan_times
        try:
            entries = names if times is None or names is None else times.entries(names)
            return None if entries is None else self._aimless.plan_from_names(entries)
        except PlanError:
            return None

    def _names_of(self, said: Result | TiedAnswer | GoalAnswer) -> tuple[str, ...] | None:
        """``pi_H`` by the names of single epochs; as it is where it is none of the human's."""
        plan = self._plan_of(said)
        if plan is None:
            return said.human_plan
        return tuple(self.task.actions[i].name for i in self.units.plan(plan))

    def _begun_alone(self, plan: Sequence[PlanStep] | None) -> tuple[PlanStep, ...]:
        """What robots begin by themselves in all scenarios."""
        steps = (Step(step.epoch, self._first(step, self.task.init)) for step in plan or ())
        return tuple(plan_step(self.task, step, self._result.options.discount) for step in steps)

    def _steps(self, plan: Sequence[PlanStep] | None) -> tuple[PlanStep, ...] | None:
        return None if plan is None else tuple(self._with_due(plan))

    def _with_due(self, plan: Sequence[PlanStep]) -> Iterator[PlanStep]:
        """A plan with all that is due, up to ``T``; as it is from where on it can't be executed."""
        task, said = self.task, self._result
        left = sorted(plan, key=lambda step: step.epoch)
        last = said.horizon if isinstance(said.horizon, int) else None
        state: State | None = task.init
        human = task.agents[task.human]
        begun = max((step.epoch for step in left if human in step.agents), default=0)
        epoch = 0
        while state is not None and (left or self._goes_on(epoch, last, state)):
            self._deadline.check()
            epoch += 1
            here = [step for step in left if step.epoch <= epoch]
            left = left[len(here) :]
            chosen = met(task, state, [self._first(step, state) for step in here])
            busy = any(task.human in task.actions[i].participants for i in chosen)
            if said.options.waiting_cost and epoch < begun and not busy:
                chosen = (*chosen, self.units.waiting)
            for i in chosen:
                yield plan_step(task, Step(epoch, i), said.options.discount)
            state = executed(state, [task.actions[i] for i in chosen], strict=said.options.strict)
        yield from left

    def _goes_on(self, epoch: int, last: int | None, state: State) -> bool:
        """Whether something may still happen by itself.

        Without ``T``, and beside who replans, a plan ends once goals are reached.
        """
        task, options = self.task, self._result.options
        replans = options.human_model != "omniscient" and epoch >= options.head_start
        if last is None or replans or self._result.mode == "individual":
            theirs = self._result.mode == "individual" or task.robot_goal.holds(state)
            if task.goal.holds(state) and theirs and state.issuperset(task.at_rest):
                return False
        return (last is None or epoch < last) and not is_calm(task, state)

    def _first(self, step: PlanStep, state: State) -> int:
        """The action in single epochs with which a step begins."""
        task, ids = self.task, meant_by(self._original, step.action, step.agents)
        begins = [self.units.chains[i][0] for i in ids]
        return next((i for i in begins if applicable(task.actions[i], state)), begins[0])


def bystanders_of(task: Task) -> dict[str, tuple[PlanStep, ...]]:
    """What bystanders do, by name; it costs nobody anything."""
    script = task.script
    found: dict[str, list[PlanStep]] = {task.agents[i]: [] for i in sorted(script.people)}
    for deed in script.deeds:
        if deed.agent in script.people:
            who = task.agents[deed.agent]
            found[who].append(PlanStep(deed.epoch, (who,), deed.name, 0.0, deed.end - deed.epoch + 1))
    return {who: tuple(steps) for who, steps in found.items()}


def begun_steps(task: Task, steps: Iterable[PlanStep], discount: Fraction) -> tuple[PlanStep, ...]:
    """Those of some steps in single epochs with which an action of a task in time begins, as steps of it."""
    begun = [(step, meant_by(task, step.action, step.agents)[:1]) for step in steps]
    return tuple(
        replace(plan_step(task, Step(step.epoch, action), discount), duration=task.actions[action].duration)
        for step, meant in begun
        for action in meant
    )
