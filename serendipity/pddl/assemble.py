"""United files to a task: ground once, prune, number the facts."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from itertools import chain
from operator import attrgetter

from serendipity.model import Condition, GroundAction, InputError, Task
from serendipity.model.collection import no_collection
from serendipity.pddl.instantiate import FactTable, Instantiator, Participants, Record
from serendipity.pddl.join import Relations
from serendipity.pddl.lifted import EQUALITY, Key, Literal, Schema, Unit
from serendipity.pddl.normal import Decide, TooManyCasesError, clauses, operator
from serendipity.pddl.prune import executable


@dataclass(frozen=True, slots=True)
class Source:
    """Files, which of their actions count, and who takes part in those.

    Attributes:
        unit: the files.
        schemas: the actions that count.
        participants: see :data:`Participants`.
    """

    unit: Unit
    schemas: tuple[Schema, ...]
    participants: Participants


@dataclass(slots=True)
class Blueprint:
    """All that a task is made of, before grounding.

    Attributes:
        name: for people.
        agents: names.
        human: id of the human.
        sources: the files.
        goals: the unit that states the human's goal.
        robot_goals: units that state goals beyond his.
        warnings: about the input.
    """

    name: str
    agents: tuple[str, ...]
    human: int
    sources: list[Source]
    goals: Unit
    robot_goals: list[Unit] = field(default_factory=list)
    warnings: list[str] = field(default_factory=list)


def assemble(blueprint: Blueprint) -> Task:
    """Ground a blueprint.

    Raises:
        InputError: costs, goals or conditions that are not supported.
    """
    with no_collection():  # grounding makes many tuples
        return _assemble(blueprint)


def _assemble(blueprint: Blueprint) -> Task:
    units = [source.unit for source in blueprint.sources]
    relations = _relations(blueprint.sources, units)
    instantiator = Instantiator(relations, _values(units))
    records: list[Record] = []
    for source in blueprint.sources:
        for schema in source.schemas:
            ground = instantiator.records(operator(schema, source.unit), source.unit, source.participants)
            records += ground
    records = _owned(records, blueprint.warnings)
    facts = instantiator.facts
    goal = _goal(blueprint.goals, relations)
    robot_goal = [g for unit in blueprint.robot_goals for g in _goal(unit, relations) if g not in goal]
    ids = [facts[literal.key] for literal in chain(goal, robot_goal)]
    init = {facts[key] for key in relations.init if key in facts}
    kept = executable(records, init, len(facts))
    return _Numbering(facts, init, kept, ids).task(blueprint, goal, list(dict.fromkeys(robot_goal)))


def _owned(records: list[Record], warnings: list[str]) -> list[Record]:
    """The records in which somebody takes part; a warning for the others, noops aside."""
    nobody = {record.key[0] for record in records if not record.participants and any(record[2:6])}
    for name in sorted(nobody):
        warnings.append(f"action '{name}': left out where no agent is among its arguments")
    return [record for record in records if record.participants]


def _relations(sources: Iterable[Source], units: Iterable[Unit]) -> Relations:
    effects = [effect.literal for source in sources for schema in source.schemas for effect in schema.effects]
    fluent = frozenset([literal.key[0] for literal in effects])
    added = frozenset([literal.key[0] for literal in effects if literal.positive])
    return Relations(chain.from_iterable(unit.problem.init for unit in units), fluent, added)


def _values(units: Iterable[Unit]) -> dict[Key, Fraction]:
    values: dict[Key, Fraction] = {}
    for unit in units:
        for key, value in unit.problem.values.items():
            if values.setdefault(key, value) != value:
                other = f"{float(values[key]):g} in another agent's file"
                raise InputError(f"'{' '.join(key)}' is {float(value):g} here, {other}", unit.problem_file)
    return values


def _goal(unit: Unit, relations: Relations) -> list[Literal]:
    """The goal as literals, without equalities.

    Static facts stay in it, so that an impossible goal is one that can't be reached;
    they decide only what would be a disjunction without them.
    """

    def equalities(literal: Literal) -> bool | None:
        return relations.holds(literal, literal.key) if literal.key[0] == EQUALITY else None

    attempts: tuple[Decide, ...] = (equalities, relations.decide)
    found = []
    for decide in attempts:
        try:
            found = clauses(unit.problem.goal, unit, decide)
        except TooManyCasesError:
            continue
        if len(found) == 1:
            return sorted(found[0])
    what = "disjunctive goals are not supported" if found else "the goal can never hold"
    raise unit.problem_error(what, unit.problem.goal_line)


class _Numbering:
    """Final ids: facts that matter in the order of their names, actions in that of theirs."""

    def __init__(self, facts: FactTable, init: set[int], kept: list[Record], goal_ids: Iterable[int]) -> None:
        deleted = set(chain.from_iterable([r.delete for r in kept]))
        added = set(chain.from_iterable([r.add for r in kept]))
        self.always = init - deleted
        self.never = set(range(len(facts))) - init - added
        needed = set(chain.from_iterable([r.pre for r in kept]))
        forbidden = set(chain.from_iterable([r.neg for r in kept]))
        relevant = added | deleted | needed | forbidden
        relevant -= self.always | (self.never - deleted)
        relevant.update(goal_ids)
        names = sorted((" ".join(key), old) for key, old in facts.items() if old in relevant)
        self.names = tuple([name for name, _ in names])
        self.ids = {old: new for new, (_, old) in enumerate(names)}
        self.facts = facts
        self.init = init
        self.kept = kept

    def task(self, blueprint: Blueprint, goal: list[Literal], robot_goal: list[Literal]) -> Task:
        task = Task(
            name=blueprint.name,
            agents=blueprint.agents,
            human=blueprint.human,
            facts=self.names,
            init=frozenset(self.ids[old] for old in self.init if old in self.ids),
            goal=self._condition(goal),
            actions=tuple(self._actions()),
            robot_goal=self._condition(robot_goal),
            warnings=tuple(blueprint.warnings),
        )
        _ = task.variables  # part of grounding: found here, so that no planning call's deadline pays for it
        return task

    def _condition(self, literals: Sequence[Literal]) -> Condition:
        return Condition(
            tuple(sorted({self.ids[self.facts[lit.key]] for lit in literals if lit.positive})),
            tuple(sorted({self.ids[self.facts[lit.key]] for lit in literals if not lit.positive})),
        )

    def _actions(self) -> list[GroundAction]:
        actions = []
        number, always = self.ids.__getitem__, self.always
        for key, participants, pre, neg, add, delete, cost in self.kept:
            if always:
                pre = tuple([fact for fact in pre if fact not in always])
                add = tuple([fact for fact in add if fact not in always])
            if neg:
                neg = tuple([fact for fact in neg if fact not in self.never])
            if not (pre or neg or add or delete):
                continue  # a noop
            actions.append(
                GroundAction(
                    " ".join(key),
                    participants,
                    tuple(sorted({*map(number, pre)})),
                    tuple(sorted({*map(number, neg)})) if neg else (),
                    tuple(sorted({*map(number, add)})),
                    tuple(sorted([number(fact) for fact in {*delete} if fact not in add])),
                    cost,
                )
            )
        return _sorted(actions)


def _sorted(actions: list[GroundAction]) -> list[GroundAction]:
    """Ascending in name, then in all the rest; each once.

    A blank is less than any character of a word, so this is the order of ``key``.
    """
    if len({action.name for action in actions}) == len(actions):
        return sorted(actions, key=attrgetter("name"))
    return sorted(set(actions), key=attrgetter(*GroundAction.__slots__))
