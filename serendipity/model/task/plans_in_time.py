"""Human plans beside a script, or with waiting in them: read from names, and replayed (semantics 10)."""

from collections.abc import Iterable
from fractions import Fraction
from typing import TYPE_CHECKING

from serendipity.model.errors import PlanError
from serendipity.model.options import MAX_EPOCH
from serendipity.model.task.actions import GroundAction
from serendipity.model.task.course import BrokenPlanError, PlayedPlan
from serendipity.model.task.names import canonical_name
from serendipity.model.task.plans import PlanEntry, PlanTimes, TimedPlan, unknown_action

if TYPE_CHECKING:
    from serendipity.model.task.task import HumanPlan, Task


def impossible_epoch(step: int, name: str, epoch: int, *, least: int = 1) -> PlanError:
    """The error of a human plan in which an action begins too early, or in an epoch that there is not."""
    until = "on" if epoch <= MAX_EPOCH else f"to {MAX_EPOCH}"
    wrong = f"expected an epoch from {least} {until}, got {epoch}"
    return PlanError(f"human plan, step {step}: '{name}': {wrong}", step=step)


def require_epoch(step: int, name: str, epoch: int, *, waits: bool) -> None:
    """A PlanError where an action can begin in an epoch in no state; waiting may as well be over."""
    if epoch > MAX_EPOCH or (epoch < 1 and not waits):
        raise impossible_epoch(step, name, epoch)


def plan_in_time(task: "Task", entries: Iterable[PlanEntry], head_start: int = 0) -> "HumanPlan":
    """The human plan that entries write down, which reaches the goal; waiting without an epoch is skipped.

    Args:
        task: the task.
        entries: the plan; its epochs count from the end of the head start.
        head_start: epochs of waiting before it.

    Raises:
        PlanError: naming the first step that is unknown, not theirs, begins too early or can't be done, or
            saying that the goal is missed.
    """
    human = _Human(task)
    human.wait_until(head_start)
    for step, entry in enumerate(entries, start=1):
        epoch, name = (None, entry) if isinstance(entry, str) else entry
        human.step(step, None if epoch is None else epoch + head_start, canonical_name(name))
    task.require_goal(human.course.state, tuple(human.actions))
    whole = TimedPlan(human.actions, human.starts, human.course.epoch)
    return before_waiting(task, whole, head_start)


def before_waiting(task: "Task", plan: "HumanPlan", epochs: int) -> "HumanPlan":
    """A human plan without some epochs of waiting that it begins with; a plain tuple where there is none."""
    plain = tuple(plan)
    starts, length = tuple(start - epochs for start in task.starts_of(plan)), task.epochs_of(plan) - epochs
    waits = (starts, length) != (task.starts_of(plain), task.epochs_of(plain))
    return TimedPlan(plan, starts, length) if waits else plain


def times_of(task: "Task", plan: "HumanPlan") -> PlanTimes:
    """The times of a human plan."""
    durations = tuple(task.actions[i].duration for i in plan)
    return PlanTimes(task.starts_of(plan), durations, task.epochs_of(plan))


def cost_alone(task: "Task", plan: "HumanPlan", waiting_cost: Fraction, head_start: int = 0) -> Fraction:
    """What the human pays for a plan behind a head start, waiting included."""
    starts = (start + head_start for start in task.starts_of(plan))
    begun = zip(starts, (task.actions[i].duration for i in plan), strict=True)
    return task.cost_of(plan) + waiting_cost * waited(task, begun)


def waited(task: "Task", begun: Iterable[tuple[int, int]]) -> int:
    """Epochs in which the human is at nothing and still begins something later (semantics 10.2).

    Args:
        task: the task, which says what they are at in the beginning.
        begun: what they begin: epochs and durations.
    """
    times, busy = sorted(begun), task.script.busy(task.human)
    return times[-1][0] - 1 - busy - sum(duration for _, duration in times[:-1]) if times else 0


def replayed(task: "Task", plan: "HumanPlan", *, strict: bool = False) -> list[frozenset[int]]:
    """The states after each epoch of a human plan, from 0; a PlanError where it is none to the goal."""
    human = _done(task, plan, strict=strict)
    task.require_goal(human.course.state, plan)
    return human.states


def outlasts(task: "Task", plan: "HumanPlan", epochs: int, *, strict: bool = False) -> str | None:
    """The reason why what a human plan reaches does not last until an epoch, or None if it does.

    After the plan everybody is idle.

    Raises:
        PlanError: it is no plan in the first place.
    """
    human = _done(task, plan, strict=strict)
    try:
        human.wait_until(epochs)
    except PlanError as error:
        return error.message.removeprefix("human plan, ")
    return None if task.goal.holds(human.course.state) else "the goal does not hold any more"


def broken_script(task: "Task", *, strict: bool = False) -> str | None:
    """The reason why the script can't go on where nobody else does anything, or None if it can.

    Others may see to it that it can after all.
    """
    course = PlayedPlan(task.facts, task.init, task.script, strict=strict)
    if not task.script.deeds:
        return None
    try:
        while course.epoch < task.script.last:
            if not course.rest(task.script.last):
                course.begin([])
    except BrokenPlanError as error:
        return f"epoch {course.epoch}: {error}"
    return None


def _done(task: "Task", plan: "HumanPlan", *, strict: bool = False) -> "_Human":
    human = _Human(task, strict=strict)
    for step, (epoch, action_id) in enumerate(zip(task.starts_of(plan), plan, strict=True), start=1):
        human.do(step, epoch, action_id)
    human.wait_until(task.epochs_of(plan))
    return human


class _Human:
    """The human alone, at a plan."""

    def __init__(self, task: "Task", *, strict: bool = False) -> None:
        self.task = task
        self.course = PlayedPlan(task.facts, task.init, task.script, strict=strict)
        self.states = [task.init]
        self.actions: list[int] = []
        self.starts: list[int] = []
        self._busy = task.script.busy(task.human)
        self.wait_until(self._busy)

    def step(self, step: int, epoch: int | None, name: str) -> None:
        """Do the action of a name, from an epoch on or at once."""
        ids = self.task.named.get(name, ())
        waits = self.task.waits(name)
        if epoch is not None and epoch <= self._busy and waits:
            return
        if epoch is not None:
            if not self.course.epoch < epoch <= MAX_EPOCH:
                raise impossible_epoch(step, name, epoch, least=self.course.epoch + 1)
            self.wait_until(epoch - 1)
        state = self.course.state
        chosen = next((i for i in ids if self.task.actions[i].applicable(state)), None)
        if chosen is None and waits:
            if epoch is not None:
                self.wait_until(epoch)
            return
        if not ids:
            raise unknown_action(step, name)
        self.do(step, self.course.epoch + 1, ids[0] if chosen is None else chosen)

    def do(self, step: int, epoch: int, action_id: int) -> None:
        """Do an action from an epoch on, until it has ended."""
        self.wait_until(epoch - 1)
        action = self.task.step_of(self.course.state, action_id, step)
        self._begin([action], f"step {step}", step)
        self.actions.append(action_id)
        self.starts.append(epoch)
        self.wait_until(epoch + action.duration - 1, f"step {step}", step)

    def wait_until(self, epoch: int, where: str = "", step: int | None = None) -> None:
        """Let epochs go by."""
        while self.course.epoch < epoch:
            passed = self.course.rest(epoch)
            self.states += [self.course.state] * passed
            if not passed:
                self._begin([], where or f"epoch {self.course.epoch + 1}", step)

    def _begin(self, actions: list[GroundAction], where: str, step: int | None) -> None:
        try:
            self.course.begin(actions)
        except BrokenPlanError as error:
            raise PlanError(f"human plan, {where}: {error}", step=step) from None
        self.states.append(self.course.state)
