"""A problem's agents, types, objects, fluents and actions, and what each is called in a task.

What an agent of a ``MultiAgentProblem`` has of its own is called after it: the fluent ``pos`` of
``robot`` makes facts ``pos robot room1``, its action ``move`` actions ``move robot room1 room2``.
"""

import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import Final, TypeAlias

from unified_planning.model import Action, Fluent, Object, Problem
from unified_planning.model import Type as UPType
from unified_planning.model.multi_agent import Agent, MultiAgentProblem
from unified_planning.plans import ActionInstance

from serendipity.model import UsageError
from serendipity.model.task.actions import NOOP
from serendipity.model.task.names import unused
from serendipity.pddl.parsing.types import OBJECT, Type, Types
from serendipity_up.kinds import refusal

_ILLEGAL: Final = re.compile(r"[^\w-]")


class UniqueWords:
    """A word for each name, none of them taken: lower case, no blanks, different where names are."""

    def __init__(self, names: Iterable[str], taken: Iterable[str] = ()) -> None:
        used = set(taken)
        self._words: dict[str, str] = {}
        for name in names:
            if name not in self._words:
                self._words[name] = unused(legal(name), used)

    def __getitem__(self, name: str) -> str:
        return self._words[name]

    @property
    def names(self) -> Mapping[str, str]:
        """The names by their words."""
        return {word: name for name, word in self._words.items()}


def legal(name: str) -> str:
    """A name as one word, in lower case."""
    return _ILLEGAL.sub("_", name.lower()) or "_"


UPProblem: TypeAlias = Problem | MultiAgentProblem

Owner: TypeAlias = Agent | None
"""Whose fluent or action it is: an agent's of a ``MultiAgentProblem``, or None for what everybody shares."""

ALONE: Final = "agent"
"""Who acts in a problem that names no agents."""


class Vocabulary:
    """The names of a problem, both ways."""

    def __init__(self, problem: UPProblem) -> None:
        if not isinstance(problem, UPProblem):
            raise refusal(problem, f"{type(problem).__name__}: not supported")
        self.problem = problem
        self.agents: Sequence[Agent] = tuple(problem.agents) if isinstance(problem, MultiAgentProblem) else ()
        self.owners: Sequence[Owner] = self.agents or (None,)
        self.agent_words = UniqueWords(agent.name for agent in self.agents)
        self._objects = UniqueWords((o.name for o in problem.all_objects), self.agent_words.names)
        self._types = UniqueWords((kind.name for kind in problem.user_types), (OBJECT,))
        self._fluents = UniqueWords(fluent.name for _, fluent in self.fluents())
        self._actions = UniqueWords((action.name for _, action in self.actions()), (NOOP,))
        self._action_names = self._actions.names
        self._object_names = self._objects.names
        self._owners_by_word = {self.agent_words[agent.name]: agent for agent in self.agents}

    @property
    def agent_names(self) -> Mapping[str, str]:
        """The names of the agents, or of the objects where these are agents, by their words."""
        return self.agent_words.names if self.agents else self._object_names

    def fluents(self) -> Iterator[tuple[Owner, Fluent]]:
        """All fluents with their owners."""
        shared = (
            self.problem.ma_environment.fluents
            if isinstance(self.problem, MultiAgentProblem)
            else self.problem.fluents
        )
        yield from ((None, fluent) for fluent in shared)
        for agent in self.agents:
            yield from ((agent, fluent) for fluent in agent.fluents)

    def actions(self) -> Iterator[tuple[Owner, Action]]:
        """All actions with their owners."""
        for agent in self.agents:
            yield from ((agent, action) for action in agent.actions)
        if isinstance(self.problem, Problem):
            yield from ((None, action) for action in self.problem.actions)

    def objects(self) -> dict[str, Type]:
        """The types of all objects, by the objects' words."""
        return {self.object(o): self.type(o.type) for o in self.problem.all_objects}

    def types(self) -> Types:
        """The type hierarchy."""
        parents = {
            self._types[kind.name]: (OBJECT,) if kind.father is None else (self._types[kind.father.name],)
            for kind in self.problem.user_types
        }
        return Types(parents)

    def object(self, thing: Object) -> str:
        """An object's word."""
        return self._objects[thing.name]

    def type(self, kind: UPType) -> Type:
        """A user type's."""
        if not kind.is_user_type():
            raise refusal(self.problem, f"parameters of type '{kind}' are not supported")
        return (self._types[kind.name],)

    def predicate(self, owner: Owner, fluent: Fluent) -> str:
        """What facts about a fluent begin with."""
        return self._owned(self._fluents[fluent.name], owner)

    def schema(self, owner: Owner, action: Action) -> str:
        """What ground actions of an action begin with."""
        return self._owned(self._actions[action.name], owner)

    def instance(self, name: str) -> ActionInstance:
        """What a ground action of the task is in the problem; a UsageError where that has no such name."""
        head, *words = name.split()
        owner = self._owners_by_word.get(words.pop(0)) if self.agents and words else None
        source = self.problem if owner is None else owner
        if head not in self._action_names or (self.agents and owner is None):
            raise UsageError(f"action '{name}': there is no such action in the problem")
        action = source.action(self._action_names[head])
        things = [self.problem.object(self._object_names[word]) for word in words]
        return ActionInstance(action, tuple(things), agent=owner)

    def name_of(self, instance: ActionInstance) -> str:
        """What an action of a plan is called in the task."""
        try:
            owner = None
            if self.agents and instance.agent is not None:
                owner = self._owners_by_word[self.agent_words[instance.agent.name]]
            things = [self._objects[p.object().name] for p in instance.actual_parameters]
            return " ".join([self._owned(self._actions[instance.action.name], owner), *things])
        except KeyError:
            raise UsageError(f"action '{instance}' of the plan is not of the problem") from None

    def _owned(self, word: str, owner: Owner) -> str:
        return word if owner is None else f"{word} {self.agent_words[owner.name]}"
