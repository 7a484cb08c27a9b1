"""MA-PDDL: the agent of an action is who stands behind ``:agent``; private parts are like others."""

from pathlib import Path

import pytest

from serendipity import InputError, Task, UsageError, load_agents, load_pddl, plan
from tests.pddl.texts import DATA, pair

DOMAIN, PROBLEM = ((DATA / "delivery" / f"{name}.pddl").read_text() for name in ("domain", "problem"))


def loaded(folder: Path, *robots: str, text: str = DOMAIN, problem: str = PROBLEM) -> Task:
    return load_pddl(*pair(folder, text, problem), human="w", robots=robots)


def test_who_the_robots_are(tmp_path: Path) -> None:
    """Without robots, or with ``all``, every other agent; unless there is one of that name."""
    for robots in ((), ("all",)):
        task = loaded(tmp_path, *robots)
        assert (task.agents, task.warnings) == (("w", "v", "x"), ())
    renamed = PROBLEM.replace("v v - van", "all all - van").replace("(is v a)", "(is all a)")
    assert loaded(tmp_path, "all", problem=renamed).agents == ("w", "all")
    task = loaded(tmp_path, "v")
    assert task.agents == ("w", "v")
    assert task.warnings == ("'x' is no agent of this call; its actions are left out",)


def test_an_action_is_its_agents_alone(tmp_path: Path) -> None:
    task = loaded(tmp_path)
    found = {a.name: a.participants for a in task.actions}
    assert found["give v w p b"] == (1,)
    assert found["move w a b"] == (0,)
    assert not any(a.joint for a in task.actions)
    assert {a.name.split()[1] for a in task.actions} == {"v", "w", "x"}
    assert plan(task, mode="composite", horizon="inf", discount="0.5").cost == 1


def test_in_its_own_files_an_agent_does_its_own_actions_only(tmp_path: Path) -> None:
    """That others could do as much is no reason to take their part."""
    files = pair(tmp_path, DOMAIN, PROBLEM)
    task = load_agents({"w": files, "v": files}, human="w")
    whose = {a.name.split()[1]: a.participants for a in task.actions}
    assert whose == {"w": (0,), "v": (1,)}
    named_otherwise = load_agents({"one": files, "two": files}, human="one")
    assert {a.participants for a in named_otherwise.actions} == {(0,), (1,)}


def test_others_are_told_of_in_one_line_and_never_ground(tmp_path: Path) -> None:
    crowd = " ".join(f"y{i}" for i in range(2000))
    problem = PROBLEM.replace("x x - bike", f"x x {crowd} - bike")
    text = DOMAIN[: DOMAIN.index("(:action give")] + DOMAIN[DOMAIN.index("(:action take") :]
    said: list[str] = []
    files = pair(tmp_path, text, problem)
    task = load_pddl(*files, human="w", robots=["v"], on_progress=lambda doing, *_: said.append(doing))
    (warning,) = task.warnings
    assert warning.endswith(" more are no agents of this call; their actions are left out")
    counts = [int(doing.split()[1].replace(",", "")) for doing in said if "so far" in doing]
    assert max(counts) < 20


def test_agents_are_objects_where_an_action_has_no_agent_of_its_own(tmp_path: Path) -> None:
    text = DOMAIN.replace(
        ":parameters (?b - carrier ?p - parcel ?x - place) :agent ?a - van",
        ":parameters (?a - van ?b - carrier ?p - parcel ?x - place)",
    )
    task = loaded(tmp_path, text=text)
    assert next(a.participants for a in task.actions if a.name == "give v w p b") == (0, 1)


def test_factored_files_name_no_agent_with_what_is_private(tmp_path: Path) -> None:
    text = DOMAIN.replace(":unfactored-privacy", ":factored-privacy")
    problem = (
        PROBLEM.replace("v v - van", "v - van").replace("w w - bike", "w - bike").replace("x x -", "x -")
    )
    assert loaded(tmp_path, text=text, problem=problem) == loaded(tmp_path)


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        (":agent ?a - carrier", ":agent", "action 'move': expected a variable, as ?x, got ':parameters'"),
        (":agent ?a - carrier", ":agent ?a - ", "action 'move': expected a type, got ':parameters'"),
        (":agent ?a - carrier", ":agent ?x - carrier", "action 'move': parameter '?x' is declared twice"),
        (":agent ?a - carrier", ":agent ?a - carrier :agent ?b", "action 'move': ':agent' was given already"),
        (":agent ?a - carrier", ":agent a", "action 'move': expected a variable, as ?x, got 'a'"),
    ],
)
def test_bad_agents(tmp_path: Path, old: str, new: str, message: str) -> None:
    with pytest.raises(InputError) as caught:
        loaded(tmp_path, text=DOMAIN.replace(old, new, 1))
    assert f"domain.pddl:8: {message}" in str(caught.value)


def test_a_single_agent_has_no_robots(tmp_path: Path) -> None:
    alone = PROBLEM.replace("(:private v v - van)", "").replace("(:private x x - bike)", "")
    alone = alone.replace("(is v a)", "").replace("(is x b)", "")
    task = loaded(tmp_path, problem=alone)
    assert task.agents == ("w",)
    assert plan(task, mode="composite", horizon="inf").cost == plan(task, mode="individual").cost == 3
    assert not plan(task, discount="0.5").opportunity


def test_plain_pddl_needs_robots(tmp_path: Path) -> None:
    plain = DOMAIN[: DOMAIN.index("(:action")] + ")"
    with pytest.raises(UsageError, match="expected at least one robot among its objects"):
        loaded(tmp_path, text=plain)
    with pytest.raises(UsageError, match="by name"):
        loaded(tmp_path, "all", text=plain)


@pytest.mark.parametrize(
    ("domain", "problem", "human", "agents", "actions"),
    [
        ("blocksworld", "probBLOCKS-9-0", "a1", 4, 720),
        ("depot", "pfile1", "driver0", 5, 90),
        ("driverlog", "pfile1", "driver1", 2, 112),
        ("elevators08", "p01", "fast0", 4, 480),
        ("logistics00", "probLOGISTICS-4-0", "apn1", 3, 84),
        ("rovers", "p10", "rover0", 4, 382),
        ("satellites", "p05-pfile5", "satellite0", 3, 527),
        ("zenotravel", "pfile3", "plane1", 2, 282),
    ],
)
def test_competition_tasks(
    codmap15: Path, domain: str, problem: str, human: str, agents: int, actions: int
) -> None:
    files = codmap15 / domain / "domain.pddl", codmap15 / domain / f"{problem}.pddl"
    task = load_pddl(*files, human=human)
    assert task.warnings == ()
    assert (len(task.agents), len(task.actions)) == (agents, actions)
    assert not any(action.joint for action in task.actions)
