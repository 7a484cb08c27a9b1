"""The three layouts of PDDL input."""

from collections.abc import Iterable, Mapping, Sequence
from os import PathLike
from pathlib import Path
from typing import Final

from serendipity.model import InputError, Task, UsageError
from serendipity.model.task import canonical_name
from serendipity.pddl.assemble import Blueprint, Source, assemble
from serendipity.pddl.files import read_unit
from serendipity.pddl.lifted import And, Unit
from serendipity.pddl.participants import by_arguments, by_name_parts, by_owner
from serendipity.pddl.shared import check_objects, missing_facts, other_domains

PathArgument = str | PathLike[str]
Pair = tuple[PathArgument, PathArgument]

TEAM: Final = "superagent"


def load(path: PathArgument, human: str | None = None) -> Task:
    """Load a directory: a folder per agent and ``superagent/``, each with two files.

    Args:
        path: the directory; agents are called as their folders.
        human: name of the human, or None for the only agent with a goal.

    Raises:
        InputError: a file is missing, can't be read or is wrong.
        UsageError: nobody, or more than one agent, could be the human.
    """
    root = Path(path)
    if not root.is_dir():
        raise InputError("expected a directory with a folder for each agent", root)
    pairs: dict[str, Pair] = {}
    for folder in sorted(root.iterdir()):
        domain, problem = folder / "domain.pddl", folder / "problem.pddl"
        if folder.is_dir() and (domain.exists() or problem.exists()):
            pairs[folder.name] = (domain, problem)
    team = next((pairs.pop(name) for name in list(pairs) if name.lower() == TEAM), None)
    if not pairs:
        raise InputError("no agent's folder with 'domain.pddl' and 'problem.pddl' in this directory", root)
    return load_agents(pairs, team, human, name=root.name)


def load_agents(
    agents: Mapping[str, Pair],
    team: Pair | None = None,
    human: str | None = None,
    *,
    name: str | None = None,
) -> Task:
    """Load one pair of files per agent; facts are shared by name.

    An agent's actions range over the objects of his own files.  Actions of the team
    that no agent owns are joint: their participants are the agents whose names occur
    among the parts of the ground action's name, split at ``_`` and blanks.

    Args:
        agents: domain and problem file of each agent, by his name.
        team: domain and problem file of the joint actions, or None.
        human: name of the human, or None for the only agent with a goal.
        name: of the task; default is that of the human's problem.

    Raises:
        InputError: a file is missing, can't be read or is wrong.
        UsageError: nobody, or more than one agent, could be the human.
    """
    names = _unique_names(agents)
    units = {who: read_unit(who, *pair) for who, pair in zip(names, agents.values(), strict=True)}
    team_unit = None if team is None else read_unit(None, *team)
    everyone = [*units.values(), *([] if team_unit is None else [team_unit])]
    check_objects(everyone)
    human_name = _choose_human(units, human)
    sources = [Source(unit, unit.domain.schemas, by_owner(names.index(who))) for who, unit in units.items()]
    if team_unit is not None:
        owned = {schema.name for unit in units.values() for schema in unit.domain.schemas}
        joint = tuple(schema for schema in team_unit.domain.schemas if schema.name not in owned)
        sources.append(Source(team_unit, joint, by_name_parts(names, team_unit)))
    blueprint = Blueprint(
        name=name or units[human_name].problem.name,
        agents=tuple(names),
        human=names.index(human_name),
        sources=sources,
        goals=units[human_name],
        robot_goals=[unit for unit in everyone if unit.owner != human_name],
        warnings=[*other_domains(everyone), *missing_facts(everyone)],
    )
    return assemble(blueprint)


def load_pddl(
    domain: PathArgument,
    problem: PathArgument,
    human: str,
    robots: Sequence[str],
    *,
    name: str | None = None,
) -> Task:
    """Load one PDDL task whose agents are objects.

    The participants of a ground action are the agents among its arguments.  An action
    without any of them is nobody's: it is left out, with a warning.

    Args:
        domain: the domain file.
        problem: the problem file; its goal is the human's.
        human: the object that is the human.
        robots: the objects that are robots, at least one.
        name: of the task; default is that of the problem.

    Raises:
        InputError: a file is missing, can't be read or is wrong.
        UsageError: an agent is not an object of the task, or is named twice.
    """
    if not human or not robots:
        raise UsageError("one PDDL task: expected a human and at least one robot among its objects")
    names = _unique_names([human, *robots])
    unit = read_unit(None, domain, problem)
    for agent in names:
        if agent not in unit.problem.objects:
            raise UsageError(f"agent '{agent}' is not an object of {unit.problem_file}")
    source = Source(unit, unit.domain.schemas, by_arguments(names))
    warnings = other_domains([unit])
    return assemble(Blueprint(name or unit.problem.name, tuple(names), 0, [source], unit, warnings=warnings))


def _unique_names(names: Iterable[str]) -> list[str]:
    unique: list[str] = []
    for name in map(canonical_name, names):
        if not name:
            raise UsageError("an agent's name is empty")
        if name in unique:
            raise UsageError(f"agent '{name}' is named twice")
        unique.append(name)
    return unique


def _choose_human(units: Mapping[str, Unit], human: str | None) -> str:
    if human is not None:
        name = canonical_name(human)
        if name not in units:
            raise UsageError(f"human: expected one of {', '.join(units)}, got '{human}'")
        return name
    candidates = [name for name, unit in units.items() if unit.problem.goal != And()]
    if len(candidates) == 1:
        return candidates[0]
    if not candidates:
        raise UsageError(f"no agent has a goal: say which one is the human ({', '.join(units)})")
    raise UsageError(f"{', '.join(candidates)} have goals: say which one is the human")
