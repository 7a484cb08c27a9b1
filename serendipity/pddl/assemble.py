"""United files to a task: ground once, prune, number the facts."""

from collections.abc import Iterable
from dataclasses import dataclass, field
from fractions import Fraction
from itertools import chain

from serendipity.model import InputError, Task
from serendipity.model.collection import no_collection
from serendipity.pddl.blocks import Block
from serendipity.pddl.instantiate import Instantiator, Participants
from serendipity.pddl.join import Relations
from serendipity.pddl.lifted import EQUALITY, Key, Literal, Schema, Unit
from serendipity.pddl.normal import Decide, TooManyCasesError, clauses, operator
from serendipity.pddl.numbering import Numbering
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
    for source in blueprint.sources:
        for schema in source.schemas:
            instantiator.ground(operator(schema, source.unit), source.unit, source.participants)
    blocks = _owned(instantiator.blocks(), blueprint.warnings)
    facts = instantiator.facts
    goal = _goal(blueprint.goals, relations)
    robot_goal = [g for unit in blueprint.robot_goals for g in _goal(unit, relations) if g not in goal]
    ids = [facts[literal.key] for literal in chain(goal, robot_goal)]
    init = {facts[key] for key in relations.init if key in facts}
    numbering = Numbering(facts, init, executable(blocks, init), ids)
    task = Task(
        name=blueprint.name,
        agents=blueprint.agents,
        human=blueprint.human,
        facts=numbering.names,
        init=numbering.init,
        goal=numbering.condition(goal),
        actions=tuple(numbering.actions()),
        robot_goal=numbering.condition(robot_goal),
        warnings=tuple(blueprint.warnings),
    )
    _ = task.variables  # part of grounding: found here, so that no planning call's deadline pays for it
    return task


def _owned(blocks: Iterable[Block], warnings: list[str]) -> list[Block]:
    """The actions in which somebody takes part; a warning for the others, noops aside."""
    nobody: set[str] = set()
    for block in blocks:
        if not all(block.participants):
            nobody.update(r.key[0] for r in block.records() if not r.participants and any(r[2:6]))
    for name in sorted(nobody):
        warnings.append(f"action '{name}': left out where no agent is among its arguments")
    return [block.only(block.participants) for block in blocks]


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
