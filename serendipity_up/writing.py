"""Tasks as problems of unified-planning."""

from collections.abc import Callable, Iterable, Iterator, Sequence
from fractions import Fraction
from math import lcm
from typing import Any

from unified_planning.environment import Environment, get_environment
from unified_planning.model import (
    Action,
    DurativeAction,
    EndTiming,
    Fluent,
    GlobalStartTiming,
    InstantaneousAction,
    Object,
    OpenTimeInterval,
    Problem,
    StartTiming,
)
from unified_planning.model.metrics import MinimizeActionCosts, MinimizeSequentialPlanLength
from unified_planning.model.multi_agent import Agent, MultiAgentProblem

from serendipity.model import Condition, GroundAction, Task, UsageError, exact
from serendipity.model.numbers import Number
from serendipity.model.task.names import unused
from serendipity_up.vocabulary import UPProblem, legal


def to_problem(
    task: Task, *, multi_agent: bool = False, discount: Number = 0, environment: Environment | None = None
) -> UPProblem:
    """A ground problem of unified-planning that states a task.

    Facts become fluents without arguments, ground actions become actions.  The agents are objects, each
    of a type of its own, and an action's parameters are its participants:
    ``from_problem(to_problem(task), human=..., robots=...)`` is the task again up to names and what
    nothing depends on.  A ``Problem`` does not say whose a goal is, so robots' own goals are the
    problem's; its plans are the composite ones without a horizon.  In time all actions are durative, and
    the script is timed effects.

    Args:
        task: the task.
        multi_agent: whether a ``MultiAgentProblem`` is wanted, which has agents and goals of their own,
            but neither joint actions nor costs.
        discount: taken off the costs of actions without the human.
        environment: of the problem; None for the global one.

    Raises:
        UsageError: a ``MultiAgentProblem`` can't say it; it names the action.  Or there are bystanders.
    """
    if task.script.deeds:
        raise UsageError("the plans of bystanders can't be said in a problem of unified-planning")
    taken = exact(discount, "discount")
    writer = _Writer(task, environment or get_environment())
    if multi_agent:
        return writer.multi_agent()
    return writer.single(range(len(task.actions)), (task.goal, task.robot_goal), taken)


def team_problem(task: Task, discount: Fraction) -> tuple[Problem, int]:
    """The joint task for engines that want whole costs: a problem without objects, and its costs' scale.

    Its actions are in the order of the task's.
    """
    scale = lcm(*(task.team_cost(action, discount).denominator for action in task.actions))
    writer = _Writer(task, get_environment())
    goals = (task.goal, task.robot_goal)
    return writer.single(range(len(task.actions)), goals, discount, scale, named=False), scale


def own_problem(task: Task) -> Problem:
    """The human's task alone, likewise: its actions are in the order of ``task.human_actions``."""
    scale = lcm(*(task.actions[i].cost.denominator for i in task.human_actions))
    writer = _Writer(task, get_environment())
    return writer.single(task.human_actions, (task.goal,), Fraction(0), scale, named=False)


class _Writer:
    """Makes one problem of a task."""

    def __init__(self, task: Task, environment: Environment) -> None:
        self._task = task
        self._environment = environment
        self._values = environment.expression_manager
        used = set(task.agents)
        self._types = _words([f"type of {name}" for name in ("agent", *task.agents)], used)
        self._fluents = [Fluent(word, environment=environment) for word in _words(task.facts, used)]
        self._names = _words([action.name for action in task.actions], used)
        self._in_time = task.needs_time

    def single(
        self,
        actions: Sequence[int],
        goals: Iterable[Condition],
        discount: Fraction,
        scale: int = 1,
        *,
        named: bool = True,
    ) -> Problem:
        """A ``Problem``; ``named`` says whether there are objects for the agents."""
        problem = Problem(self._task.name, self._environment)
        kinds = self._agents(problem) if named else None
        self._facts(problem.add_fluent, problem.set_initial_value)
        costs: dict[Action, Any] = {}
        for i in actions:
            action = self._action(i, kinds)
            problem.actions.append(action)  # add_action looks through all others for its name
            costs[action] = _number(self._task.team_cost(self._task.actions[i], discount) * scale)
        for fact in self._task.script.facts:
            at = GlobalStartTiming(_number(fact.epoch * self._task.epoch))
            problem.add_timed_effect(at, self._fluents[fact.fact], fact.true)
        for goal in goals:
            self._goal(goal, problem.add_goal)
        if not named and len(set(costs.values())) == 1:
            problem.add_quality_metric(MinimizeSequentialPlanLength(self._environment))
        else:
            problem.add_quality_metric(MinimizeActionCosts(costs, environment=self._environment))
        return problem

    def multi_agent(self) -> MultiAgentProblem:
        """A ``MultiAgentProblem``."""
        task = self._task
        unfit = next((action for action in task.actions if action.joint or action.cost != 1), None)
        if unfit is not None:
            why = "has several participants" if unfit.joint else f"costs {float(unfit.cost):g}"
            raise UsageError(f"a MultiAgentProblem can't say that action '{unfit.name}' {why}")
        if task.script:
            raise UsageError("a MultiAgentProblem has no timed effects")
        problem = MultiAgentProblem(task.name, self._environment)
        agents = [Agent(name, problem) for name in task.agents]
        self._facts(problem.ma_environment.add_fluent, problem.set_initial_value)
        for i, action in enumerate(task.actions):
            agents[action.participants[0]].add_action(self._action(i, None))
        for agent in agents:
            problem.add_agent(agent)
        self._goal(task.goal, agents[task.human].add_public_goal)
        self._goal(task.robot_goal, problem.add_goal)
        return problem

    def _agents(self, problem: Problem) -> list[Any]:
        """The objects, and the type of each."""
        above, *names = self._types
        manager = self._environment.type_manager
        base = manager.UserType(above)
        kinds = [manager.UserType(name, base) for name in names]
        for name, kind in zip(self._task.agents, kinds, strict=True):
            problem.add_object(Object(name, kind, self._environment))
        return kinds

    def _facts(self, add: Callable[..., Any], set_value: Callable[..., Any]) -> None:
        for fluent in self._fluents:
            add(fluent, default_initial_value=False)
        for fact in sorted(self._task.init):
            set_value(self._values.FluentExp(self._fluents[fact]), True)

    def _action(self, number: int, kinds: Sequence[Any] | None) -> InstantaneousAction | DurativeAction:
        ground: GroundAction = self._task.actions[number]
        who = {} if kinds is None else {self._task.agents[i]: kinds[i] for i in ground.participants}
        if self._in_time:
            return self._durative(self._names[number], ground, who)
        action = InstantaneousAction(self._names[number], _env=self._environment, **who)
        for literal in self._literals(ground.precondition):
            action.add_precondition(literal)
        for fluent, value in self._changes(ground.add, ground.delete):
            action.add_effect(fluent, value)
        return action

    def _durative(self, name: str, ground: GroundAction, who: dict[str, Any]) -> DurativeAction:
        action = DurativeAction(name, _env=self._environment, **who)
        action.set_fixed_duration(_number(ground.duration * self._task.epoch))
        start, end, timing = StartTiming(), EndTiming(), ground.timing
        for literal in self._literals(ground.precondition):
            action.add_condition(start, literal)
        for fluent, value in self._changes(ground.add, ground.delete):
            action.add_effect(end, fluent, value)
        if timing is not None:
            for interval, condition in (
                (OpenTimeInterval(start, end), timing.over_all),
                (end, timing.at_end),
            ):
                for literal in self._literals(condition):
                    action.add_condition(interval, literal)
            for fluent, value in self._changes(timing.start_add, timing.start_delete):
                action.add_effect(start, fluent, value)
        return action

    def _changes(self, add: Iterable[int], delete: Iterable[int]) -> Iterator[tuple[Fluent, bool]]:
        yield from ((self._fluents[fact], False) for fact in delete)
        yield from ((self._fluents[fact], True) for fact in add)

    def _goal(self, goal: Condition, add: Callable[[Any], Any]) -> None:
        for literal in self._literals(goal):
            add(literal)

    def _literals(self, condition: Condition) -> list[Any]:
        positive = [self._values.FluentExp(self._fluents[fact]) for fact in condition.positive]
        negative = [self._values.FluentExp(self._fluents[fact]) for fact in condition.negative]
        return [*positive, *map(self._values.Not, negative)]


def _words(names: Iterable[str], used: set[str]) -> list[str]:
    """A word for each name, equal names among them; none that is used by another."""
    return [unused(legal(name), used) for name in names]


def _number(cost: Fraction) -> int | Fraction:
    return int(cost) if cost.denominator == 1 else cost
