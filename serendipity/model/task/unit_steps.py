"""A task with time as one of single epochs: what takes longer is a chain of actions that have to go on.

An action of ``d`` epochs becomes ``d`` actions of one, which have all the effects and ask for all the
conditions of their epoch (semantics "Time"). A fact says which of them is due: while it holds, the action
is done in the next epoch, whatever else is. The first has the name of the action itself, so a plan is told by
those that begin in it. The last has its cost, and asks for what has to hold still, so that it alone says what
the action is worth where it is not looked at who is free. Agents at work are not *free*; all are at the
end, but bystanders. A script is a chain, too: the epochs of a clock, each of which is due, with what
bystanders begin in it.

The search works on these tasks, and nobody who judges it does: the brute force of the tests reads the task
that was given.
"""

from collections.abc import Iterable
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import cached_property
from itertools import chain, combinations, pairwise
from typing import Final

from serendipity.model.resources.deadline import Deadline
from serendipity.model.task.actions import Condition, GroundAction, Timing, apply, conflicting
from serendipity.model.task.plans import Step, TimedPlan
from serendipity.model.task.script import UNDER_WAY, Timeline, moments
from serendipity.model.task.task import HumanPlan, Task
from serendipity.model.task.variables import Variable, find_variables

CLOCK: Final = "~clock"
"""The agent that makes the script happen: what it does takes effect last, and is in nobody's way."""

WAITING: Final = "~noop"
"""The human's waiting as an action: after all others, as who can act does."""

BESIDE: Final = "~beside"
"""Before the name of what others are in the middle of with the human: for them it is nothing but time."""

RESTING: Final = "~rest"
"""The human's waiting from their last action on, which is free where other waiting costs: the last of all."""

_FREE: Final = Fraction(0)

_BYTES: Final = 1_000
"""Of an epoch of an action or of the script; measured."""


@dataclass(frozen=True)
class UnitSteps:
    """A task in which everything takes one epoch, and what it has to do with the one it was made of.

    Attributes:
        task: the task, with :attr:`.Task.due`.
        chains: by id of an original action its ids in the task, epoch by epoch.
        waiting: id of the human's waiting, which given plans may have.
        resting: the same after their last action; where waiting costs nothing it is no other.
        busy: ids of what the human is in the middle of at first, epoch by epoch, where their plans begin.
    """

    task: Task
    original: Task
    chains: tuple[tuple[int, ...], ...]
    waiting: int
    resting: int
    busy: tuple[int, ...] = ()

    @cached_property
    def _begins(self) -> dict[int, int]:
        """By id in the task the original action that begins with it."""
        return {chain[0]: action for action, chain in enumerate(self.chains)}

    def goal(self, goal: Condition) -> Condition:
        """A goal of the human's over facts of the original: at the end they are at nothing."""
        own = len(self.original.facts)
        return Condition(
            (*goal.positive, *(fact for fact in self.task.goal.positive if fact >= own)), goal.negative
        )

    def plan(self, plan: HumanPlan, head_start: int = 0) -> HumanPlan:
        """A human plan of the original, one action for each epoch, waiting included; some before it, too."""
        found = [*self.busy]
        for action, start in zip(plan, self.original.starts_of(plan), strict=True):
            found += [self.waiting] * (head_start + start - 1 - len(found))
            found += self.chains[action]
        found += [self.resting] * (head_start + self.original.epochs_of(plan) - len(found))
        return tuple(found)

    def after_waiting(self, plan: HumanPlan, epochs: int) -> HumanPlan:
        """A plan in single epochs from some epochs on, with waiting before it once the human is free."""
        busy, acts = self.busy[:epochs], any(action in self._begins for action in plan)
        return busy + (self.waiting if acts else self.resting,) * (epochs - len(busy)) + plan

    def price_before(self, plan: HumanPlan, epochs: int) -> Fraction:
        """The cost of the waiting that :meth:`after_waiting` puts before a plan."""
        return self.task.cost_of(self.after_waiting(plan, epochs)) - self.task.cost_of(plan)

    def begun(self, plan: HumanPlan) -> HumanPlan:
        """The plan of the original that a plan in single epochs is."""
        begins = self._begins
        starts = {epoch: begins[action] for epoch, action in enumerate(plan, start=1) if action in begins}
        if not self.busy and {self.waiting, self.resting}.isdisjoint(plan):
            return tuple(starts.values())
        return TimedPlan(starts.values(), starts, len(plan))

    def waited(self, epochs: int, *, strict: bool) -> frozenset[int] | None:
        """The state of the task after some epochs of what is due; None where that is impossible.

        Who has waited at a price begins nothing any more where they get what they want without it.
        """
        state: frozenset[int] | None = self.task.init
        for _ in range(epochs):
            state = None if state is None else self._idled(state, strict=strict)
        if state is None or epochs <= len(self.busy) or not self._rests(state, strict=strict):
            return state
        return state.difference(self.task.actions[self.resting].delete)

    def _rests(self, state: frozenset[int], *, strict: bool) -> bool:
        """Whether the human gets what they want if they begin nothing from a state on."""
        now: frozenset[int] | None = state
        while now is not None and not self.task.goal.holds(now):
            if not any(fact in now for fact, _ in self.task.due):
                return False
            now = self._idled(now, strict=strict)
        return now is not None

    def _idled(self, state: frozenset[int], *, strict: bool) -> frozenset[int] | None:
        """The state after an epoch of what is due; None where that is impossible."""
        task = self.task
        clock = len(task.agents) - 1 if CLOCK in task.agents else -1
        due = [task.actions[action] for fact, action in task.due if fact in state]
        done = {action.name: action for action in reversed(due) if action.applicable(state)}
        theirs = [action for action in done.values() if action.participants != (clock,)]
        clash = any(conflicting(a, b, strict=strict) for a, b in combinations(theirs, 2))
        if clash or any(action.name not in done for action in due):
            return None
        ticks = [action for action in done.values() if action.participants == (clock,)]
        return apply(apply(state, *theirs), *ticks)

    def steps(self, steps: Iterable[Step]) -> tuple[Step, ...]:
        """The steps in which an action of the original begins."""
        begins = self._begins
        return tuple(Step(step.epoch, begins[step.action]) for step in steps if step.action in begins)


def unit_steps(task: Task, deadline: Deadline | None = None, waiting_cost: Fraction = _FREE) -> UnitSteps:
    """The task in single epochs.

    Args:
        waiting_cost: of each epoch in which the human waits before an action of theirs.

    Raises:
        LimitReachedError: the deadline came, or all these epochs don't fit into memory.
    """
    deadline = deadline or Deadline()
    deadline.require(_BYTES * (sum(action.duration for action in task.actions) + task.script.last))
    steps = _Steps(task, waiting_cost)
    for action in task.actions:
        deadline.tick()
        steps.add(action)
    if task.script:
        steps.add_script(deadline)
    return steps.finished(deadline)


def asked_of(task: Task, action: GroundAction) -> set[int]:
    """The facts that an action asks for which goes on, in a task in single epochs: over all, or at end."""
    assert task.in_time is not None, "something goes on"
    begun = task.in_time.named.get(action.name.removeprefix(f"{UNDER_WAY} ").rpartition(" ")[0], ())
    timings = [timing for i in begun if (timing := task.in_time.actions[i].timing) is not None]
    inside = [one for timing in timings for one in (timing.over_all, timing.at_end)]
    asked = {fact for one in inside for fact in (*one.positive, *one.negative)}
    return asked.intersection((*action.pre, *action.neg))


def _kept_by(task: Task) -> list[frozenset[int]]:
    """By fact those without whom nothing deletes it: while they are at something it stays."""
    everybody = frozenset(range(len(task.agents)))
    kept = [everybody] * len(task.facts)
    for action in moments(task.actions, Timeline(deeds=task.script.deeds)):
        for fact in action.delete:
            kept[fact] = kept[fact].intersection(action.participants)
    for change in task.script.facts:
        kept[change.fact] = frozenset()
    return kept


class _Steps:
    """Facts and actions of the new task, as they are found."""

    def __init__(self, task: Task, waiting_cost: Fraction) -> None:
        self._task = task
        self._waiting_cost = waiting_cost
        self._facts = [*task.facts]
        self._agents = task.agents
        self._due: list[tuple[int, GroundAction]] = []
        self._chains: list[list[GroundAction]] = []
        self._others: list[GroundAction] = []  # that nobody chooses
        self._clock: list[int] = []
        self._busy: list[GroundAction] = []
        self._at_work: list[int] = []
        self._start: list[int] = []  # facts that hold at first
        busy = {
            agent for action in task.actions if action.timing is not None for agent in action.participants
        }
        self._free = {agent: self._fact(f"free {task.agents[agent]}") for agent in sorted(busy)}
        self._start += self._free.values()
        # While it holds the human may begin something; without it they wait for nothing.
        self._awake = [self._fact("awake")] if waiting_cost else []
        self._start += self._awake
        self._kept = _kept_by(task)

    def _fact(self, name: str) -> int:
        self._facts.append(name)
        return len(self._facts) - 1

    def add(self, action: GroundAction) -> None:
        """Add an action of the task, epoch by epoch."""
        free = [self._free[agent] for agent in action.participants if agent in self._free]
        awake = self._awake if self._task.human in action.participants else []
        self._chains.append(self._epochs(action, [*free, *awake], free))

    def _epochs(self, action: GroundAction, asked: list[int], free: list[int]) -> list[GroundAction]:
        """The epochs of an action.

        Args:
            asked: facts that it asks for at the start, besides its own.
            free: facts that do not hold meanwhile.
        """
        begun = replace(action, pre=tuple(sorted((*action.pre, *asked))), timing=None)
        timing = action.timing
        if timing is None:
            return [begun]
        begun = replace(begun, cost=_FREE)
        still = [
            fact
            for fact in {*action.pre} - {*timing.start_delete}
            if not self._kept[fact].isdisjoint(action.participants)
        ]
        progress = [self._fact(f"{action.name} {epoch}") for epoch in range(2, action.duration + 1)]
        add, delete = sorted((*timing.start_add, progress[0])), sorted((*timing.start_delete, *free))
        epochs = [replace(begun, add=tuple(add), delete=tuple(delete))]
        inside = timing.over_all
        for number, (due, following) in enumerate(pairwise(progress), start=2):
            pre, name = tuple(sorted((*inside.positive, due))), f"{action.name} {number}"
            epochs.append(
                GroundAction(name, action.participants, pre, inside.negative, (following,), (due,), _FREE)
            )
        end, last = action.moments[1], progress[-1]
        epochs.append(
            replace(
                end,
                name=f"{action.name} {action.duration}",
                pre=tuple(sorted({*end.pre, *still, last})),
                add=tuple(sorted((*end.add, *free))),
                delete=tuple(sorted((*end.delete, last))),
                cost=action.cost,
            )
        )
        self._due += zip(progress, epochs[1:], strict=True)
        return epochs

    def add_script(self, deadline: Deadline) -> None:
        """Add the clock, the facts that change by it, and what bystanders do."""
        task, script = self._task, self._task.script
        clock = self._clock = [self._fact(f"epoch {epoch}") for epoch in range(script.last + 1)]
        self._start.append(clock[0])
        self._agents = (*task.agents, CLOCK)
        for epoch, (before, after) in enumerate(pairwise(clock), start=1):
            deadline.tick()
            true, false = script.changes(epoch)
            add, delete = tuple(sorted({*true, after})), tuple(sorted({*false, before}))
            name, who = f"{CLOCK} {epoch}", (len(task.agents),)
            tick = GroundAction(name, who, (before,), (), add, delete, _FREE)
            self._due.append((before, tick))
            self._others.append(tick)
        for deed in script.deeds:
            for action in chain.from_iterable(map(self._by_person, deed.variants)):
                free = [self._free[agent] for agent in action.participants if agent in self._free]
                begun = self._under_way(action) if free else action
                epochs = self._epochs(replace(begun, cost=_FREE), [clock[deed.epoch - 1]], [])
                if free:
                    self._free_after(epochs, free)
                self._busy = epochs if task.human in action.participants else self._busy
                self._due.append((clock[deed.epoch - 1], epochs[0]))
                self._others += epochs

    def _under_way(self, action: GroundAction) -> GroundAction:
        """What somebody is in the middle of; it asks for what it ends and nobody else can end before."""
        init, kept = self._task.init, self._kept
        lasts = (f for f in action.delete if f in init and not kept[f].isdisjoint(action.participants))
        return replace(action, name=f"{UNDER_WAY} {action.name}", pre=tuple(sorted({*action.pre, *lasts})))

    def _free_after(self, epochs: list[GroundAction], free: list[int]) -> None:
        """Let somebody be at work from the start, and free after the last of some epochs: one variable."""
        at_work = self._fact(f"{epochs[0].name} 1")
        self._at_work.append(at_work)
        self._start = [*(fact for fact in self._start if fact not in free), at_work]
        first, ending = epochs[0], epochs[-1]
        epochs[0] = replace(first, pre=(*first.pre, at_work), delete=(*first.delete, at_work))
        epochs[-1] = replace(epochs[-1], add=tuple(sorted((*epochs[-1].add, *free))))
        self._due = [(fact, epochs[-1] if one is ending else one) for fact, one in self._due]

    def _by_person(self, action: GroundAction) -> list[GroundAction]:
        """What somebody does; where the human does it with others, their part, and that others are busy."""
        others = tuple(agent for agent in action.participants if agent != self._task.human)
        if not others or len(others) == len(action.participants):
            return [action]
        longer = None if action.timing is None else Timing(action.duration)
        beside = GroundAction(f"{BESIDE} {action.name}", others, (), (), (), (), _FREE, longer)
        return [replace(action, participants=(self._task.human,)), beside]

    def _variables(self, found: Iterable[Variable]) -> tuple[Variable, ...]:
        """Variables, with the clock as one of them."""
        clock = {*self._clock}
        kept = [one for one in found if clock.isdisjoint(one.facts)]
        rest = [one for one in found if not clock.isdisjoint(one.facts)]
        single = [Variable((fact,)) for one in rest for fact in one.facts if fact not in clock]
        time = [Variable(tuple(self._clock))] if clock else []
        return tuple(sorted((*kept, *single, *time), key=lambda one: one.facts))

    def finished(self, deadline: Deadline) -> UnitSteps:
        """The new task."""
        task = self._task
        idle = self._idle()
        # By key, as those of every task; equal ones (variants) stay in their order.
        every = sorted(
            (*chain.from_iterable(self._chains), *self._others, *idle), key=lambda action: action.key
        )
        numbers = {id(action): number for number, action in enumerate(every)}
        init, facts = task.init | set(self._start), tuple(self._facts)
        theirs = [self._free[task.human]] if task.human in self._free else []
        goal = Condition((*task.goal.positive, *theirs), task.goal.negative)
        people = task.script.people | set(range(len(task.agents), len(self._agents)))
        unit = replace(
            task,
            agents=self._agents,
            facts=facts,
            init=init,
            goal=goal,
            actions=tuple(every),
            at_rest=tuple(sorted(set(self._free.values()) - set(theirs))),
            due=tuple((fact, numbers[id(action)]) for fact, action in self._due),
            script=Timeline(people=frozenset(people)),
            in_time=task,
            known_variables=self._variables(
                find_variables(facts, init, tuple(every), deadline, self._at_work)
            ),
        )
        chains = tuple(tuple(numbers[id(action)] for action in one) for one in self._chains)
        busy = tuple(numbers[id(action)] for action in self._busy)
        return UnitSteps(unit, task, chains, numbers[id(idle[0])], numbers[id(idle[-1])], busy)

    def _idle(self) -> list[GroundAction]:
        """The human's waiting; where it costs, also what they do once they begin nothing any more."""
        awake, who = tuple(self._awake), (self._task.human,)
        waiting = GroundAction(WAITING, who, awake, (), (), (), self._waiting_cost)
        return [waiting, GroundAction(RESTING, who, (), (), (), awake, _FREE)] if awake else [waiting]
