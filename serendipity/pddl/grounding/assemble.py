"""United files to a task: ground once, prune, number the facts."""

from collections import Counter
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from itertools import chain
from typing import Final

from serendipity.model import GroundAction, InputError, Task, Timeline
from serendipity.model.task.actions import NOOP
from serendipity.model.task.script import moments
from serendipity.pddl.grounding.blocks import Block
from serendipity.pddl.grounding.clock import Clock, script_of, time_warnings
from serendipity.pddl.grounding.disjunctive import NotExactError, variables_behind, with_disjunctions
from serendipity.pddl.grounding.goals import Goal, read_goal
from serendipity.pddl.grounding.instantiate import Instantiator, Participants
from serendipity.pddl.grounding.join import Relations
from serendipity.pddl.grounding.numbering import Changes, Numbering
from serendipity.pddl.grounding.prune import executable
from serendipity.pddl.parsing.lifted import Key, Schema, Unit
from serendipity.pddl.parsing.tree import quoted
from serendipity.pddl.work import Work

_BYTES: Final = (500, 900)
"""Of a ground action of a task, besides what it took as part of a block, and of a fact; measured."""


@dataclass(frozen=True, slots=True)
class Source:
    """Files, those of their actions that count, the agents in these, and what first parameters may be."""

    unit: Unit
    schemas: tuple[Schema, ...]
    participants: Participants
    actors: frozenset[str] | None = None


@dataclass(slots=True)
class Blueprint:
    """All that a task is made of, before grounding.

    Attributes:
        goals: the unit that states the human's goal.
        robot_goals: units that state goals beyond the human's.
        left_out: why an action in which nobody takes part is left out.
        epoch: how long an epoch is, in the unit of durations; None to find out.
    """

    name: str
    agents: tuple[str, ...]
    human: int
    sources: list[Source]
    goals: Unit
    robot_goals: list[Unit] = field(default_factory=list)
    left_out: Callable[[Key], str] = " ".join
    warnings: list[str] = field(default_factory=list)
    epoch: Fraction | None = None

    @property
    def units(self) -> list[Unit]:
        """The files, each once."""
        return [*{id(source.unit): source.unit for source in self.sources}.values()]


def assemble(blueprint: Blueprint, work: Work) -> Task:
    """Ground a blueprint; an InputError for costs, goals or conditions that are not supported."""
    relations = _relations(blueprint.sources)
    work.stage("reading the goal")
    goal = read_goal(blueprint.goals, relations, work)
    robot_goals = [read_goal(unit, relations, work) for unit in blueprint.robot_goals]
    if not goal:
        blueprint.warnings.append(_no_goal(blueprint))
    facts, blocks = _grounded(blueprint, relations, work)
    numbering = _numbered(facts, blocks, relations, goal, robot_goals, work, blueprint.units)
    own_goals = [
        (blueprint.agents.index(one.unit.owner), numbering.condition(one.literals))
        for one in robot_goals
        if one.unit.owner is not None and one.literals and not one.disjunctions
    ]
    for one in robot_goals:
        one.leave_out(goal)
    clock = Clock(blueprint.units, numbering.blocks, blueprint.epoch)
    actions = tuple(_actions(numbering, blueprint, clock))
    timeline = _timeline(numbering, blueprint, clock)
    blueprint.warnings += [*clock.warnings(), *time_warnings(blueprint.units)]
    task = Task(
        name=blueprint.name,
        agents=blueprint.agents,
        human=blueprint.human,
        facts=numbering.names,
        init=numbering.init,
        goal=numbering.condition(goal.literals),
        actions=actions,
        robot_goal=numbering.condition(chain.from_iterable(one.literals for one in robot_goals)),
        warnings=tuple(blueprint.warnings),
        waiting=frozenset(numbering.waiting),
        script=timeline,
        epoch=clock.epoch,
        own_goals=tuple(own_goals),
        known_variables=variables_behind(numbering.names, numbering.init, moments(actions, timeline), work),
    )
    return _with_disjunctive_goals(task, numbering, goal, robot_goals, work)


def _relations(sources: Iterable[Source]) -> Relations:
    schemas = [schema for source in sources for schema in source.schemas]
    effects = [effect.literal for schema in schemas for effect in schema.all_effects]
    effects += [timed.literal for source in sources for timed in source.unit.problem.timed]
    fluent = frozenset([literal.key[0] for literal in effects])
    added = frozenset([literal.key[0] for literal in effects if literal.positive])
    return Relations(chain.from_iterable(source.unit.problem.init for source in sources), fluent, added)


def _no_goal(blueprint: Blueprint) -> str:
    unit = blueprint.goals
    line = "" if unit.problem.goal_line is None else f":{unit.problem.goal_line}"
    human = quoted(blueprint.agents[blueprint.human])
    return f"{unit.problem_file}{line}: there is no goal: {human} has nothing to do"


def _grounded(blueprint: Blueprint, relations: Relations, work: Work) -> tuple[dict[Key, int], list[Block]]:
    """Ids of facts, and the ground actions in which somebody takes part."""
    instantiator = Instantiator(relations, _values(blueprint.sources), work)
    for source in blueprint.sources:
        for schema in work.deadline.each(source.schemas, 1):
            instantiator.ground(schema, source.unit, source.participants, source.actors)
    return instantiator.facts, _owned(instantiator.blocks(), blueprint, work)


def _values(sources: Iterable[Source]) -> dict[Key, Fraction]:
    values: dict[Key, Fraction] = {}
    for source in sources:
        for key, value in source.unit.problem.values.items():
            if values.setdefault(key, value) != value:
                other = f"{float(values[key]):g} in another agent's file"
                message = f"{quoted(' '.join(key))} is {float(value):g} here, {other}"
                raise InputError(message, source.unit.problem_file)
    return values


def _owned(blocks: Iterable[Block], blueprint: Blueprint, work: Work) -> list[Block]:
    """The actions in which somebody takes part; a warning for the others, those that only wait aside."""
    reasons: Counter[str] = Counter()
    owned = []
    for block in work.deadline.each(blocks, 1):
        if not all(block.participants):
            others = (r.key for r in block.records() if not (r.participants or r.only_waits))
            reasons.update(map(blueprint.left_out, others))
        owned.append(block.only(block.participants))
    for reason, number in sorted(reasons.items()):
        blueprint.warnings.append(f"{reason}; {number:,} action{'s' * (number > 1)} left out")
    return owned


def _numbered(
    facts: dict[Key, int],
    blocks: Iterable[Block],
    relations: Relations,
    goal: Goal,
    robot_goals: Sequence[Goal],
    work: Work,
    units: Iterable[Unit],
) -> Numbering:
    """The executable actions in their final order; goals lose what is known of them."""
    goals = (goal, *robot_goals)
    for literal in chain.from_iterable(one.named() for one in goals):
        _ = facts[literal.key]  # has an id from here on
    script = script_of(units, facts)
    init = {facts[key] for key in relations.init if key in facts}
    work.stage("finding out which actions can be executed")
    left = executable(blocks, init, work, script)
    count = sum(map(len, left))
    size = count * _BYTES[0] + len(facts) * _BYTES[1]
    work.require(size, f"reading the task ({count:,} ground actions)")
    work.stage(f"numbering {count:,} ground actions")
    changes = Changes(facts, init, left, work, script)
    for one in goals:
        one.simplify(lambda literal: changes.truth(facts[literal.key], literal.positive))
    named = [facts[literal.key] for one in goals for literal in one.named()]
    return Numbering(facts, init, left, changes, named, work)


def _timeline(numbering: Numbering, blueprint: Blueprint, clock: Clock) -> Timeline:
    """The script of the files."""
    found = [
        numbering.timed_fact(clock.epoch_of(timed, unit), timed.literal)
        for unit in blueprint.units
        for timed in unit.problem.timed
    ]
    return Timeline(tuple(fact for fact in found if fact is not None))


def _actions(numbering: Numbering, blueprint: Blueprint, clock: Clock) -> list[GroundAction]:
    units = (source.unit for source in blueprint.sources for s in source.schemas if s.name == NOOP)
    unit = next(units, None)
    try:
        return numbering.actions(clock.epochs)
    except InputError as error:
        if error.file is not None or unit is None:
            raise
        message = error.message  # of the one that is called as waiting is: nothing else in files has none
    raise unit.domain_error(message, next(s.line for s in unit.domain.schemas if s.name == NOOP))


def _with_disjunctive_goals(
    task: Task, numbering: Numbering, goal: Goal, robot_goals: Iterable[Goal], work: Work
) -> Task:
    for one in (goal, *robot_goals):
        if one.disjunctions:
            work.stage("compiling disjunctive goals")
            found = [tuple(map(numbering.literal, disjunction)) for disjunction in one.disjunctions]
            try:
                task = with_disjunctions(task, found, work, robots=one is not goal)
            except NotExactError as error:
                raise one.error(f"goal: {error}") from None
    return task
