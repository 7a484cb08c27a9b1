"""Plans that pay, in time, and what stands of them after an epoch that goes as planned."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from fractions import Fraction

from serendipity.execution.clock.world import WorldInTime
from serendipity.facade.person.ways import Way
from serendipity.model import Options, PlanStep, Task, Window
from serendipity.model.task.script import Timeline
from serendipity.robot import Outcome


@dataclass(frozen=True, slots=True)
class Help:
    """A plan that pays, from the epoch that is to come.

    Attributes:
        plan: what everybody does.
        window: where the person is met, as far as it says so.
        cost: what it costs the team, or, beside somebody who is not told, what it will come to.
        proved: whether nothing is better.
        settled: whether it is the best plan of the mode, so that it stands while all goes as planned.
        pays: whether it helps; else robots see to goals of their own in it.
    """

    plan: tuple[PlanStep, ...]
    window: Window | None
    cost: Fraction
    proved: bool
    settled: bool
    pays: bool = True


@dataclass(frozen=True, slots=True)
class Course:
    """What stands after an epoch, if that goes as planned.

    Attributes:
        state: ids of the facts that are true then.
        script: what is left of it then, and what goes on.
        found: the rest of the plan; None: no help pays.
        alone: what the person pays alone, where no help pays.
    """

    state: frozenset[int]
    script: Timeline
    found: Help | None
    alone: Way | None


def after_going_on(now: Task, options: Options, alone: Way, name: str | None) -> Course:
    """What stands after an epoch of the person alone, where no help pays: none will as long as they go on.

    Args:
        alone: their plan from here, and its cost.
        name: what they begin by it, or None.
    """
    world = WorldInTime(now, options.discount, strict=options.strict)
    happened = world.play(None if name is None else world.his(name), [], _done)
    left = alone.cost - world.cost(happened.executed)[0]
    return Course(world.now.init, world.now.script, None, Way(alone.plan, left))


def after_helping(now: Task, options: Options, found: Help, choice: PlanStep | str | None) -> Course | None:
    """What stands after an epoch of a plan; None where robots have no part in the rest, or it is made anew.

    Args:
        choice: what the person does: a step of the plan, the name of an action of their own, or nothing.
    """
    human = now.agents[now.human]
    later = tuple(replace(step, epoch=step.epoch - 1) for step in found.plan if step.epoch > 1)
    if not found.settled or all(step.agents == (human,) for step in later):
        return None
    world = after(now, options, found.plan, choice)
    if world is None:
        return None
    cost = found.cost - world.cost(world.executed)[1]
    return Course(world.now.init, world.now.script, replace(found, plan=later, window=None, cost=cost), None)


class _Foreseen(WorldInTime):
    """The world after an epoch of a plan; ``executed``: what began in it, by action ids."""

    executed: tuple[int, ...] = ()


def after(
    now: Task, options: Options, plan: Sequence[PlanStep], choice: PlanStep | str | None
) -> _Foreseen | None:
    """The world after an epoch of a plan; None where the person's part in it is not possible.

    Args:
        choice: what the person does: a step of the plan, the name of an action of their own, or nothing.
    """
    human = now.agents[now.human]
    robots = [step for step in plan if step.epoch == 1 and human not in step.agents]
    world = _Foreseen(now, options.discount, strict=options.strict)
    taken = [choice] if isinstance(choice, PlanStep) and len(choice.agents) > 1 else []
    name = choice.action if isinstance(choice, PlanStep) else choice
    own = None if name is None or taken else world.his(name)
    if own is not None and not world.applicable(own):
        return None
    world.executed = world.play(own, [*taken, *robots], _done).executed
    return world


def _done(asked: Sequence[PlanStep]) -> Sequence[Outcome]:
    """Everything succeeds."""
    return ["done"] * len(asked)
