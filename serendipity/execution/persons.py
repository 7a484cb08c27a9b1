"""People who can be plugged into an execution: what somebody who may be helped does in each epoch.

Personas are people by name: ``observant``, ``local``, ``noisy:0.1``, ``omniscient``, ``recorded:FILE``.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from random import Random
from typing import TYPE_CHECKING, Final, NamedTuple, Protocol

from search import PreparedTask
from search.modes.simulation.human import Human
from search.packed.operators import applicable
from serendipity.execution.recorded import recorded_actions
from serendipity.model import Deadline, HumanPlan, Options, PlanStep, Task, UsageError
from serendipity.model.arguments import TASK, expect
from serendipity.model.rates import probability
from serendipity.model.task.actions import apply
from serendipity.model.task.execution import actions_named
from serendipity.model.task.task import canonical_name

if TYPE_CHECKING:
    from serendipity.execution.execution import Execution


class Moment(NamedTuple):
    """Before an epoch.

    Attributes:
        state: ids of the facts that are true.
        offers: joint actions that robots are ready for.
        planned: whether robots have a plan.
        wish: the name of what it has the person do, None: wait; only who is told of it may look.
        now: in time, the task as it stands; None without.
    """

    state: frozenset[int]
    offers: tuple[PlanStep, ...]
    planned: bool
    wish: str | None
    now: Task | None = None


class Person(Protocol):
    """Somebody who does something in each epoch."""

    @property
    def plan(self) -> HumanPlan | None:
        """What they mean to do from here, by action ids; None where nobody knows."""

    def choose(self, moment: Moment) -> str | None:
        """The name of what they do: an action of their own, an offer, or None to wait.

        They are asked once in each epoch, and everything that they choose and that is possible happens.
        """


def moment_of(run: "Execution") -> Moment:
    """What a person has before them."""
    decided = run.decided
    name, wishes = run.goal or "", decided.wishes
    now = run.now if run.task.needs_time else None
    if decided.goals:  # whose part is theirs is for them to know
        return Moment(run.state, decided.offers, name in wishes, wishes.get(name), now)
    wish = None if decided.expected is None else decided.expected.action
    return Moment(run.state, decided.offers, decided.plan is not None, wish, now)


class Replanner:
    """Looks up in each epoch and replans when that pays (semantics 6).

    Args:
        task: where they begin; its goal is theirs.
        human_model: ``observant`` or ``local``.
        dice: draws which of their optimal plans they follow; None: the canonical one.
        prepared: the task made ready, whose tables they go on with; None: it is made ready.
        plan: what they have in mind at first, by action ids.
    """

    def __init__(
        self,
        task: Task,
        human_model: str = "observant",
        dice: Random | None = None,
        prepared: PreparedTask | None = None,
        plan: HumanPlan = (),
    ) -> None:
        expect(TASK, task=task)
        self._dice = dice
        self._human_model = human_model
        self._joint = [i for i, a in enumerate(task.actions) if a.joint and task.human in a.participants]
        self._begin(prepared or PreparedTask(task), plan)

    def _begin(self, prepared: PreparedTask, plan: HumanPlan = ()) -> None:
        """Begin anew from a state that they know, with a plan in mind, or with nothing."""
        self._task = prepared.task
        self._human = Human(
            prepared, Options(), Deadline(), human_model=self._human_model, actions=self._joint
        )
        self._expected = self._human.packed.pack(self._task.init)
        self._intention = self._human.intends(plan)

    def _packed(self, state: frozenset[int]) -> int:
        """A state, packed; where it does not fit what they know of, they begin anew in it."""
        if not self._task.fits(state):
            self._begin(PreparedTask(self._task.at(state)))
        return self._human.packed.pack(state)

    @property
    def plan(self) -> HumanPlan:
        """See :class:`Person`."""
        return self._intention.actions

    def choose(self, moment: Moment) -> str | None:
        """See :class:`Person`."""
        state, task = self._packed(moment.state), self._task
        human, belief = self._human, self._human.eyes.look(self._expected, state)
        look = human.decide(belief, self._intention)
        if self._dice is not None and look.replanned:
            graph = human.alone.plans(belief)
            assert graph is not None, "who replans has a plan"
            look = look._replace(intention=human.intends(graph.drawn(self._dice.choice)))
        self._expected, self._intention = belief, look.intention
        for step in moment.offers:
            for joint in map(human.packed.op, actions_named(task, step.action, step.agents)):
                if applicable(joint, state) and human.accepts(joint, belief, look.best):
                    self._expected = belief & joint.keep | joint.put
                    return task.actions[joint.action].name
        own = look.intention.op
        if look.best is None or own is None:
            return None
        if applicable(own, state):
            self._expected = belief & own.keep | own.put
            self._intention = look.intention.rest
        else:
            self._expected = human.learn(belief, state, own)
        return task.actions[own.action].name

    def does(self, state: frozenset[int], action: int | None) -> None:
        """Say that they did something else than they had chosen: an own action, or nothing."""
        packed = self._packed(state)
        belief = self._human.eyes.look(self._expected, packed)
        keep, put = (-1, 0) if action is None else self._human.packed.effect(action)
        self._expected = belief & keep | put

    def goes_along(self, state: frozenset[int], name: str | None) -> None:
        """Say that they did as they were told, by a name, which may be what they meant to do anyway."""
        own = self._intention.op
        same = own is not None and self._task.actions[own.action].name == name
        self.does(state, own.action if own is not None and same else None)
        if same:
            self._intention = self._intention.rest

    def _is_stuck(self, state: frozenset[int]) -> bool:
        """Whether they have no plan alone from a state that fits what they last saw."""
        return self._human.stuck(self._human.packed.pack(state))


class Omniscient:
    """Does what the robots' plan says, as the human of the paper; without one, what somebody observant does.

    Args:
        task: where they begin; its goal is theirs.
        plan: what they have in mind at first, by action ids.
    """

    plan: HumanPlan | None = None

    def __init__(self, task: Task, plan: HumanPlan = ()) -> None:
        self._task = task
        self._otherwise = Replanner(task, plan=plan)

    def choose(self, moment: Moment) -> str | None:
        """See :class:`Person`."""
        if not moment.planned:
            return self._otherwise.choose(moment)
        self._otherwise.goes_along(moment.state, moment.wish)
        return moment.wish


class Noisy:
    """Like somebody observant, but with some probability they do something else in an epoch.

    What else they do is drawn from all that they can do alone, waiting included, and from which they
    can still reach their goal alone; then they go on from there as it is best.

    Args:
        task: where they begin; its goal is theirs.
        probability: of something else, in each epoch.
        ties: whether the dice also draw which of their optimal plans they follow.
        prepared: as for :class:`Replanner`.
    """

    def __init__(
        self,
        task: Task,
        probability: float,
        dice: Random,
        *,
        ties: bool = False,
        prepared: PreparedTask | None = None,
    ) -> None:
        self._task = task
        self._probability = probability
        self._dice = dice
        self._usual = Replanner(task, "observant", dice if ties else None, prepared)

    @property
    def plan(self) -> HumanPlan:
        """See :class:`Person`."""
        return self._usual.plan

    def choose(self, moment: Moment) -> str | None:
        """See :class:`Person`."""
        stray = self._dice.random() < self._probability
        if not stray:
            return self._usual.choose(moment)
        self._usual.does(moment.state, None)
        others = [None, *(i for i in self._task.human_actions if self._way_back(moment.state, i))]
        action = self._dice.choice(others)
        self._usual.does(moment.state, action)
        return None if action is None else self._task.actions[action].name

    def _way_back(self, state: frozenset[int], action: int) -> bool:
        ground = self._task.actions[action]
        return ground.applicable(state) and not self._usual._is_stuck(apply(state, ground))


class Recorded:
    """Does what was written down, one action an epoch, then goes on like somebody observant.

    A step that is not possible is tried in vain; from there on they look for themselves.

    Args:
        task: where they begin; its goal is theirs.
        actions: names, ``noop`` for waiting.
    """

    def __init__(self, task: Task, actions: Sequence[str]) -> None:
        self._task = task
        self._left = [canonical_name(name) for name in actions]
        self._next = Replanner(task)

    @property
    def plan(self) -> HumanPlan | None:
        """See :class:`Person`."""
        return None if self._left else self._next.plan

    def choose(self, moment: Moment) -> str | None:
        """See :class:`Person`."""
        if not self._left:
            return self._next.choose(moment)
        name = self._left.pop(0)
        if self._task.waits(name) and name not in self._task.named:
            self._next.does(moment.state, None)
            return None
        if any(step.action == name for step in moment.offers):
            return name
        ids = self._task.named.get(name, ())
        own = [i for i in ids if self._task.actions[i].participants == (self._task.human,)]
        possible = next((i for i in own if self._task.actions[i].applicable(moment.state)), None)
        if possible is None:
            self._left.clear()
            return name if own else self._next.choose(moment)
        self._next.does(moment.state, possible)
        return name


PERSONAS: Final = ("recorded:FILE", "omniscient", "observant", "local", "noisy:P")
"""How people are named."""


@dataclass(frozen=True, slots=True)
class Persona:
    """Somebody who acts in a certain way, again and again.

    Attributes:
        name: ``recorded``, ``omniscient``, ``observant``, ``local`` or ``noisy``.
        probability: of ``noisy``: that they do something else in an epoch.
        actions: of ``recorded``: what was written down.
    """

    name: str
    probability: float = 0.0
    actions: tuple[str, ...] = ()

    @property
    def told(self) -> bool:
        """Whether they know the robots' plan."""
        return self.name == "omniscient"

    @property
    def human_model(self) -> str:
        """What robots take them to be, unless somebody says otherwise."""
        return self.name if self.name in ("omniscient", "local") else "observant"

    def person(
        self, task: Task, dice: Random, *, drawn: bool, prepared: PreparedTask | None = None
    ) -> Person:
        """Somebody who acts like that.

        Args:
            dice: for what they leave to chance.
            drawn: whether that includes which of their optimal plans they follow.
            prepared: the task made ready, whose tables they go on with; None: it is made ready.
        """
        if task.needs_time:
            return self._in_time(task, dice, drawn=drawn)
        if self.name == "omniscient":
            return Omniscient(task)
        if self.name == "noisy":
            return Noisy(task, self.probability, dice, ties=drawn, prepared=prepared)
        if self.name == "recorded":
            return Recorded(task, self.actions)
        return Replanner(task, self.name, dice if drawn else None, prepared)

    def _in_time(self, task: Task, dice: Random, *, drawn: bool) -> Person:
        from serendipity.execution.clock import persons  # only here: most tasks have no time

        if self.name == "omniscient":
            return persons.ToldInTime(task)
        if self.name == "noisy":
            return persons.Unsteady(task, self.probability, dice, drawn=drawn)
        if self.name == "recorded":
            return persons.Record(task, self.actions)
        return persons.Free(task, dice if drawn else None, local=self.name == "local")


def persona_from(task: Task, text: str) -> Persona:
    """The persona that a text names.

    Args:
        task: what they act in.
        text: as in ``PERSONAS``; what follows the name stands behind a colon or a blank.

    Raises:
        UsageError: there is no such persona.
        InputError: the file of ``recorded`` is wrong; it says where.
    """
    name, _, rest = text.strip().replace(" ", ":", 1).partition(":")
    rest = rest.strip()
    if name == "recorded" and rest:
        return Persona(name, actions=recorded_actions(task, Path(rest)))
    if name == "noisy" and rest:
        return Persona(name, probability(rest, "noisy"))
    if name in ("omniscient", "observant", "local") and not rest:
        return Persona(name)
    raise UsageError(f"human: expected one of {', '.join(PERSONAS)}, got '{text:.50}'")


def person_of(task: Task, text: str = "observant", dice: Random | None = None) -> Person:
    """Somebody who acts as a text says, in a task with time or without.

    Args:
        task: where they begin; its goal is theirs.
        text: as in ``PERSONAS``.
        dice: draw which of their optimal plans they follow, and what they leave to chance; None: the
            canonical ones, and dice of their own.

    Raises:
        UsageError: there is no such persona.
        InputError: the file of ``recorded`` is wrong; it says where.
    """
    return persona_from(task, text).person(task, dice or Random(), drawn=dice is not None)
