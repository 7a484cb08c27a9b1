"""The task: agents, facts, ground actions, initial state, goals."""

from collections.abc import Iterable, Iterator, Mapping
from collections.abc import Set as AbstractSet
from dataclasses import InitVar, dataclass, field, replace
from fractions import Fraction
from functools import cached_property
from itertools import accumulate

from serendipity.model.errors import PlanError, UsageError
from serendipity.model.keywords import require_one_of
from serendipity.model.numbers import plain, total
from serendipity.model.resources.deadline import Deadline
from serendipity.model.task.actions import NOOP, Condition, Disjunction, GroundAction, apply, fitted
from serendipity.model.task.course import first_unmet
from serendipity.model.task.names import ActionNames
from serendipity.model.task.names import canonical_name as canonical_name
from serendipity.model.task.plans import PlanEntry, TimedPlan, checked_entries, unknown_action
from serendipity.model.task.plans_in_time import plan_in_time, replayed, times_of
from serendipity.model.task.script import UNDER_WAY, Script, Timeline, moments, resolved
from serendipity.model.task.variables import Variable, find_variables
from serendipity.model.telling import Grid, Line, Told, team

HumanPlan = tuple[int, ...]
"""``pi_H``: action ids in order, without noops; ``pi_H[t]`` is executed in epoch t.

Actions of several epochs follow each other; with waiting in between it is a :class:`.TimedPlan`.
"""


def several(names: Iterable[str], what: str) -> tuple[str, ...]:
    """The names of a list; a text by itself, whose letters would be taken for names, is refused.

    Args:
        what: how an error calls it.

    Raises:
        UsageError: it is a text, or has something else than texts in it.
    """
    listed = isinstance(names, Iterable) and not isinstance(names, str)
    found = tuple(names) if listed else ()
    if not listed or not all(isinstance(name, str) for name in found):
        raise UsageError(f"{what}: expected a list of names, got {names!r:.50}")
    return found


@dataclass(frozen=True, repr=False)
class Task(Told):
    """A multi-agent planning task with one human (Def. 1.0, 1.1; semantics 1).

    Attributes:
        name: for people.
        agents: names, lower case; an agent's id is its index.
        human: id of the human; every other agent is a robot.
        facts: names, lower case; a fact's id is its index.
        init: ids of the facts true initially (the union over the agents).
        goal: the human's goal ``G_H``.
        robot_goal: the robots' own goal ``G_R`` (empty: they have none).
        actions: ascending in ``GroundAction.key``; an action's id is its index.
            No ``noop`` among them.  Several may share one name (disjunctive
            preconditions, conditional effects): those that one state allows have the same effects.
        warnings: lines for the user about the input.
        waiting: names of actions of the input that only wait, each with the agent who
            does: a given plan may name them.
        disjunctions: what those facts stand for that are not of the input; the actions
            keep them true to it.
        script: what happens anyway (semantics 10.3); bystanders are among ``agents``, what they could do
            is not among ``actions``.
        due: facts, each with an action that is done in the next epoch if it holds (:mod:`.unit_steps`).
        at_rest: facts that say of each robot that it is at nothing, as all have to be at the end.
        own_goals: of other agents, by id, as far as the input says whose they are: what they plan for as
            bystanders, or if they are the human instead.
        in_time: the task that this one says in single epochs, else None.
        epoch: of an epoch, how long it is in the unit of the input (of PDDL's durations), for people.
        variables: finite-domain variables behind the facts; each fact is in exactly one.  They
            follow from facts, initial state and actions.

    Args:
        known_variables: the variables, where the caller knows them (finding them takes as long as
            reading the task does, see :func:`.find_variables`); None has them found, without a deadline.
    """

    name: str
    agents: tuple[str, ...]
    human: int
    facts: tuple[str, ...]
    init: frozenset[int]
    goal: Condition
    actions: tuple[GroundAction, ...]
    robot_goal: Condition = field(default_factory=Condition)
    warnings: tuple[str, ...] = ()
    waiting: frozenset[tuple[str, int]] = frozenset()
    disjunctions: tuple[Disjunction, ...] = ()
    script: Timeline = field(default_factory=Timeline)
    epoch: Fraction = field(default=Fraction(1))
    due: tuple[tuple[int, int], ...] = ()
    at_rest: tuple[int, ...] = ()
    own_goals: tuple[tuple[int, Condition], ...] = ()
    in_time: "Task | None" = field(default=None, repr=False, compare=False)
    variables: tuple[Variable, ...] = field(init=False, repr=False, compare=False)
    known_variables: InitVar[tuple[Variable, ...] | None] = field(default=None, kw_only=True)

    def __post_init__(self, known_variables: tuple[Variable, ...] | None) -> None:
        if not 0 <= self.human < len(self.agents):
            raise UsageError("a task needs exactly one human among its agents")
        if self.human in self.script.people:
            raise UsageError(f"script: '{self.agents[self.human]}' is the human, whose plan is no part of it")
        if known_variables is None:
            known_variables = find_variables(self.facts, self.init, moments(self.actions, self.script))
        object.__setattr__(self, "variables", known_variables)

    def told(self) -> Iterator[Line | Grid]:
        """The agents, the size of the task, and its goals."""
        human, robots = self.agents[self.human], [self.agents[i] for i in self.robots]
        yield Line(f"{self.name}: {team(human, robots)}")
        yield Line(
            f"{len(self.facts)} facts in {len(self.variables)} variables, {len(self.actions)} ground actions"
        )
        if self.needs_time:
            yield Line(self._time_told())
        for who, goal in ((human, self.goal), ("robots", self.robot_goal)):
            if goal:
                yield Line(f"goal of {who}: {', '.join(goal.literals(self.facts))}")
        yield from map(Line, self.warnings)

    def _time_told(self) -> str:
        longest = max((action.duration for action in self.actions), default=1)
        told = f"actions of up to {longest} epochs" if longest > 1 else "actions of one epoch"
        told += "" if self.epoch == 1 else f", an epoch being {plain(self.epoch)}"
        if self.script:
            people = [self.agents[i] for i in sorted(self.script.people)]
            beside = f" and the plans of {', '.join(people)}" if people else ""
            told += f"; a script of {len(self.script.facts)} facts{beside}, until epoch {self.script.last}"
        return told

    def _in_short(self) -> Iterator[str]:
        yield repr(self.name)
        yield f"{len(self.agents)} agents"
        yield f"{len(self.facts)} facts"
        yield f"{len(self.actions)} actions"

    @property
    def robots(self) -> tuple[int, ...]:
        """Ids of all agents but the human and bystanders."""
        others = {self.human, *self.script.people}
        return tuple(i for i in range(len(self.agents)) if i not in others)

    @cached_property
    def needs_time(self) -> bool:
        """Whether an action takes more than one epoch, or something happens by a script."""
        return bool(self.script) or any(action.timing is not None for action in self.actions)

    @cached_property
    def digest(self) -> str:
        """A hash of agents, facts, actions and script: the same in every state and for every goal."""
        from hashlib import sha256  # only here: few callers write a task's sessions down

        found = sha256(repr((self.agents, self.human, self.facts)).encode())
        for action in self.actions:
            found.update(repr(action).encode())
        if self.script:
            found.update(repr((self.script.facts, self.script.deeds)).encode())
        return found.hexdigest()

    @cached_property
    def human_actions(self) -> tuple[int, ...]:
        """Ids of the actions that the human does alone."""
        return tuple(i for i, a in enumerate(self.actions) if a.participants == (self.human,))

    @cached_property
    def due_for(self) -> Mapping[int, tuple[tuple[int, ...], ...]]:
        """By fact of :attr:`due` the ids of what is due while it holds: of each of these variants one."""
        found: dict[int, dict[str, tuple[int, ...]]] = {}
        for fact, action in self.due:
            variants = found.setdefault(fact, {})
            name = self.actions[action].name
            variants[name] = (*variants.get(name, ()), action)
        return {fact: tuple(each.values()) for fact, each in found.items()}

    @cached_property
    def of_bystanders(self) -> frozenset[int]:
        """Ids of the actions of bystanders, who choose nothing, and of what robots are in the middle of."""
        people, human = self.script.people, self.human
        actions = enumerate(self.actions) if people else ()
        return frozenset(
            i
            for i, one in actions
            if not people.isdisjoint(one.participants)
            or (one.name.startswith(UNDER_WAY) and human not in one.participants)
        )

    @cached_property
    def unsettled(self) -> frozenset[int]:
        """Facts that choices may change, or whichever variant of an action a bystander does after these."""
        varied = {i for kinds in self.due_for.values() for ids in kinds if len(ids) > 1 for i in ids}
        chosen = (one for i, one in enumerate(self.actions) if i in varied or i not in self.of_bystanders)
        return frozenset(fact for one in chosen for fact in (*one.add, *one.delete))

    @property
    def named(self) -> Mapping[str, tuple[int, ...]]:
        """Action ids by name (names are not unique, see the class)."""
        return ActionNames(self.actions)

    def team_cost(self, action: GroundAction, discount: Fraction) -> Fraction:
        """The cost of an action to the team: full with the human, else discounted (semantics 1)."""
        return action.cost if self.human in action.participants else action.cost * (1 - discount)

    def starts_of(self, plan: HumanPlan) -> tuple[int, ...]:
        """The epoch in which each action of a human plan begins."""
        if isinstance(plan, TimedPlan):
            return plan.starts
        ends = accumulate(self.actions[i].duration for i in plan)
        return tuple(end - self.actions[i].duration + 1 for i, end in zip(plan, ends, strict=True))

    def epochs_of(self, plan: HumanPlan) -> int:
        """The length of a human plan in epochs, waiting included."""
        return plan.length if isinstance(plan, TimedPlan) else sum(self.actions[i].duration for i in plan)

    def replay_alone(self, plan: HumanPlan, *, strict: bool = False) -> list[frozenset[int]]:
        """States ``s_0 .. s_n`` after each epoch while the human executes ``plan`` and robots idle.

        Args:
            plan: the plan.
            strict: whether interference is strict, which matters beside bystanders.

        Raises:
            PlanError: an action is not theirs alone or not applicable, or ``G_H`` is missed.
        """
        if self.needs_time or isinstance(plan, TimedPlan):
            return replayed(self, plan, strict=strict)
        states = [self.init]
        for step, action_id in enumerate(plan, start=1):
            states.append(apply(states[-1], self.step_of(states[-1], action_id, step)))
        self.require_goal(states[-1], plan)
        return states

    def step_of(self, state: AbstractSet[int], action_id: int, step: int) -> GroundAction:
        """The action of a step of the human's plan, which they can begin alone in the state.

        Raises:
            PlanError: they can't.
        """
        action = self.actions[action_id]
        if action.participants == (self.human,):
            if action.applicable(state):
                return action
            reason = f"is not applicable: {first_unmet(action.precondition, state, self.facts)}"
        else:
            reason = f"is not an action that {self.agents[self.human]} can do alone"
        raise PlanError(f"human plan, step {step}: '{action.name}' {reason}", step=step)

    def require_goal(self, state: AbstractSet[int], plan: HumanPlan) -> None:
        """Check that a plan of the human has reached the goal in a state.

        Raises:
            PlanError: it has not.
        """
        if not self.goal.holds(state):
            if not plan:
                raise PlanError("human plan: it has no step, and the goal does not hold")
            last = self.actions[plan[-1]].name
            raise PlanError(f"human plan: the goal does not hold after its last step '{last}'")

    def waits(self, name: str) -> bool:
        """Whether waiting of the human is called so, in some case at least."""
        return name == NOOP or (name, self.human) in self.waiting

    def plan_from_names(self, names: Iterable[PlanEntry], head_start: int = 0) -> HumanPlan:
        """The human plan that a list of action names writes down.

        Waiting is skipped, unless each action comes with the epoch in which it begins: then what is left
        between them is waiting, and a last ``noop`` may say until when.  A name shared by several actions
        is read as the first that is applicable there.

        Args:
            names: the list.
            head_start: epochs of waiting before the plan, which are no part of it.

        Raises:
            PlanError: naming the first step that is unknown, not theirs, or not applicable,
                or saying that the goal is missed.
            UsageError: they are no list of names, or the human waits in it.
        """
        entries = checked_entries(names, "human plan")
        untimed = [entry for entry in entries if isinstance(entry, str)]
        if self.needs_time or len(untimed) < len(entries):
            return plan_in_time(self, entries, head_start)
        plan: list[int] = []
        state = set(self.init)  # moved in place: such plans may be very long
        known: dict[str, tuple[int, ...]] = {}
        for step, text in enumerate(untimed, start=1):
            name = canonical_name(text)
            if name not in known:
                known[name] = self.named.get(name, ())
            ids = known[name]
            chosen = next((i for i in ids if self.actions[i].applicable(state)), None)
            if chosen is None and self.waits(name):
                continue
            if not ids:
                raise unknown_action(step, name)
            chosen = ids[0] if chosen is None else chosen
            plan.append(chosen)
            action = self.step_of(state, chosen, len(plan))
            state.difference_update(action.delete)
            state.update(action.add)
        self.require_goal(state, tuple(plan))
        return tuple(plan)

    def variants_of(self, plan: HumanPlan, head_start: int = 0) -> HumanPlan:
        """The same human plan from this initial state: each action in the variant that is applicable then.

        ``head_start`` is as in :meth:`plan_from_names`.

        Raises:
            PlanError: a step is not applicable, or the goal is missed.
        """
        names = [self.actions[i].name for i in plan]
        if self.needs_time or isinstance(plan, TimedPlan):
            return plan_in_time(self, times_of(self, plan).timed(names), head_start)
        return self.plan_from_names(names)

    def names(self, plan: HumanPlan) -> frozenset[str]:
        """The names of a plan's actions: actions of one name are variants of one (see the class)."""
        return frozenset(self.actions[i].name for i in plan)

    def cost_of(self, plan: HumanPlan) -> Fraction:
        """Sum of the undiscounted costs of a human plan."""
        return total(self.actions[i].cost for i in plan)

    def at(self, state: frozenset[int], deadline: Deadline | None = None) -> "Task":
        """The same task from another state; variables stay where they still fit it.

        What the state says of facts that stand for disjunctions is made to fit the others.

        Args:
            state: ids of the facts that are true in it.
            deadline: polled where variables have to be found anew.

        Raises:
            LimitReachedError: the deadline came first.
            UsageError: it is no set.
        """
        if not isinstance(state, frozenset):
            raise UsageError(f"state: expected a frozenset of ids of facts, got {state!r:.50}")
        state = fitted(state, self.disjunctions)
        if self.fits(state):
            variables = self.variables  # what would be found, or better
        else:
            variables = find_variables(self.facts, state, moments(self.actions, self.script), deadline)
        return replace(self, init=state, known_variables=variables)

    def fits(self, state: frozenset[int]) -> bool:
        """Whether each variable has one value in a state; otherwise it is none of this task's."""
        groups = (variable.facts for variable in self.variables if not variable.boolean)
        return all(len(state.intersection(facts)) == 1 for facts in groups)

    def with_goal(self, goal: Condition, robot_goal: Condition | None = None) -> "Task":
        """The same task with another goal of the human's and, unless that is None, of the robots'."""
        theirs = self.robot_goal if robot_goal is None else robot_goal
        return replace(self, goal=goal, robot_goal=theirs, known_variables=self.variables)

    def with_script(self, script: Script) -> "Task":
        """The same task with more that happens anyway.

        Those whose plans it has become bystanders: only what these plans say is done by them, and what their
        own goals ask for is no goal of the robots'.

        Raises:
            UsageError: there is no such fact or agent, a plan has an action that its person can't do alone,
                or something contradicts itself.
        """
        timeline = resolved(self, script)
        actions = tuple(a for a in self.actions if timeline.people.isdisjoint(a.participants))
        robot_goal = self.robot_goal
        for agent, goal in self.own_goals:
            if agent in timeline.people:
                robot_goal = robot_goal.without(goal)
        return replace(self, actions=actions, script=timeline, robot_goal=robot_goal)

    def with_human(self, human: str) -> "Task":
        """The same task with another agent as the human.

        Raises:
            UsageError: there is no such agent.
        """
        name = canonical_name(human) if isinstance(human, str) else human
        require_one_of("human", name, self.agents)
        return replace(self, human=self.agents.index(name), known_variables=self.variables)
