"""Calls about tasks in which actions take time, or the human waits: asked and answered in single epochs."""

from collections.abc import Iterator
from dataclasses import replace

from search import PreparedTask, canonical_human_plan
from serendipity.facade.call import Request, Solver
from serendipity.model.answers.answer import Answer
from serendipity.model.errors import LIMITS, UsageError, limit_reason
from serendipity.model.options import Options
from serendipity.model.task.horizon import horizon_of
from serendipity.model.task.plans import Step
from serendipity.model.task.unit_steps import UnitSteps, unit_steps


def answers_in_time(call: Request, solver: Solver) -> Iterator[Answer]:
    """Answers to such a call.

    Args:
        call: the call.
        solver: the one of its mode.

    Raises:
        PlanError: the human's plan can't be executed after the head start, or misses the goal.
        UsageError: the call asks for something that is not answered for such tasks.
    """
    _require_plain(call.options)
    try:
        units = unit_steps(call.task, call.deadline)
        inner = _in_units(call, units)
    except LIMITS as limit:
        yield Answer("unknown", reason=limit_reason(limit))
        return
    if not inner.predicts and call.options.mode in ("individual", "serendipity"):
        yield Answer("infeasible", reason="no-human-plan")
        return
    epochs = call.options.head_start if call.options.mode == "individual" else 0
    horizon = call.options.horizon
    for number, answer in enumerate(solver(inner)):
        told = _told(units, _later(units, answer, epochs))
        if not number and told.human_plan is not None and horizon is not None:
            horizon_of(call.task, call.options, told.human_plan)  # which says whether what it reaches lasts
        yield told


def _in_units(call: Request, units: UnitSteps) -> Request:
    """The call in single epochs.

    Raises:
        LimitReachedError: the deadline came.
        PlanError: as :func:`answers_in_time`.
    """
    prepared, given = PreparedTask(units.task), None if call.given is None else units.plan(call.given)
    options, epochs = call.options.but(head_start=0), call.options.head_start
    if given is not None:  # it may come too late, or be in a bystander's way
        call.task.replay_alone(units.begun(units.after_waiting(given, epochs)), strict=options.strict)
    inner = replace(call, prepared=prepared, given=given, options=options)
    if not epochs:
        return inner
    state = units.waited(epochs, strict=options.strict)
    if state is None:
        return replace(inner, predicts=False)
    later = PreparedTask(units.task.at(state))
    if options.mode == "individual":
        return replace(inner, prepared=later)
    plan = canonical_human_plan(later, call.deadline, options) if given is None else given
    if plan is None:
        return replace(inner, predicts=False)
    return replace(inner, given=units.after_waiting(plan, epochs))


def _require_plain(options: Options) -> None:
    """Check that a call asks for nothing that is not answered in time."""
    if options.waiting_cost:
        raise UsageError("waiting_cost: is read, but not planned for yet")
    expected = {
        "mode": ("serendipity", "communication", "composite", "individual"),
        "suffix": ("replan",),
        "preservation": ("kernel",),
        "human_model": ("omniscient",),
        "keep_prefix": (False,),
        "ties": ("fixed",),
    }
    for name, legal in expected.items():
        if getattr(options, name) not in legal:
            words = ", ".join(map(str, legal))
            raise UsageError(
                f"{name}: where actions take time, expected {words}, got {getattr(options, name)}"
            )


def _later(units: UnitSteps, answer: Answer, epochs: int) -> Answer:
    """What is done alone after some epochs of waiting, with these."""
    plan, steps, horizon = answer.human_plan, answer.steps, answer.horizon
    return answer._replace(
        human_plan=None if plan is None else units.after_waiting(plan, epochs),
        steps=None if steps is None else tuple(Step(step.epoch + epochs, step.action) for step in steps),
        horizon=horizon + epochs if isinstance(horizon, int) else horizon,
    )


def _told(units: UnitSteps, answer: Answer) -> Answer:
    """An answer with the actions of the task itself, each in the epoch in which it begins."""
    return answer._replace(
        human_plan=None if answer.human_plan is None else units.begun(answer.human_plan),
        steps=None if answer.steps is None else units.steps(answer.steps),
        realised={},
    )
