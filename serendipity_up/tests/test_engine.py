"""The engine: when it is there, who is picked, what is refused, what statuses promise."""

import subprocess
import sys
from pathlib import Path

import pytest
from unified_planning.engines import PlanGenerationResult, PlanGenerationResultStatus
from unified_planning.engines.mixins.anytime_planner import AnytimeGuarantee
from unified_planning.engines.mixins.oneshot_planner import OptimalityGuarantee
from unified_planning.environment import get_environment
from unified_planning.exceptions import UPNoSuitableEngineAvailableException, UPUsageError
from unified_planning.model import AbstractProblem, DurativeAction, Fluent, Problem
from unified_planning.plans import PartialOrderPlan, SequentialPlan
from unified_planning.shortcuts import (
    Always,
    BoolType,
    InstantaneousAction,
    IntType,
    MinimizeSequentialPlanLength,
    Not,
)
from unified_planning.test.examples.multi_agent import get_example_problems

import serendipity
import serendipity_up
from serendipity.model import UsageError
from serendipity_up.engine import SerendipityEngine
from serendipity_up.tests.problems import corridor, costs, kitchen

get_environment().credits_stream = None
FACTORY = get_environment().factory
Status = PlanGenerationResultStatus
HELP = {"mode": "serendipity", "discount": "1/2", "human": "Ann", "robots": "Helper"}


def solve(problem: AbstractProblem, **parameters: object) -> PlanGenerationResult:
    with FACTORY.OneshotPlanner(name="serendipity", params=parameters) as planner:
        result: PlanGenerationResult = planner.solve(problem)
        return result


def test_the_factory_picks_it_where_it_fits() -> None:
    assert serendipity_up.ENGINE in FACTORY.engines
    for problem in (corridor(), kitchen()):
        with FACTORY.OneshotPlanner(
            problem_kind=problem.kind, optimality_guarantee=OptimalityGuarantee.SOLVED_OPTIMALLY
        ) as planner:
            assert planner.name == "serendipity"
    with FACTORY.AnytimePlanner(problem_kind=corridor().kind) as planner:
        assert planner.name == "serendipity"
        assert planner.ensures(AnytimeGuarantee.INCREASING_QUALITY)
        assert not planner.ensures(AnytimeGuarantee.OPTIMAL_PLANS)


def discrete() -> Problem:
    problem = Problem("discrete")
    problem.discrete_time = True
    problem.add_action(DurativeAction("wait"))
    return problem


def numeric() -> Problem:
    problem = Problem("numeric")
    charge = problem.add_fluent(Fluent("charge", IntType()), default_initial_value=3)
    problem.add_goal(charge > 2)
    return problem


@pytest.mark.parametrize(("problem", "beyond"), [(discrete(), "DISCRETE_TIME"), (numeric(), "INT_FLUENTS")])
def test_it_is_not_picked_where_it_does_not_fit(problem: Problem, beyond: str) -> None:
    with pytest.raises(UPNoSuitableEngineAvailableException):
        FACTORY.OneshotPlanner(problem_kind=problem.kind)
    with pytest.warns(UserWarning, match="cannot establish"):
        result = solve(problem)
    assert (result.status, result.plan) == (Status.UNSUPPORTED_PROBLEM, None)
    assert beyond in result.log_messages[0].message
    with pytest.raises(serendipity.InputError, match=f"'{problem.name}': .*{beyond}.*not supported") as error:
        serendipity_up.from_problem(problem)
    assert "\n" not in str(error.value)


@pytest.mark.parametrize("name", get_example_problems())
def test_the_librarys_own_teams_are_planned_for_and_their_plans_validated(name: str) -> None:
    case = get_example_problems()[name]
    result = solve(case.problem)
    assert result.status is Status.SOLVED_SATISFICING  # there is no metric to be optimal for
    with FACTORY.PlanValidator(problem_kind=case.problem.kind, plan_kind=result.plan.kind) as validator:
        assert validator.validate(case.problem, result.plan)


def test_statuses_promise_what_is_proved_of_the_problem() -> None:
    alone, team, help_ = (
        solve(kitchen()),
        solve(kitchen(), human="Ann", robots=["Robot"]),
        solve(kitchen(), **HELP),
    )
    assert [r.status for r in (alone, team, help_)] == [
        Status.SOLVED_OPTIMALLY,
        Status.SOLVED_OPTIMALLY,
        Status.SOLVED_SATISFICING,
    ]
    assert isinstance(alone.plan, SequentialPlan)
    assert isinstance(help_.plan, PartialOrderPlan)
    assert (alone.metrics["cost"], team.metrics["cost"], help_.metrics["cost"]) == ("7.0", "7.0", "6.0")
    assert (help_.metrics["opportunity"], help_.metrics["human_cost"]) == ("True", "7.0")
    beyond = solve(kitchen(), mode="individual", human="Robot", robots="Person")
    assert (
        beyond.status is Status.UNSOLVABLE_INCOMPLETELY
    )  # the robot alone can't: that proves nothing of both
    assert "no-human-plan" in [message.message for message in beyond.log_messages]


def test_help_can_not_be_asked_for_as_an_optimum() -> None:
    with FACTORY.OneshotPlanner(
        name="serendipity", params=HELP, optimality_guarantee=OptimalityGuarantee.SOLVED_OPTIMALLY
    ) as planner:
        planner.optimality_metric_required = True
        with pytest.raises(UPUsageError, match="mode 'serendipity': then plans are not optimal"):
            planner.solve(kitchen())


def test_a_limit_that_comes_first_is_told() -> None:
    assert solve(kitchen(), time_limit=0).status is Status.TIMEOUT
    with FACTORY.OneshotPlanner(name="serendipity") as planner:
        result = planner.solve(kitchen(), timeout=0.0, heuristic=len)
    assert result.status is Status.TIMEOUT
    assert result.log_messages[0].message == "heuristic: not used"


def without_metric(length: int) -> Problem:
    """A corridor; who walks it may take three steps at once."""
    problem = Problem("walk")
    at = [
        problem.add_fluent(Fluent(f"at{i}", BoolType()), default_initial_value=not i) for i in range(length)
    ]
    steps = [(i, j) for i in range(length) for j in (i + 1, i + 3) if j < length]
    for i, j in steps:
        step = InstantaneousAction(f"step{i}_{j}")
        step.add_precondition(at[i])
        step.add_effect(at[i], False)
        step.add_effect(at[j], True)
        problem.add_action(step)
    problem.add_goal(at[-1])
    return problem


def test_the_first_plan_is_enough_unless_one_is_better() -> None:
    problem = without_metric(9)
    assert solve(problem).status is Status.SOLVED_SATISFICING
    *_, last = SerendipityEngine().get_solutions(problem)
    assert len(last.plan.actions) == 4, "an anytime planner goes on"
    problem.add_quality_metric(MinimizeSequentialPlanLength())
    assert solve(problem).status is Status.SOLVED_OPTIMALLY


def test_a_refusal_names_what_helps() -> None:
    problem = without_metric(3)
    problem.add_trajectory_constraint(Always(Not(problem.fluent("at1")())))
    with pytest.raises(serendipity.InputError, match="not supported; the compiler STATE_INVARIANTS_REM"):
        serendipity_up.from_problem(problem)


def test_answers_get_better() -> None:
    with FACTORY.AnytimePlanner(name="serendipity", params=HELP) as planner:
        *before, last = planner.get_solutions(kitchen())
    assert all(result.status is Status.INTERMEDIATE for result in before)
    assert last.status is Status.SOLVED_SATISFICING
    found = [float(result.metrics["cost"]) for result in (*before, last)]
    assert found == sorted(found, reverse=True)
    assert found[-1] < found[0]


@pytest.mark.parametrize(
    ("parameters", "message"),
    [
        ({"mode": "clairvoyant"}, "mode: expected one of"),
        ({"speed": 3}, "unknown option 'speed': .*robots"),
        ({"mode": "assistance"}, "mode 'assistance': the answer is no single plan"),
        ({"mode": "serendipity", "ties": "watched"}, "ties 'watched': the answer is no single plan"),
        ({"mode": "serendipity", "ties": "expected"}, "ties 'expected': the answer is no single plan"),
        ({"human_plan": (), "predict_with": "serendipity"}, "predict_with: the human's plan is given"),
    ],
)
def test_wrong_parameters_are_told(parameters: dict[str, object], message: str) -> None:
    with pytest.raises(UPUsageError, match=message):
        SerendipityEngine(**parameters)


@pytest.mark.parametrize(
    ("parameters", "message"),
    [
        ({"mode": "serendipity"}, "mode 'serendipity' is help for somebody: expected an object"),
        ({"human": "Bob"}, "agent 'Bob': there is no such object"),
        ({"human": "Ann"}, "no other object of type 'Person"),
        ({"human": "Place", "robots": "Robot"}, "human: expected one object, got 5"),
        ({"human": "Ann", "robots": ["Robot", "Robot"]}, "named twice"),
        ({"human": "Ann", "robots": "Person"}, "at least one besides"),
        ({"robots": "Helper"}, "expected a human"),
        ({**HELP, "human": 3}, "agent: expected a name, or what has one, got 3"),
        ({**HELP, "robots": 3}, "robots: expected names, or what has one, got 3"),
        ({**HELP, "human_plan": 3}, "human plan: expected a list of names, got 3"),
        ({**HELP, "human_plan": ["brew ann"]}, "step 1: 'brew ann' is not applicable"),
        ({**HELP, "predict_with": "oracle"}, "engine 'oracle': expected one of"),
    ],
)
def test_what_does_not_fit_the_problem_is_told(parameters: dict[str, object], message: str) -> None:
    with pytest.raises(UPUsageError, match=message):
        solve(kitchen(), **parameters)


def test_agents_of_a_team_are_named_or_found() -> None:
    task = serendipity_up.from_problem(corridor())
    assert (task.agents, task.human) == (("ann", "robot"), 0)
    for parameters, message in (
        ({"human": "Bob"}, "agent 'Bob': expected one of Ann, Robot"),
        ({"human": "Ann", "robots": ["Ann"]}, "each agent but the human, once"),
    ):
        with pytest.raises(UsageError, match=message):
            serendipity_up.from_problem(corridor(), **parameters)
    problem = corridor()
    problem.agent("Robot").add_public_goal(problem.ma_environment.fluent("is_open"))
    with pytest.raises(UsageError, match="Ann, Robot have goals"):
        serendipity_up.from_problem(problem)
    assert serendipity_up.from_problem(problem, human="Ann").robot_goal
    assert solve(problem).plan is not None  # it makes no difference here who is the human


def test_actions_of_nobody_are_left_out_and_nothing_is_proved_then() -> None:
    problem = costs()
    agents = [problem.add_object(name, problem.user_type("Place")) for name in ("d", "e")]
    result = solve(problem, human=agents[0], robots=agents[1:])
    assert result.status in (Status.SOLVED_SATISFICING, Status.UNSOLVABLE_INCOMPLETELY)
    assert any("left out" in message.message for message in result.log_messages)


def run(code: str, folder: Path) -> str:
    script = folder / "script.py"
    script.write_text(code)
    done = subprocess.run([sys.executable, script], capture_output=True, text=True, check=False, cwd=folder)
    assert done.returncode == 0, done.stderr
    return done.stdout.strip()


def test_without_the_library_one_line_says_what_is_missing(tmp_path: Path) -> None:
    code = """
import sys
sys.modules["unified_planning"] = None
try:
    import serendipity_up
except ImportError as error:
    print(error)
"""
    assert run(code, tmp_path) == (
        "serendipity.up needs unified-planning: install the extra, serendipity-planner[up]"
    )


@pytest.mark.long
def test_importing_registers_the_engine_once(tmp_path: Path) -> None:
    """In the environment that is there already, and in those to come."""
    code = """
from unified_planning.environment import Environment, get_environment
get_environment()
import serendipity
import serendipity_up
serendipity_up.register()
for environment in (get_environment(), Environment()):
    factory = environment.factory
    print(factory.preference_list.count("serendipity"), factory.engine("serendipity").__name__)
with get_environment().factory.OneshotPlanner(name="serendipity"):
    pass
"""
    first, second, *rest = run(code, tmp_path).splitlines()
    assert first == second == "1 SerendipityEngine"
    assert any("Serendipity" in line for line in rest)


@pytest.mark.long
def test_up_ini_registers_the_engine(tmp_path: Path) -> None:
    (tmp_path / "up.ini").write_text(
        "[engine serendipity]\nmodule_name: serendipity.up.engine\nclass_name: SerendipityEngine\n"
    )
    code = """
from unified_planning.shortcuts import OneshotPlanner, get_environment
get_environment().credits_stream = None
with OneshotPlanner(name="serendipity", params={"mode": "composite"}) as planner:
    print(planner.name)
"""
    assert run(code, tmp_path) == "serendipity"
