"""The three layouts: who owns what, who takes part, who is the human."""

import shutil
from pathlib import Path

import pytest

from serendipity import InputError, UsageError, load, load_agents, load_pddl
from tests.pddl.texts import OFFICE, YARD, action, domain, facts, one, problem, two


def test_directory_gives_each_agent_his_own_actions() -> None:
    task = load(YARD)
    assert task.agents == ("anna", "robo")
    assert task.agents[task.human] == "anna"
    own = {a.participants for a in task.actions if a.name.startswith(("take", "water"))}
    assert own == {(0,)}
    assert {a.participants for a in task.actions if a.name.startswith(("load", "unload"))} == {(1,)}
    assert facts(task, task.goal.positive) == {"watered roses"}
    walks = [a.participants for a in task.actions if a.name == "walk kale shed"]
    assert walks == [(0,), (1,)], "equal names in two files stay two actions"
    assert all(a.cost < 100 for a in task.actions), "what an agent owns is not joint"
    unload = [a.name for a in task.actions if a.name.startswith("unload")]
    assert unload == ["unload can1 kale", "unload can1 shed"], "of the objects of its own files"


def test_joint_actions_name_their_participants() -> None:
    task = load(YARD)
    joint = {a.name for a in task.actions if a.joint}
    assert joint == {
        "lift_down_robo_anna can1 kale",
        "lift_down_robo_anna can1 shed",
        "greet anna robo kale",
        "greet anna robo shed",
        "greet robo anna kale",
        "greet robo anna shed",
    }
    assert {a.participants for a in task.actions if a.joint} == {(0, 1)}


def test_actions_are_in_the_order_of_their_keys() -> None:
    for task in (load(YARD), load_pddl(*OFFICE, human="ann", robots=["bot"])):
        assert [a.key for a in task.actions] == sorted(a.key for a in task.actions)


def test_one_task_takes_participants_from_arguments() -> None:
    task = load_pddl(*OFFICE, human="ANN", robots=["Bot"])
    found = {a.name: a.participants for a in task.actions}
    assert found["move ann room domain"] == (0,)
    assert found["fetch bot problem domain"] == (1,)
    assert found["pass bot ann problem domain"] == (0, 1)


def test_human_can_be_chosen_and_others_goals_are_the_robots_own() -> None:
    task = load(YARD, human="Robo")
    assert task.agents[task.human] == "robo"
    assert not task.goal
    assert facts(task, task.robot_goal.positive) == {"watered roses"}


@pytest.fixture
def yard(tmp_path: Path) -> Path:
    return shutil.copytree(YARD, tmp_path / "yard")


def test_goals_of_the_team_beyond_the_humans_are_the_robots_own(yard: Path) -> None:
    team = yard / "superagent" / "problem.pddl"
    team.write_text(team.read_text().rstrip().removesuffix(")") + "(:goal (and (at-robo kale))))")
    task = load(yard)
    assert facts(task, task.robot_goal.positive) == {"at-robo kale"}


def test_the_team_folder_is_optional(yard: Path) -> None:
    shutil.rmtree(yard / "superagent")
    assert not any(a.joint for a in load(yard).actions)


def test_joint_action_that_names_nobody_is_an_error(yard: Path) -> None:
    team = yard / "superagent" / "domain.pddl"
    team.write_text(team.read_text().replace("lift_down_robo_anna", "lift_down"))
    with pytest.raises(InputError, match=r"domain.pddl:11: joint action 'lift_down can1 \w+': no agent"):
        load(yard)


def test_no_goal_anywhere_needs_a_named_human(tmp_path: Path) -> None:
    texts = domain(action("go", "(q)", "(p)")), problem(init="(q)", goal="")
    with pytest.raises(UsageError, match=r"no agent has a goal.*h, r"):
        two(tmp_path, texts, texts)
    assert two(tmp_path, texts, texts, human="r").human == 1


def test_two_goals_need_a_named_human(tmp_path: Path) -> None:
    texts = domain(action("go", "(q)", "(p)")), problem(init="(q)")
    with pytest.raises(UsageError, match="h, r have goals"):
        two(tmp_path, texts, texts)


def test_unknown_agents() -> None:
    with pytest.raises(UsageError, match="expected one of anna, robo, got 'berta'"):
        load(YARD, human="berta")
    for robots, message in (
        (["cat"], "agent 'cat' is not an object"),
        (["Ann"], "named twice"),
        ([], "at least one robot"),
    ):
        with pytest.raises(UsageError, match=message):
            load_pddl(*OFFICE, human="ann", robots=robots)


@pytest.mark.parametrize("empty", ["(:goal)", "(:goal ())", "(:goal (and))", ""])
def test_empty_and_absent_goals(tmp_path: Path, empty: str) -> None:
    task = one(tmp_path, domain(action("go", "(q)", "(p)")), problem(init="(q)", goal="", more=empty))
    assert not task.goal


def test_an_agent_with_a_name_of_several_parts(tmp_path: Path) -> None:
    go = domain(action("go", "(q)", "(p)", parameters="")), problem(init="(q)")
    still = domain(action("rest", "(r)", "(q)", parameters="")), problem(init="(r)", goal="")
    lift = "(:action lift_r_2_h :parameters () :precondition (p) :effect (r))"
    files = {}
    for who, texts in {"h": go, "r": still, "r_2": still, "team": (domain(lift), still[1])}.items():
        files[who] = tmp_path / f"{who}-d", tmp_path / f"{who}-p"
        for file, text in zip(files[who], texts, strict=True):
            file.write_text(text)
    team = files.pop("team")
    task = load_agents(files, team)
    assert [a.participants for a in task.actions if a.joint] == [(0, 2)]


def test_a_shared_fact_that_one_initial_state_lacks_is_warned_of(tmp_path: Path) -> None:
    d = domain(action("go", "(q)", "(p) (not (q)) (not (a ?who))"))
    task = two(tmp_path, (d, problem(init="(q) (a o1) (a o2)")), (d, problem(init="(q)", goal="")))
    assert len(task.warnings) == 1
    assert "'a o1', 'a o2' hold initially in" in task.warnings[0]


def test_many_missing_facts_of_a_predicate_are_one_line(tmp_path: Path) -> None:
    d = domain(action("go", "(q)", "(p) (not (b ?o))", "?who - agent ?o - thing"))
    objects = "h r - agent " + " ".join(f"o{i}" for i in range(1, 9)) + " - thing"
    all_b = " ".join(f"(b o{i})" for i in range(1, 9))
    with_facts = problem(init=f"(q) {all_b}", objects=objects)
    task = two(tmp_path, (d, with_facts), (d, problem(init="(q)", goal="", objects=objects)))
    assert len(task.warnings) == 1
    assert "and 5 more like it hold initially" in task.warnings[0]


def test_a_problem_of_another_domain_is_warned_of(tmp_path: Path) -> None:
    d = domain(action("go", "(q)", "(p)"))
    task = one(tmp_path, d, problem(init="(q)").replace("(:domain small)", "(:domain large)"))
    assert len(task.warnings) == 1
    assert "is for domain 'large'" in task.warnings[0]


def test_objects_of_unrelated_types_in_two_files(tmp_path: Path) -> None:
    d = domain(action("go", "(q)", "(p)"))
    other = problem(init="(q)", goal="", objects="h r o1 - agent o2 - thing")
    with pytest.raises(InputError, match=r"r-problem.pddl: object 'o1' is of type 'agent' here"):
        two(tmp_path, (d, problem(init="(q)")), (d, other))


def test_predicates_of_different_arity_in_two_files(tmp_path: Path) -> None:
    first = domain(action("go", "(q)", "(p)"))
    second = domain(action("go", "(q)", "(r)"), predicates="(p ?x) (q) (r)")
    with pytest.raises(InputError, match="predicate 'p' takes 1 arguments here, 0 in"):
        two(tmp_path, (first, problem(init="(q)")), (second, problem(init="(q)", goal="")))


def test_what_one_agent_changes_is_no_static_fact_of_another(tmp_path: Path) -> None:
    human = domain(action("cross", "(r)", "(p)", parameters=""))
    robot = domain(action("open", "(q)", "(r)", parameters=""))
    task = two(tmp_path, (human, problem(init="")), (robot, problem(init="(q)", goal="")))
    assert {a.name: facts(task, a.pre) for a in task.actions} == {"cross": {"r"}, "open": set()}
