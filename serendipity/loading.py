"""Tasks from PDDL files, ready to be planned for.

What the search makes of a task before the first call takes time that grows with the files, as
reading them does.  Done here, it is in no call's time limit, and every call has an answer at once.
"""

from collections.abc import Mapping, Sequence

from search import prepare
from serendipity import pddl
from serendipity.model.task import Task
from serendipity.pddl.layouts import Pair, PathArgument


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
    prepare(task)
    return task
