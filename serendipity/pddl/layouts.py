"""The three layouts of PDDL input.

``human`` is a name, or None for the only agent with a goal, or ``any``, where no agent is called that, for
the first of those with goals.  ``epoch`` is how long an epoch is, in the unit of PDDL's durations, which are
rounded up to whole epochs; None: the greatest common divisor of all that can come up.  With MA-PDDL in one
pair of files no ``robots``, or ``all``, are all the other objects that can be an ``:agent``.

A file that is missing or wrong is an ``InputError``; a human, robots or an epoch that can't be meant are a
``UsageError``; ``LimitReachedError``: the deadline came first, or there is not enough memory.
"""

from collections.abc import Iterable, Mapping, Sequence
from fractions import Fraction
from pathlib import Path
from typing import Final

from serendipity.model import Deadline, InputError, Task, UsageError
from serendipity.model.keywords import ANYBODY
from serendipity.model.numbers import Number
from serendipity.model.task.task import canonical_name
from serendipity.pddl.grounding.assemble import Blueprint, Source, assemble
from serendipity.pddl.grounding.clock import epoch_length
from serendipity.pddl.parsing.files import PathArgument, read_unit
from serendipity.pddl.parsing.lifted import And, Key, Unit
from serendipity.pddl.parsing.tree import listed, quoted
from serendipity.pddl.participants import by_arguments, by_first_argument, by_name_parts, by_owner
from serendipity.pddl.shared import check_initial, check_objects, empty_lists, missing_facts, other_domains
from serendipity.pddl.work import OnProgress, Work, within_limits

Pair = tuple[PathArgument, PathArgument]

TEAM: Final = "superagent"

ALL: Final = "all"
"""Every other agent, in the place of robots' names."""


def read_folder(
    path: PathArgument,
    human: str | None = None,
    *,
    epoch: Number | None = None,
    deadline: Deadline | None = None,
    on_progress: OnProgress | None = None,
) -> Task:
    """Read a directory: a folder per agent and ``superagent/``, each with two files."""
    root = Path(path)
    try:
        is_folder = root.is_dir()
    except OSError as error:  # a name that is too long
        raise InputError(f"can't be read: {error.strerror}", root) from None
    if not is_folder:
        if not root.exists():
            raise InputError("there is no such folder: expected one with a folder for each agent", root)
        raise InputError("this is a file: expected a folder with one for each agent, or two files", root)
    pairs: dict[str, Pair] = {}
    for folder in sorted(root.iterdir()):
        domain, problem = folder / "domain.pddl", folder / "problem.pddl"
        if folder.is_dir() and (domain.exists() or problem.exists()):
            pairs[folder.name] = (domain, problem)
    team = next((pairs.pop(name) for name in list(pairs) if name.lower() == TEAM), None)
    if not pairs:
        raise InputError("no agent's folder with 'domain.pddl' and 'problem.pddl' in this folder", root)
    return read_agents(
        pairs, team, human, name=root.name, epoch=epoch, deadline=deadline, on_progress=on_progress
    )


def read_agents(
    agents: Mapping[str, Pair],
    team: Pair | None = None,
    human: str | None = None,
    *,
    name: str | None = None,
    epoch: Number | None = None,
    deadline: Deadline | None = None,
    on_progress: OnProgress | None = None,
) -> Task:
    """Read one pair of files per agent; facts are shared by name.

    An agent's actions range over the objects of its own files, but for an ``:agent``, who is the
    agent itself if it is one of these.  Actions of the team
    that no agent owns are joint: their participants are the agents whose names occur
    among the parts of the ground action's name, split at ``_`` and blanks.
    """
    names, length = _unique_names(agents), epoch_length(epoch)

    def read(work: Work) -> Task:
        units = {who: read_unit(who, *pair, work) for who, pair in zip(names, agents.values(), strict=True)}
        team_unit = None if team is None else read_unit(None, *team, work)
        return _united(units, team_unit, human, name, length, work)

    return within_limits(read, deadline, on_progress)


def _united(
    units: Mapping[str, Unit],
    team: Unit | None,
    human: str | None,
    name: str | None,
    epoch: Fraction | None,
    work: Work,
) -> Task:
    names = [*units]
    everyone = [*units.values(), *([] if team is None else [team])]
    check_objects(everyone)
    check_initial(everyone)
    human_name = _choose_human(units, human)
    sources = [one for i, unit in enumerate(units.values()) for one in _of_owner(unit, i, names[i])]
    if team is not None:
        owned = {schema.name for unit in units.values() for schema in unit.domain.schemas}
        joint = tuple(schema for schema in team.domain.schemas if schema.name not in owned)
        sources.append(Source(team, joint, by_name_parts(names, team)))
    blueprint = Blueprint(
        name=name or units[human_name].problem.name,
        agents=tuple(names),
        human=names.index(human_name),
        sources=sources,
        goals=units[human_name],
        robot_goals=[unit for unit in everyone if unit.owner != human_name],
        warnings=[*empty_lists(everyone), *other_domains(everyone), *missing_facts(everyone, work)],
        epoch=epoch,
    )
    return assemble(blueprint, work)


def _of_owner(unit: Unit, number: int, name: str) -> list[Source]:
    """What an agent can do by its own files; what these say that others can do is left out."""
    alone = tuple(schema for schema in unit.domain.schemas if schema.agent and name in unit.problem.objects)
    others = tuple(schema for schema in unit.domain.schemas if schema not in alone)
    owner = by_owner(number)
    return [Source(unit, alone, owner, frozenset([name])), Source(unit, others, owner)]


def read_pddl(
    domain: PathArgument,
    problem: PathArgument,
    human: str,
    robots: Sequence[str] = (),
    *,
    name: str | None = None,
    epoch: Number | None = None,
    deadline: Deadline | None = None,
    on_progress: OnProgress | None = None,
) -> Task:
    """Read one PDDL task whose agents are objects.

    The participants of a ground action are the agents among its arguments; of an action with
    ``:agent`` (MA-PDDL) it is that agent alone; those of others are not even ground.  An action
    in which nobody takes part is left out, with a warning.
    """
    length = epoch_length(epoch)

    def read(work: Work) -> Task:
        unit = read_unit(None, domain, problem, work)
        if not human:
            agents = sorted(_can_be_agents(unit))
            among = f"its agents: {listed(agents)}" if agents else "its objects"
            raise UsageError(f"one PDDL task: expected a human among {among}")
        if canonical_name(human) == ANYBODY and ANYBODY not in unit.problem.objects:
            raise UsageError(
                "human: 'any' is for tasks with files for each agent, whose goals say who is a person"
            )
        by_name = bool(robots) and (list(robots) != [ALL] or ALL in unit.problem.objects)
        named = robots if by_name else _other_agents(unit, canonical_name(human))
        names = _unique_names([human, *named])
        return _one(unit, names, name, length, work)

    return within_limits(read, deadline, on_progress)


def _other_agents(unit: Unit, human: str) -> list[str]:
    """The other objects that can be an ``:agent``."""
    if not any(schema.agent for schema in unit.domain.schemas):
        raise UsageError(
            "one PDDL task: expected at least one robot among its objects, by name: "
            "no action has an ':agent' that would say who the others are"
        )
    return sorted(_can_be_agents(unit) - {human})


def _one(unit: Unit, names: Sequence[str], name: str | None, epoch: Fraction | None, work: Work) -> Task:
    for agent in names:
        if agent not in unit.problem.objects:
            raise UsageError(f"agent {quoted(agent)} is not an object of {unit.problem_file}")
    alone = tuple(schema for schema in unit.domain.schemas if schema.agent)
    others = tuple(schema for schema in unit.domain.schemas if not schema.agent)
    sources = [
        Source(unit, alone, by_first_argument(names), frozenset(names)),
        Source(unit, others, by_arguments(names)),
    ]
    blueprint = Blueprint(
        name=name or unit.problem.name,
        agents=tuple(names),
        human=0,
        sources=sources,
        goals=unit,
        left_out=_Outsiders(unit, names).reason,
        warnings=[*empty_lists([unit]), *other_domains([unit]), *_outsiders(unit, names)],
        epoch=epoch,
    )
    return assemble(blueprint, work)


def _outsiders(unit: Unit, agents: Sequence[str]) -> list[str]:
    """A warning that names those who can be an ``:agent`` and are none of the call's."""
    others = sorted(_can_be_agents(unit).difference(agents))
    if not others:
        return []
    if len(others) == 1:
        return [f"{quoted(others[0])} is no agent of this call; its actions are left out"]
    return [f"{listed(others)} are no agents of this call; their actions are left out"]


def _can_be_agents(unit: Unit) -> set[str]:
    kinds = {schema.parameters[0].type for schema in unit.domain.schemas if schema.agent}
    return {name for kind in kinds for name in unit.objects_of(kind)}


class _Outsiders:
    """Participants of actions without ``:agent`` in which no agent of the call takes part."""

    def __init__(self, unit: Unit, agents: Sequence[str]) -> None:
        kinds = {unit.problem.objects[agent] for agent in agents}
        fits = unit.domain.types.is_subtype
        self._alike = {n for n, own in unit.problem.objects.items() if any(fits(own, k) for k in kinds)}

    def reason(self, key: Key) -> str:
        """The reason why an action is left out."""
        likely = [word for word in key[1:] if word in self._alike]
        if likely:
            return f"{quoted(likely[0])} is no agent of this call"
        return f"action {quoted(key[0])}: no agent is among its arguments"


def _unique_names(names: Iterable[str]) -> list[str]:
    unique: list[str] = []
    for name in map(canonical_name, names):
        if not name:
            raise UsageError("an agent's name is empty")
        if name in unique:
            raise UsageError(f"agent {quoted(name)} is named twice")
        unique.append(name)
    return unique


def _choose_human(units: Mapping[str, Unit], human: str | None) -> str:
    if not units:
        raise UsageError("agents: expected a pair of files for each agent, got none")
    candidates = [name for name, unit in units.items() if unit.problem.goal != And()]
    name = None if human is None else canonical_name(human)
    if name == ANYBODY and ANYBODY not in units and candidates:
        return candidates[0]
    if human is not None and name is not None:
        if name not in units:
            raise UsageError(f"human: expected one of {listed(units)}, got {quoted(human)}")
        return name
    if len(candidates) == 1:
        return candidates[0]
    if not candidates:
        raise UsageError(f"no agent has a goal: say which one is the human ({listed(units)})")
    raise UsageError(f"{listed(candidates)} have goals: say which one is the human, or 'any'")
