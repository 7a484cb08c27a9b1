"""Half of four domains of IPC-2002 in time are read."""

from pathlib import Path

import pytest

from serendipity.pddl.layouts import read_pddl
from serendipity.pddl.parsing.files import read_unit
from serendipity.pddl.work import Work

ACTORS = {
    "driverlog": ("driver", "truck"),
    "rovers": ("rover",),
    "satellite": ("satellite",),
    "zenotravel": ("aircraft", "person"),
}
DURATIONS = {
    "driverlog": {1, 2, 10, 20},
    "rovers": {1, 5, 7, 8, 10, 15},
    "satellite": {1, 2, 5, 7},
    "zenotravel": {20, 30, 73, 100, 180},
}


@pytest.mark.long
@pytest.mark.parametrize("domain", ACTORS)
def test_tasks_of_ipc_2002_are_read(ipc2002time: Path, domain: str) -> None:
    folder = ipc2002time / domain
    problems = [*folder.glob("p*.pddl")]
    assert len(problems) == 10
    for problem in problems:
        unit = read_unit(None, folder / "domain.pddl", problem, Work())
        agents = [name for name, kind in unit.problem.objects.items() if kind[0] in ACTORS[domain]]
        others = [name for name in unit.problem.objects if name not in agents]
        task = read_pddl(folder / "domain.pddl", problem, agents[0], agents[1:] or others[:1])
        assert {action.duration for action in task.actions} == DURATIONS[domain]
        assert all(action.cost == action.duration * task.epoch for action in task.actions)
        assert any("total-time" in warning for warning in task.warnings)
