"""What a person who replans makes of a plan: when they change their mind, and what hinges on what robots do.

The plan is played beside them, as ``simulate`` plays it; so is each that differs in one thing.
"""

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import cached_property

from serendipity.facade.interruptibility import removal
from serendipity.facade.simulation import Replanning, simulate
from serendipity.model import Deadline, LimitReachedError, PlanStep, Result, Task
from serendipity.model.answers.fields import Written
from serendipity.model.answers.trace import Trace, TraceEpoch
from serendipity.model.numbers import as_written
from serendipity.model.task.actions import GroundAction
from serendipity.model.task.execution import actions_named


@dataclass(frozen=True, slots=True)
class ChangeOfMind(Written):
    """A moment in which the person turns to something else; costs are their own, undiscounted.

    Attributes:
        why: ``replans``, ``joins`` an action of robots', ``tries`` in vain, or ``waits``, having no plan.
        action: what they join, or try.
        saw: the facts they plan with that are other than they expected, ``not`` in front of false ones.
        because: what robots have begun that they see then, and that matters to their plans.
        kept: what their former plan would still cost; None where it does not work any more.
        best: their optimal cost alone from here; None where there is no plan.
        joined: ``joins``: what it costs, with what they still pay alone once it is over.
        removed: what they leave out of their former plan.
        replacement: what they do instead.
    """

    epoch: int
    why: str
    action: str | None
    saw: tuple[str, ...]
    because: tuple[str, ...]
    kept: Fraction | None
    best: Fraction | None
    joined: Fraction | None = None
    removed: tuple[str, ...] = ()
    replacement: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class Contrast(Written):
    """What becomes of the plan where robots do something else.

    Attributes:
        change: ``without`` one of these actions of robots' (or all, where there is to be no robot), or with
            one ``sooner`` by an epoch, and all that robots do before it, or ``later``, and all after it.
        actions: each by itself has the same consequence.
        epochs: in which they begin.
        costs: what it costs the team with each, ascending; empty where the goals are not reached.
        as_planned: whether the person does what they had planned at first.
        removed: what the person does not do then, and does in the answer's plan.
        replacement: what they do instead.
    """

    change: str
    actions: tuple[str, ...]
    epochs: tuple[int, ...]
    costs: tuple[Fraction, ...]
    as_planned: bool
    removed: tuple[str, ...]
    replacement: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class Reaction(Written):
    """What the person makes of an answer's plan.

    Attributes:
        turns: when they turn to something else.
        alone: what happens without any robot; None where robots do nothing anyway, or it is left out.
        contrasts: what hinges on each action of robots', and on when it begins.
    """

    turns: tuple[ChangeOfMind, ...]
    alone: Contrast | None = None
    contrasts: tuple[Contrast, ...] = ()


def play(task: Task, answer: Result, human_model: str, deadline: Deadline) -> Trace:
    """What becomes of a plan beside a human who replans, to its end.

    Raises:
        LimitReachedError: the deadline came first.
    """
    model: Replanning = "local" if human_model == "local" else "observant"
    trace = simulate(task, answer, model, deadline=deadline)
    if trace.limit is not None:
        raise LimitReachedError(trace.limit)
    return trace


class PlayedAnswer:
    """An answer's plan beside the person it was made for.

    Args:
        answer: it has a plan, under a human model.
    """

    def __init__(self, task: Task, answer: Result, deadline: Deadline) -> None:
        self._task, self._answer, self._deadline = task, answer, deadline
        self._steps = tuple(sorted(answer.plan or (), key=lambda step: (step.epoch, step.action)))
        self._theirs = [step for step in self._steps if step.agents != (answer.human,)]

    def alone(self) -> Contrast:
        """What happens without any robot."""
        return self._contrast("without", self._theirs, ())

    def turns(self) -> tuple[ChangeOfMind, ...]:
        """When and why the person turns to something else."""
        found, last = [], 0
        plan = tuple(self._answer.human_plan or ())
        for epoch in self._trace.epochs:
            if epoch.epoch <= self._answer.options.head_start or self._is_busy(epoch):
                continue
            if epoch.decision != "keeps" or epoch.failed or self._joint(epoch):
                found.append(self._turn(epoch, last, plan))
            began = epoch.plan[:1] == (epoch.did,) and not epoch.failed
            plan, last = epoch.plan[1:] if began else epoch.plan, epoch.epoch
        return tuple(found)

    def contrasts(self) -> tuple[Contrast, ...]:
        """What hinges on each action of robots', and on when it begins; those of one consequence together."""
        found = _together(self._contrast("without", [step], self._but(step)) for step in self._theirs)
        for change, by in (("sooner", -1), ("later", 1)):
            moved = ((step, self._moved(step, by)) for step in self._theirs)
            played = (self._contrast(change, [step], steps) for step, steps in moved if steps[0].epoch > 0)
            found += _together(one for one in played if self._is_worse(one))
        return tuple(found)

    def _is_worse(self, contrast: Contrast) -> bool:
        assert self._answer.cost is not None
        return not contrast.costs or contrast.costs[0] > as_written(self._answer.cost)

    @cached_property
    def _trace(self) -> Trace:
        return self._play(self._steps)

    def _play(self, steps: Sequence[PlanStep]) -> Trace:
        answer = replace(self._answer, plan=tuple(steps))
        return play(self._task, answer, answer.options.human_model, self._deadline)

    def _contrast(self, change: str, changed: Sequence[PlanStep], steps: Sequence[PlanStep]) -> Contrast:
        trace = self._play(steps)
        done = _done(trace)
        gone = removal(_done(self._trace), done)
        return Contrast(
            change,
            tuple(step.action for step in changed),
            tuple(step.epoch for step in changed),
            (as_written(trace.cost),) if trace.goals_hold else (),
            done == self._answer.human_plan,
            gone.removed,
            gone.replacement,
        )

    def _but(self, left_out: PlanStep) -> tuple[PlanStep, ...]:
        return tuple(step for step in self._steps if step is not left_out)

    def _moved(self, chosen: PlanStep, by: int) -> tuple[PlanStep, ...]:
        """The plan with a step of robots', and what they do before or after it, an epoch sooner or later."""
        moved = [one for one in self._theirs if one is chosen or (one.epoch - chosen.epoch) * by > 0]
        steps = (replace(step, epoch=step.epoch + by) if step in moved else step for step in self._steps)
        return tuple(sorted(steps, key=lambda step: step.epoch))

    def _joint(self, epoch: TraceEpoch) -> PlanStep | None:
        """What the person begins with robots in an epoch."""
        human = self._answer.human
        joint = (step for step in epoch.steps if human in step.agents and len(step.agents) > 1)
        return next(joint, None)

    def _is_busy(self, epoch: TraceEpoch) -> bool:
        human = self._answer.human
        begun = (step for one in self._trace.epochs for step in one.steps if human in step.agents)
        return any(step.epoch < epoch.epoch <= step.end for step in begun)

    def _turn(self, epoch: TraceEpoch, last: int, former: tuple[str, ...]) -> ChangeOfMind:
        """What happens in an epoch, the person having looked up before that in the epoch ``last``."""
        joint = self._joint(epoch)
        why = "joins" if joint else "tries" if epoch.failed else epoch.decision
        gone = removal(former, epoch.plan)
        matters = self._matters((*former, *epoch.plan, *(() if joint is None else (joint.action,))))
        since = [one for one in self._trace.epochs if last < one.epoch <= epoch.epoch]
        saw = dict.fromkeys(fact for one in since for fact in one.saw if fact.removeprefix("not ") in matters)
        return ChangeOfMind(
            epoch.epoch,
            why,
            epoch.did if joint or epoch.failed else None,
            tuple(sorted(saw, key=lambda fact: fact.startswith("not "))),
            tuple(self._because(epoch.epoch, last, matters, set(saw))),
            _exact(epoch.expected_cost),
            _exact(epoch.best_cost),
            None if joint is None else self._joined(joint),
            () if joint else gone.removed,
            () if joint else gone.replacement,
        )

    def _joined(self, joint: PlanStep) -> Fraction:
        """What something with robots costs, and the person still pays alone once it is over."""
        free = (one.best_cost for one in self._trace.epochs if one.epoch > joint.end)
        return self._meant(joint)[0].cost + (_exact(next(free, None)) or 0)

    def _because(self, now: int, last: int, matters: set[str], saw: set[str]) -> Iterator[str]:
        """What robots did that the person knows of by now: seen, done together, or told by what they find."""
        human, sees_all = self._answer.human, self._answer.options.human_model == "observant"
        before = [step for one in self._trace.epochs for step in one.steps if one.epoch < now]
        before = [step for step in before if step.agents != (human,)]
        for step in before:
            changed = self._changed(step)
            later = set[str]().union(*(self._changed(other) for other in before if other.epoch > step.epoch))
            is_known = step.epoch >= max(last, 1) and (sees_all or human in step.agents)
            is_seen = not saw and step.epoch < now <= step.end  # nothing but what somebody is at can be news
            has_to_do = not matters.isdisjoint(fact.removeprefix("not ") for fact in changed)
            if changed & saw - later or (has_to_do and (is_known or is_seen)):
                yield step.action

    def _changed(self, step: PlanStep) -> set[str]:
        """The facts that a step makes true, and (``not`` in front) false."""
        facts, found = self._task.facts, set[str]()
        for action in self._meant(step):
            timing = action.timing
            found |= {facts[f] for f in (*action.add, *(timing.start_add if timing else ()))}
            gone = (*action.delete, *(timing.start_delete if timing else ()))
            found |= {f"not {facts[f]}" for f in gone}
        return found

    def _meant(self, step: PlanStep) -> list[GroundAction]:
        return [self._task.actions[i] for i in actions_named(self._task, step.action, step.agents)]

    def _matters(self, names: Sequence[str]) -> set[str]:
        """The facts that some actions, and the goal, have to do with."""
        task = self._task
        found = {*task.goal.positive, *task.goal.negative}
        for action in (task.actions[i] for name in names for i in task.named[name]):
            found |= {*action.pre, *action.neg, *action.add, *action.delete}
            if action.timing is not None:
                for asked in (action.timing.over_all, action.timing.at_end):
                    found |= {*asked.positive, *asked.negative}
        return {task.facts[fact] for fact in found}


def _done(trace: Trace) -> tuple[str, ...]:
    """What the person does, in order."""
    return tuple(epoch.did for epoch in trace.epochs if epoch.did is not None and not epoch.failed)


def _exact(cost: float | None) -> Fraction | None:
    return None if cost is None else as_written(cost)


def _together(contrasts: Iterable[Contrast]) -> list[Contrast]:
    """Contrasts of one consequence as one, in their order."""
    found: dict[object, Contrast] = {}
    for one in contrasts:
        key = bool(one.costs), one.removed, one.replacement
        same = found.get(key)
        if same is not None:
            costs = tuple(sorted({*same.costs, *one.costs}))
            actions, epochs = (*same.actions, *one.actions), (*same.epochs, *one.epochs)
            one = replace(one, actions=actions, epochs=epochs, costs=costs)
        found[key] = one
    return list(found.values())
