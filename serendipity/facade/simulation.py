"""The facade over the simulator: a plan played against a human who replans (semantics 6)."""

from collections.abc import Iterator
from fractions import Fraction
from typing import Final, Literal

from search import PreparedTask
from search.modes.simulation import simulate as play
from serendipity.facade.prepared import HELD
from serendipity.facade.results import named_steps
from serendipity.model import Deadline, HumanPlan, Options, PlanStep, Result, Step, Task, Visible
from serendipity.model.answers.over_scenarios import task_of
from serendipity.model.answers.simulation import SimulatedEpoch, Simulation
from serendipity.model.answers.trace import WHY, Trace, TraceEpoch, TraceSkip
from serendipity.model.arguments import FUNCTION, RESULT_IN_TIME, TASK_IN_TIME, expect, expect_or_none
from serendipity.model.errors import LIMITS, InputError, UsageError
from serendipity.model.keywords import Horizon, require_one_of
from serendipity.model.numbers import plain, rounded
from serendipity.model.resources.limits import limits_from
from serendipity.model.task.execution import actions_named, participants

Replanning = Literal["observant", "local"]
HUMAN_MODELS: Final[tuple[Replanning, ...]] = ("observant", "local")
"""Models of a human who replans."""


def simulate(
    task: Task,
    result: Result,
    human_model: Replanning = "observant",
    *,
    visible: Visible | None = None,
    time_limit: float | None = None,
    memory_limit: float | None = None,
    deadline: Deadline | None = None,
) -> Trace:
    """Play a result's plan against a human who looks up in each epoch and replans.

    Args:
        task: the task that was asked.
        result: the answer, from :func:`serendipity.plan` or read from JSON.
        human_model: ``observant`` (they see everything) or ``local`` (what is where they are).
        visible: ``visible(agent, fact, state)`` says what a local human sees, by ids of the
            task; None for the default of ``docs/semantics.md``, section 6.
        time_limit: seconds, or None; the epochs played by then are told, as far as they go.
        memory_limit: what the process may have in memory, in MiB, or None.
        deadline: one that other work shares; it holds beside both limits.

    Raises:
        UsageError: there is no such human model, or a limit is wrong.
        InputError: the result has no plan, is for another task, or over several goals or plans.
        LimitReachedError: a limit came before the first epoch was over.
    """
    limits = limits_from(time_limit, memory_limit, deadline)
    expect(TASK_IN_TIME, task=task)
    expect(RESULT_IN_TIME, result=result)
    expect_or_none(FUNCTION, visible=visible)
    require_one_of("human_model", human_model, HUMAN_MODELS)
    if result.plan is None or result.cost is None:
        raise InputError("result: has no plan to simulate")
    if result.human != task.agents[task.human]:
        raise InputError(f"result: is for another task: its human is '{result.human}'")
    if len(result.goals or ()) > 1:
        raise InputError("result: is over several goals or plans; simulate plays an answer to one of them")
    task = task_of(task, result)
    horizon = result.horizon if isinstance(result.horizon, int) else None
    steps = [Step(step.epoch, _action(task, step)) for step in result.plan]
    if task.needs_time or result.in_time:
        from serendipity.facade.person.played import (
            played_in_time,  # it plans, and plans say what is realised
        )

        if visible is not None:
            raise UsageError("visible: is not known where actions take time")
        entries = result.human_entries or ()
        local = human_model == "local"
        simulated = played_in_time(
            task, result.options, entries, steps, horizon=horizon, deadline=limits, local=local
        )
        return _Story(task, result, human_model, simulated).trace()
    plan = task.plan_from_names(result.human_plan) if result.human_plan else ()
    with HELD.taken(task) as prepared:
        simulated = play(
            prepared,
            result.options,
            plan,
            steps,
            human_model=human_model,
            horizon=horizon,
            visible=visible,
            deadline=limits,
        )
    return _Story(task, result, human_model, simulated).trace()


def realised(
    prepared: PreparedTask,
    options: Options,
    human_plan: HumanPlan,
    steps: tuple[Step, ...],
    *,
    cost: Fraction,
    horizon: Horizon | None,
    visible: Visible | None = None,
    deadline: Deadline,
) -> dict[str, bool]:
    """The verdicts that a result carries: always ``observant``, ``local`` if it was planned for.

    Those that the deadline leaves no time for are missing.

    Args:
        human_plan: ``pi_H`` by ids.
        steps: the plan of the answer.
        cost: its exact cost.
        horizon: ``T``, ``"inf"`` or None.
        visible: what a local human sees; None for the default.
    """
    models = ("observant",) if options.human_model != "local" else HUMAN_MODELS
    epochs = horizon if isinstance(horizon, int) else None
    verdicts: dict[str, bool] = {}
    for model in models:
        try:
            deadline.check()  # what comes first can't be interrupted, and takes milliseconds on big tasks
            simulated = play(
                prepared,
                options,
                human_plan,
                steps,
                human_model=model,
                horizon=epochs,
                visible=visible,
                deadline=deadline,
            )
        except LIMITS:
            break
        verdict = simulated.realised(cost)
        if verdict is None:
            break
        verdicts[model] = verdict
    return verdicts


def _action(task: Task, step: PlanStep) -> int:
    """The action that a step of a result names; of several with one name any will do."""
    found = actions_named(task, step.action, step.agents)
    if not found:
        who = ", ".join(sorted(step.agents))
        raise InputError(f"result: is for another task: this one has no action '{step.action}' of {who}")
    return found[0]


class _Story:
    """Turns ids into names and numbers into words."""

    def __init__(self, task: Task, result: Result, human_model: str, simulated: Simulation) -> None:
        assert result.cost is not None, "a result with a plan has a cost"
        self.task = task
        self.discount = result.options.discount
        self.human_model = human_model
        self.simulated = simulated
        self.promised = result.cost
        self.his_steps = {
            step.epoch: step.action for step in result.plan or () if result.human in step.agents
        }
        # Rounding keeps the order, so a plan that costs no more never seems to.
        self.cost = float(simulated.cost)

    def trace(self) -> Trace:
        reason, limit = self._reason(), self.simulated.limit
        return Trace(
            human=self.task.agents[self.task.human],
            human_model=self.human_model,
            realised=False if reason is not None else True if limit is None else None,
            reason=reason,
            goals_hold=self.simulated.goals_hold if limit is None else None,
            promised_cost=self.promised,
            cost=self.cost,
            epochs=tuple(self._epochs()),
            limit=limit,
        )

    def _reason(self) -> str | None:
        for epoch in self.simulated.epochs:
            for skip in epoch.skipped:
                return f"epoch {epoch.epoch}: {self._name(skip.action)} does not happen, {WHY[skip.why]}"
        unfinished = self.simulated.limit is not None
        if self.cost <= self.promised and (self.simulated.goals_hold or unfinished):
            return None
        dearer = self.simulated.goals_hold or unfinished
        miss = "it costs more" if dearer else "the goals do not hold at the end"
        return f"{self._departure()}{miss}"

    def _departure(self) -> str:
        """The first epoch in which the human does not do what the plan wants of them."""
        for epoch in self.simulated.epochs:
            done, wanted = self._did(epoch), self.his_steps.get(epoch.epoch)
            if done != wanted:
                deed, wish = done or "nothing", wanted or "nothing"
                who = self.task.agents[self.task.human]
                return f"epoch {epoch.epoch}: {who} does {deed}, where the plan has {wish}; "
        return ""

    def _epochs(self) -> Iterator[TraceEpoch]:
        for epoch in self.simulated.epochs:
            skipped = [(self.task.actions[skip.action], skip.why) for skip in epoch.skipped]
            decision = "waits" if epoch.best is None else "replans" if epoch.replanned else "keeps"
            yield TraceEpoch(
                epoch=epoch.epoch,
                saw=tuple(f"{'' if true else 'not '}{self.task.facts[fact]}" for fact, true in epoch.saw),
                expected_cost=rounded(epoch.kept),
                best_cost=rounded(epoch.best),
                decision=decision,
                why=_why(decision, epoch),
                plan=tuple(self._name(i) for i in epoch.plan),
                did=self._did(epoch),
                failed=epoch.failed,
                steps=self._steps(epoch),
                skipped=tuple(TraceSkip(participants(self.task, a), a.name, why) for a, why in skipped),
            )

    def _steps(self, epoch: SimulatedEpoch) -> tuple[PlanStep, ...]:
        steps = (Step(epoch.epoch, i) for i in sorted(epoch.executed))
        return named_steps(self.task, self.discount, steps)

    def _did(self, epoch: SimulatedEpoch) -> str | None:
        did = epoch.own if epoch.accepted is None else epoch.accepted
        return None if did is None else self._name(did)

    def _name(self, action: int) -> str:
        return self.task.actions[action].name


def _why(decision: str, epoch: SimulatedEpoch) -> str:
    if decision == "waits":
        return "has no plan from here and waits"
    if decision == "keeps":
        return f"keeps the plan: it still costs {plain(epoch.best)}, and none is cheaper"
    if epoch.kept is None:
        return f"replans: the plan does not work any more; the best from here costs {plain(epoch.best)}"
    return f"replans: {plain(epoch.best)} instead of {plain(epoch.kept)}"
