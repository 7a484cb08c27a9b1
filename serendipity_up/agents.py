"""Who is the human, who are the robots, and whose goals are whose."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Any

from unified_planning.model import FNode, Object
from unified_planning.model import Type as UPType
from unified_planning.model.multi_agent import Agent, MultiAgentProblem

from serendipity.model import UsageError
from serendipity.model.arguments import shown
from serendipity_up.vocabulary import ALONE, Owner, Vocabulary

Goals = tuple[tuple[Owner, FNode], ...]
"""Goals, and whose fluents they are about where they don't say it."""


@dataclass(frozen=True, slots=True)
class Cast:
    """The agents of a task.

    Attributes:
        human: index of the human.
        other_goals: those of the robots and of the team.
        owners: the agents of a ``MultiAgentProblem``, in the order of the names.
        objects: whether the agents are objects.
    """

    names: tuple[str, ...]
    human: int
    goals: Goals
    other_goals: Goals = ()
    owners: Sequence[Agent] = ()
    objects: bool = False


def cast_of(vocabulary: Vocabulary, human: Any, robots: Any) -> Cast:
    """Who is who; see :func:`serendipity_up.from_problem`."""
    if isinstance(vocabulary.problem, MultiAgentProblem):
        return _of_agents(vocabulary, vocabulary.problem, human, robots)
    goals = tuple((None, goal) for goal in vocabulary.problem.goals)
    if human is None:
        if robots is not None:
            raise UsageError("robots: expected a human, too")
        return Cast((ALONE,), 0, goals)
    return _of_objects(vocabulary, human, robots, goals)


def _of_agents(vocabulary: Vocabulary, problem: MultiAgentProblem, human: Any, robots: Any) -> Cast:
    by_name = {agent.name: agent for agent in vocabulary.agents}
    if not by_name:
        raise UsageError("the problem has no agents")
    own = {agent.name: (*agent.public_goals, *agent.private_goals) for agent in vocabulary.agents}
    chosen = _text(human) if human is not None else _only_with_goal(own)
    others = [name for name in by_name if name != chosen] if robots is None else _texts(robots)
    for name in (chosen, *others):
        if name not in by_name:
            raise UsageError(f"agent '{name}': expected one of {', '.join(by_name)}")
    names = [chosen, *others]
    if len(names) != len(set(names)) or len(names) != len(by_name):
        raise UsageError(f"robots: expected each agent but the human, once: {', '.join(by_name)}")
    team = tuple((None, goal) for goal in problem.goals)
    theirs = {name: tuple((by_name[name], goal) for goal in goals) for name, goals in own.items()}
    rest = tuple(goal for name in others for goal in theirs[name])
    first, second = (theirs[chosen], (*team, *rest)) if theirs[chosen] else (team, rest)
    words = tuple(vocabulary.agent_words[name] for name in names)
    return Cast(words, 0, first, second, [by_name[name] for name in names])


def _only_with_goal(own: dict[str, tuple[FNode, ...]]) -> str:
    """The only agent with a goal of its own; the first where all goals are the team's."""
    with_goal = [name for name, goals in own.items() if goals]
    if len(with_goal) > 1:
        raise UsageError(f"human: {', '.join(with_goal)} have goals: say which one is the human")
    return with_goal[0] if with_goal else next(iter(own))


def _of_objects(vocabulary: Vocabulary, human: Any, robots: Any, goals: Goals) -> Cast:
    (chosen, *more) = _objects(vocabulary, human)
    if more:
        raise UsageError(f"human: expected one object, got {len(more) + 1} of type '{_text(human)}'")
    everyone = vocabulary.problem.all_objects
    if robots is None:
        kin = chosen.type
        found = [thing for thing in everyone if thing.type == kin and thing is not chosen]
        if not found:
            raise UsageError(f"robots: there is no other object of type '{kin}': say which are robots")
    else:
        found = [thing for one in _several(robots) for thing in _objects(vocabulary, one) if thing != chosen]
    names = tuple(vocabulary.object(thing) for thing in (chosen, *found))
    if len(names) != len(set(names)):
        raise UsageError("robots: an agent is named twice")
    if len(names) == 1:
        raise UsageError("robots: expected at least one besides the human")
    return Cast(names, 0, goals, objects=True)


def _objects(vocabulary: Vocabulary, one: Any) -> list[Object]:
    """The objects that somebody names: one, or all of a type."""
    problem, name = vocabulary.problem, _text(one)
    found = [thing for thing in problem.all_objects if thing.name == name]
    if not found and problem.has_type(name):
        found = list(problem.objects(problem.user_type(name)))
    if not found:
        raise UsageError(f"agent '{name}': there is no such object, and no object of such a type")
    return found


def _texts(some: Any) -> list[str]:
    return [_text(one) for one in _several(some)]


def _several(some: Any) -> list[Any]:
    if isinstance(some, str | Agent | Object | UPType):
        return [some]
    if not isinstance(some, Iterable):
        raise UsageError(f"robots: expected names, or what has one, got {shown(some)}")
    return list(some)


def _text(one: Any) -> str:
    if not isinstance(one, str) and not isinstance(getattr(one, "name", None), str):
        raise UsageError(f"agent: expected a name, or what has one, got {shown(one)}")
    return one if isinstance(one, str) else str(one.name)
