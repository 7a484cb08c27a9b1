"""Replays a reported plan with sets, epoch by epoch (semantics 2)."""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass

from serendipity.model import Deadline, PlanError, PlanStep, Task
from verify.base.execution import State, after, applicable, clash, grouped, meant_by, met, participants


@dataclass(frozen=True, slots=True)
class Fault:
    """What is wrong with a step: the rule that it breaks, and why."""

    rule: str
    message: str
    epoch: int
    action: str


@dataclass(frozen=True, slots=True)
class Replay:
    """A plan as it unfolds.

    Attributes:
        sets: the actions of each epoch that has any, by epoch.
        states: state after each epoch in which something happens, by epoch; ``s_0`` under 0.
        fault: the first step that can't be executed as reported, or None.
    """

    sets: Mapping[int, tuple[int, ...]]
    states: Mapping[int, State]
    fault: Fault | None

    def state_after(self, epoch: int) -> State:
        """``s_epoch``."""
        return self.states[max(t for t in self.states if t <= epoch)]

    @property
    def last(self) -> State:
        """The state after the last action."""
        return self.states[max(self.states)]


def replay(task: Task, steps: Sequence[PlanStep], deadline: Deadline, *, strict: bool) -> Replay:
    """Execute the steps from ``I`` until the first fault."""
    by_epoch = grouped((step.epoch, step) for step in deadline.each(steps))
    sets: dict[int, tuple[int, ...]] = {}
    states: dict[int, State] = {0: task.init}
    state = task.init
    for epoch in deadline.each(sorted(by_epoch)):
        chosen, fault = _epoch(task, by_epoch[epoch], state, deadline, strict=strict)
        if fault is not None:
            return Replay(sets, states, fault)
        state = after(state, *(task.actions[i] for i in chosen))
        sets[epoch], states[epoch] = chosen, state
    return Replay(sets, states, None)


def replay_human(task: Task, names: Iterable[str], deadline: Deadline) -> tuple[int, ...]:
    """``pi_H`` from its names.

    Raises:
        PlanError: it is not a plan of the human alone.
    """
    state = task.init
    plan: list[int] = []
    for number, name in enumerate(deadline.each(names), start=1):
        own = [i for i in task.named.get(name, ()) if task.actions[i].participants == (task.human,)]
        if not own:
            raise PlanError(f"step {number}, '{name}', is not an action that the human does alone")
        chosen = next((i for i in own if applicable(task.actions[i], state)), None)
        if chosen is None:
            raise PlanError(f"step {number}, '{name}', is not applicable: {_unmet(task, own[0], state)}")
        plan.append(chosen)
        beside = met(task, state, (chosen,)) if task.of_bystanders else (chosen,)
        state = after(state, *(task.actions[i] for i in beside))
    if not task.goal.holds(state):
        raise PlanError("the goal does not hold at its end")
    return tuple(plan)


def _epoch(
    task: Task, steps: Sequence[PlanStep], state: State, deadline: Deadline, *, strict: bool
) -> tuple[tuple[int, ...], Fault | None]:
    """The actions of one epoch: of several with one name the first that fits beside the others."""
    firsts: list[int] = []
    chosen: Iterator[tuple[int, ...]] = iter([()])
    fault: Fault | None = None
    for step in steps[: len(task.agents) + 1]:  # of more steps than agents somebody is in two
        ids, fault = _resolve(task, step, state)
        if fault is not None:
            break
        chosen = _beside(task, chosen, step, ids, deadline, strict=strict)
        firsts.append(ids[0])
    found = next(chosen, None) if fault is None else None
    if found is not None:
        return found, None
    conflicts = (_conflict(task, firsts[:k], i, steps[k], strict=strict) for k, i in enumerate(firsts))
    return (), next(filter(None, conflicts), fault)


def _beside(
    task: Task,
    chosen: Iterator[tuple[int, ...]],
    step: PlanStep,
    ids: tuple[int, ...],
    deadline: Deadline,
    *,
    strict: bool,
) -> Iterator[tuple[int, ...]]:
    """What was chosen for the steps before, with each variant of this step that fits."""
    for before in chosen:
        for i in deadline.each(ids):
            if _conflict(task, before, i, step, strict=strict) is None:
                yield (*before, i)


def meant(task: Task, step: PlanStep) -> tuple[list[int], Fault | None]:
    """The actions that a step may mean, by its name and agents: at least one, or what is wrong."""
    ids = task.named.get(step.action, ())
    listed = meant_by(task, step.action, step.agents)
    if not ids:
        return [], Fault("unknown-action", "the task has no such action", step.epoch, step.action)
    if not listed:
        expected = ", ".join(participants(task, ids[0]))
        message = f"its participants are {expected}, not {', '.join(step.agents) or 'nobody'}"
        return [], Fault("wrong-agents", message, step.epoch, step.action)
    return listed, None


def _resolve(task: Task, step: PlanStep, state: State) -> tuple[tuple[int, ...], Fault | None]:
    """The same that are applicable, too."""
    listed, fault = meant(task, step)
    fitting = tuple(i for i in listed if applicable(task.actions[i], state))
    if listed and not fitting:
        message = f"precondition: {_unmet(task, listed[0], state)}"
        fault = Fault("precondition", message, step.epoch, step.action)
    return fitting, fault


def _conflict(
    task: Task, chosen: Sequence[int], action: int, step: PlanStep, *, strict: bool
) -> Fault | None:
    """Whether an action can't join those of its epoch (eq. 5, 6, 10)."""
    new = task.actions[action]
    for other in (task.actions[i] for i in chosen):
        busy = set(new.participants) & set(other.participants)
        if busy:
            who = ", ".join(task.agents[i] for i in sorted(busy))
            return Fault("agent-busy-twice", f"{who} also does '{other.name}'", step.epoch, step.action)
        fact = clash(new, other, strict=strict)
        if fact is not None:
            message = f"conflicts with '{other.name}' over '{task.facts[fact]}'"
            return Fault("conflict", message, step.epoch, step.action)
    return None


def _unmet(task: Task, action: int, state: State) -> str:
    ground = task.actions[action]
    missing = next((f for f in ground.pre if f not in state), None)
    if missing is not None:
        return f"'{task.facts[missing]}' is false"
    return f"'{task.facts[next(f for f in ground.neg if f in state)]}' is true"
