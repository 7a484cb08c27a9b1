"""Tasks from PDDL files, ready to be planned for.

What the search makes of a task before the first call takes time that grows with the files, as
reading them does.  On a large task it would take longer than a short time limit, and leave a first
call without any answer; so it is done here.  On a small one it takes a millisecond or two, and is
left to the first call.  Where one deadline covers reading and planning alike, as that of a command
does, or nobody plans at all, :mod:`serendipity.pddl` reads and nothing is prepared in advance.
"""

from collections.abc import Mapping, Sequence
from typing import Final

from search import PreparedTask, prepare
from serendipity.facade.logs import recorded
from serendipity.facade.prepared import HELD
from serendipity.model import Deadline, Task
from serendipity.model.arguments import BY_NAME, FUNCTION, PAIR, PATH, TEXT, expect, expect_or_none
from serendipity.model.numbers import Number
from serendipity.model.resources.limits import limits_from
from serendipity.model.task.task import several
from serendipity.pddl.layouts import Pair, read_agents, read_folder, read_pddl
from serendipity.pddl.parsing.files import PathArgument
from serendipity.pddl.work import OnProgress, Work, within_limits

_LARGE: Final = 1_000
"""Ground actions: that many take some 5 ms to prepare, the shortest time limit that is kept."""


def _size(task: Task) -> str:
    return f"{task.name}, {len(task.actions):,} ground actions"


@recorded("load", _size)
def load(
    path: PathArgument,
    human: str | None = None,
    *,
    epoch: Number | None = None,
    time_limit: float | None = None,
    memory_limit: float | None = None,
    deadline: Deadline | None = None,
    on_progress: OnProgress | None = None,
) -> Task:
    """Load a directory: a folder per agent and ``superagent/`` (see :func:`serendipity.pddl.read_folder`).

    Args:
        path: the directory.
        human: name of the human, or None for the only agent with a goal.
        epoch: how long an epoch is, in the unit of PDDL's durations; None to find out.
        time_limit: seconds for this call, or None.
        memory_limit: what the process may have in memory, in MiB, or None.
        deadline: one that other work shares, such as planning; it holds beside the two limits.
        on_progress: is told what is being done.
    """
    limits = limits_from(time_limit, memory_limit, deadline)
    expect(PATH, path=path)
    expect_or_none(TEXT, human=human)
    expect_or_none(FUNCTION, on_progress=on_progress)
    return _ready(
        read_folder(path, human, epoch=epoch, deadline=limits, on_progress=on_progress), limits, on_progress
    )


@recorded("load", _size)
def load_agents(
    agents: Mapping[str, Pair],
    team: Pair | None = None,
    human: str | None = None,
    *,
    name: str | None = None,
    epoch: Number | None = None,
    time_limit: float | None = None,
    memory_limit: float | None = None,
    deadline: Deadline | None = None,
    on_progress: OnProgress | None = None,
) -> Task:
    """Load one pair of files per agent.

    See :func:`serendipity.pddl.read_agents`; limits as in :func:`load`.
    """
    limits = limits_from(time_limit, memory_limit, deadline)
    expect(BY_NAME, agents=agents)
    expect(PAIR, **{f"agents: {agent}": pair for agent, pair in agents.items()})
    expect_or_none(PAIR, team=team)
    expect_or_none(TEXT, human=human, name=name)
    expect_or_none(FUNCTION, on_progress=on_progress)
    task = read_agents(agents, team, human, name=name, epoch=epoch, deadline=limits, on_progress=on_progress)
    return _ready(task, limits, on_progress)


@recorded("load", _size)
def load_pddl(
    domain: PathArgument,
    problem: PathArgument,
    human: str,
    robots: Sequence[str] = (),
    *,
    name: str | None = None,
    epoch: Number | None = None,
    time_limit: float | None = None,
    memory_limit: float | None = None,
    deadline: Deadline | None = None,
    on_progress: OnProgress | None = None,
) -> Task:
    """Load one PDDL task whose agents are objects.

    See :func:`serendipity.pddl.read_pddl`; limits as in :func:`load`.
    """
    limits = limits_from(time_limit, memory_limit, deadline)
    expect(PATH, domain=domain, problem=problem)
    expect(TEXT, human=human)
    named = several(robots, "robots")
    expect_or_none(TEXT, name=name)
    expect_or_none(FUNCTION, on_progress=on_progress)
    task = read_pddl(
        domain, problem, human, named, name=name, epoch=epoch, deadline=limits, on_progress=on_progress
    )
    return _ready(task, limits, on_progress)


def _ready(task: Task, limits: Deadline, on_progress: OnProgress | None) -> Task:
    if len(task.actions) > _LARGE and not task.needs_time:
        HELD.hold(within_limits(lambda work: _prepare(task, work), limits, on_progress))
    return task


def _prepare(task: Task, work: Work) -> PreparedTask:
    work.stage(f"preparing {len(task.actions):,} ground actions")
    return prepare(task, work.deadline)
