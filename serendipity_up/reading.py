"""Problems of unified-planning to tasks."""

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from functools import cached_property
from typing import Final, TypeAlias

from unified_planning.model import (
    Action,
    DurativeAction,
    Fluent,
    FNode,
    InstantaneousAction,
    Object,
    Problem,
)
from unified_planning.model import Type as UPType
from unified_planning.model.fluent import get_all_fluent_exp
from unified_planning.model.metrics import MinimizeActionCosts, PlanQualityMetric

from serendipity.model import Deadline, Task
from serendipity.pddl.grounding.assemble import Blueprint, Source, assemble
from serendipity.pddl.grounding.instantiate import Participants
from serendipity.pddl.parsing import lifted
from serendipity.pddl.parsing.types import Type
from serendipity.pddl.participants import by_arguments, by_owner
from serendipity.pddl.work import Work, within_limits
from serendipity_up.agents import Cast, cast_of
from serendipity_up.conditions import Reader, effects_of
from serendipity_up.durations import durative_schema, timed_literals
from serendipity_up.expressions import number_of
from serendipity_up.kinds import in_time, refusal, require_supported
from serendipity_up.vocabulary import Owner, UPProblem, Vocabulary

Named: TypeAlias = str | Object | UPType
"""An agent: its name, its object, or the type of the objects that are agents."""

_OVER: Final = lifted.Literal(("~over",))
"""All timed effects have come: goals of the library hold at the end of all."""


@dataclass(frozen=True, slots=True)
class ReadProblem:
    """A problem that was read, and the actions left out, in which none of the agents takes part."""

    task: Task
    vocabulary: Vocabulary
    left_out: list[str] = field(default_factory=list)

    @property
    def in_time(self) -> bool:
        """Whether plans say when actions begin."""
        return in_time(self.vocabulary.problem)


def from_problem(
    problem: UPProblem,
    *,
    human: Named | None = None,
    robots: Named | Iterable[Named] | None = None,
    deadline: Deadline | None = None,
) -> Task:
    """The task that a problem of unified-planning states.

    In a ``MultiAgentProblem`` the agents are the problem's.  The human's goal is their own, or that of
    the problem if they have none; all other goals are the robots'.  In a ``Problem`` agents are objects:
    an action's participants are the agents among its arguments, and its goal is the human's.  A
    ``Problem`` for which no agents are named is that of a single one, who does all.

    Args:
        problem: the problem; it is not changed.
        human: who is the human; None for the only agent with a goal of its own.
        robots: the robots, by names, objects or types; None for all other agents, in a ``Problem`` for
            the other objects of the human's type.
        deadline: how long it may take, and in how much memory.

    Raises:
        InputError: the problem has something that is not supported; it says what.
        UsageError: an agent is not of the problem, or it is not clear who is the human.
        LimitReachedError: the deadline came first.
    """
    return read(problem, human, robots, deadline).task


def read(
    problem: UPProblem,
    human: Named | None = None,
    robots: Named | Iterable[Named] | None = None,
    deadline: Deadline | None = None,
) -> ReadProblem:
    """:func:`from_problem` with what it takes to write plans of the problem."""
    vocabulary = Vocabulary(problem)
    require_supported(problem)
    cast = cast_of(vocabulary, human, robots)
    left_out: list[str] = []
    task = within_limits(lambda work: _read(vocabulary, cast, left_out, work), deadline)
    return ReadProblem(task, vocabulary, left_out)


def _read(vocabulary: Vocabulary, cast: Cast, left_out: list[str], work: Work) -> Task:
    problem = vocabulary.problem
    writer = _Translator(vocabulary, work)
    schemas = {owner: tuple(writer.schemas(owner)) for owner in vocabulary.owners}
    domain = writer.domain(tuple(schema for some in schemas.values() for schema in some))
    goals = writer.unit(domain, cast.goals, lasting=True)
    sources = [Source(goals, some, _participants(cast, owner)) for owner, some in schemas.items()]

    def reason(key: lifted.Key) -> str:
        left_out.append(" ".join(key))
        return f"action '{key[0]}': no agent is among its arguments"

    blueprint = Blueprint(
        name=problem.name or "problem",
        agents=cast.names,
        human=cast.human,
        sources=sources,
        goals=goals,
        robot_goals=[writer.unit(domain, cast.other_goals)] if cast.other_goals else [],
        left_out=reason,
    )
    return assemble(blueprint, work)


def _participants(cast: Cast, owner: Owner) -> Participants:
    if owner is not None:
        return by_owner(cast.owners.index(owner))
    return by_arguments(cast.names) if cast.objects else by_owner(0)


class _Translator:
    """Puts a problem into the grounder's words."""

    def __init__(self, vocabulary: Vocabulary, work: Work) -> None:
        self.vocabulary = vocabulary
        self.problem = vocabulary.problem
        self._work = work
        self._metric = _metric(vocabulary)
        self._initial = _Initial(vocabulary)

    def schemas(self, owner: Owner) -> Iterator[lifted.Schema]:
        """The actions of an owner."""
        for whose, action in self.vocabulary.actions():
            if whose is owner:
                self._work.deadline.check()
                yield self._schema(owner, action)

    def domain(self, schemas: tuple[lifted.Schema, ...]) -> lifted.Domain:
        """All but the initial state and the goal."""
        vocabulary = self.vocabulary
        predicates: dict[str, tuple[Type, ...]] = {}
        for owner, fluent in vocabulary.fluents():
            if not _numeric(fluent):
                types = [vocabulary.type(parameter.type) for parameter in fluent.signature]
                value = [] if fluent.type.is_bool_type() else [vocabulary.type(fluent.type)]
                predicates[vocabulary.predicate(owner, fluent)] = (*types, *value)
        predicates[_OVER.key[0]] = ()
        return lifted.Domain(_title(self.problem), vocabulary.types(), {}, predicates, {}, schemas)

    def unit(
        self, domain: lifted.Domain, goals: Sequence[tuple[Owner, FNode]], *, lasting: bool = False
    ) -> lifted.Unit:
        """The problem with some of its goals; ``lasting``: once all timed effects have come."""
        parts = [Reader(self.vocabulary, owner).formula(goal) for owner, goal in goals]
        if lasting and self._timed:
            parts.append(_OVER)
        checked = lifted.Problem(
            name=_title(self.problem),
            domain_name=None,
            objects=self.vocabulary.objects(),
            init=self._initial.true,
            denied={},
            values=self._initial.values,
            goal=lifted.And(tuple(parts)),
            goal_line=None,
            metric=self._metric is not None,
            timed=self._timed,
        )
        return lifted.Unit(None, _title(self.problem), _title(self.problem), domain, checked)

    @cached_property
    def _timed(self) -> tuple[lifted.TimedLiteral, ...]:
        """What timed effects make of facts, and that all have come."""
        effects = self.problem.timed_effects if isinstance(self.problem, Problem) else {}
        reader = Reader(self.vocabulary)
        found = [one for timing, some in effects.items() for one in timed_literals(reader, timing, some)]
        last = max((literal.time for literal in found), default=None)
        return () if last is None else (*found, lifted.TimedLiteral(last, _OVER, 0))

    def _schema(self, owner: Owner, action: Action) -> lifted.Schema:
        name, reader = self.vocabulary.schema(owner, action), Reader(self.vocabulary, owner)
        if isinstance(action, DurativeAction):
            return durative_schema(reader, action, name, self._increases(action))
        if not isinstance(action, InstantaneousAction) or action.simulated_effect is not None:
            raise refusal(self.problem, f"action '{action.name}': {type(action).__name__} is not supported")
        precondition: lifted.Formula = lifted.And(tuple(map(reader.formula, action.preconditions)))
        effects = tuple(e for effect in action.effects for e in effects_of(reader, effect, precondition))
        return lifted.Schema(
            name,
            0,
            tuple(map(reader.parameter, action.parameters)),
            precondition,
            effects,
            self._increases(action),
            quantified=reader.quantified,
        )

    def _increases(self, action: Action) -> tuple[lifted.Expression, ...]:
        if not isinstance(self._metric, MinimizeActionCosts):
            return () if self._metric is None else (Fraction(1),)
        cost = self._metric.get_action_cost(action)
        return () if cost is None else (number_of(Reader(self.vocabulary), cost, "a cost"),)


class _Initial:
    """The atoms that are true in the beginning, and the numbers that costs depend on."""

    def __init__(self, vocabulary: Vocabulary) -> None:
        self.true: dict[lifted.Key, None] = {}
        self.values: dict[lifted.Key, Fraction] = {}
        self._vocabulary = vocabulary
        self._owners = {agent.name: agent for agent in vocabulary.agents}
        explicit = vocabulary.problem.explicit_initial_values
        for node, value in explicit.items():
            self._add(node, value)
        for owner, fluent in vocabulary.fluents():
            self._add_defaults(owner, fluent, explicit)

    def _add_defaults(self, owner: Owner, fluent: Fluent, explicit: dict[FNode, FNode]) -> None:
        problem = self._vocabulary.problem
        shared = problem if isinstance(problem, Problem) else problem.ma_environment
        default = (shared if owner is None else owner).fluents_defaults.get(fluent)
        if default is not None and default.is_false():
            return
        for node in get_all_fluent_exp(problem, fluent):
            if owner is not None:
                node = problem.environment.expression_manager.Dot(owner, node)
            if node not in explicit:
                if default is None and not _numeric(fluent):
                    raise refusal(problem, f"'{node}' has no initial value")
                if default is not None:
                    self._add(node, default)

    def _add(self, node: FNode, value: FNode) -> None:
        owner = self._owners[node.agent()] if node.is_dot() else None
        inner = node.arg(0) if node.is_dot() else node
        fluent = inner.fluent()
        words = tuple(self._vocabulary.object(argument.object()) for argument in inner.args)
        if _numeric(fluent):
            self.values[(fluent.name, *words)] = Fraction(value.constant_value())
            return
        key = (self._vocabulary.predicate(owner, fluent), *words)
        if value.is_object_exp():
            self.true[(*key, self._vocabulary.object(value.object()))] = None
        elif value.is_true():
            self.true[key] = None


def _numeric(fluent: Fluent) -> bool:
    return not (fluent.type.is_bool_type() or fluent.type.is_user_type())


def _title(problem: UPProblem) -> str:
    return problem.name or "problem"


def _metric(vocabulary: Vocabulary) -> PlanQualityMetric | None:
    metrics: list[PlanQualityMetric] = list(getattr(vocabulary.problem, "quality_metrics", ()))
    if len(metrics) > 1:
        raise refusal(vocabulary.problem, f"expected at most one metric, got {len(metrics)}")
    return next(iter(metrics), None)
