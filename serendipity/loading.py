"""Tasks from PDDL files, ready to be planned for.

What the search makes of a task before the first call takes time that grows with the files, as
reading them does.  On a large task it would take longer than a short time limit, and leave a first
call without any answer; so it is done here.  On a small one it takes a millisecond or two, and is
left to the first call: who checks, shows or verifies plans does without.
"""

from collections.abc import Mapping, Sequence
from typing import Final

from search import prepare
from serendipity import pddl
from serendipity.model.task import Task
from serendipity.pddl.layouts import Pair, PathArgument

_LARGE: Final = 1_000
"""Ground actions: that many take some 5 ms to prepare, the shortest time limit that is kept."""


def load(path: PathArgument, human: str | None = None) -> Task:
    """Load a directory: a folder per agent and ``superagent/`` (see :func:`serendipity.pddl.load`)."""
    return _ready(pddl.load(path, human))


def load_agents(
    agents: Mapping[str, Pair],
    team: Pair | None = None,
    human: str | None = None,
    *,
    name: str | None = None,
) -> Task:
    """Load one pair of files per agent (see :func:`serendipity.pddl.load_agents`)."""
    return _ready(pddl.load_agents(agents, team, human, name=name))


def load_pddl(
    domain: PathArgument,
    problem: PathArgument,
    human: str,
    robots: Sequence[str],
    *,
    name: str | None = None,
) -> Task:
    """Load one PDDL task whose agents are objects (see :func:`serendipity.pddl.load_pddl`)."""
    return _ready(pddl.load_pddl(domain, problem, human, robots, name=name))


def _ready(task: Task) -> Task:
    if len(task.actions) > _LARGE:
        prepare(task)
    return task
