"""Cross-checked calls among people, under rules of help."""

from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import pytest

import serendipity
from serendipity.model import Condition, Script, Task
from serendipity.model.task.gate import is_bound, nobody_pays
from serendipity_testing import shrink
from serendipity_testing.asking import call_of
from serendipity_testing.builders import task as build
from serendipity_testing.call import Call
from serendipity_testing.crosscheck import JUDGES, compare
from serendipity_testing.disagreement import Disagreement
from serendipity_testing.generator import PlanCall, random_call_among
from serendipity_testing.generator.among_people import MOST_PEOPLE
from serendipity_testing.oracle import best, truth
from serendipity_testing.oracle.answers import Optimum
from serendipity_testing.rewriting import renamed
from serendipity_testing.written_case import write_case
from tests.cli.conftest import Runs

NUMBERS = tuple(range(1, MOST_PEOPLE + 1))
BOTH = {name: JUDGES[name] for name in ("search", "automata")}


def drawn(count: int = 80) -> Iterator[tuple[int, PlanCall]]:
    for people in NUMBERS:
        yield from ((people, random_call_among(people, seed)) for seed in range(count))


@pytest.mark.parametrize("people", NUMBERS)
def test_so_many_people_are_drawn_as_are_asked_for(people: int) -> None:
    calls = [random_call_among(people, seed) for seed in range(60)]
    assert calls[:5] == [random_call_among(people, seed) for seed in range(5)]
    assert {len(call.task.script.people) for call in calls} == {people - 1}
    assert all(call.task.robots for call in calls)


def test_all_rules_are_drawn() -> None:
    calls = [call for _, call in drawn()]
    rules = "nobody_pays leave_free leave_price max_disturbance disturbance noticed ties"
    for name in rules.split():
        assert sum(name in call.options for call in calls) > 10, name
    assert sum(call.human_plan is not None for call in calls) > 5
    assert sum(bool(call.task.robot_goal) for call in calls) > 5
    several = [call for people, call in drawn() if people > 1]
    assert sum(nobody_pays(call.task, call_of(call).options) for call in several) > len(several) / 2
    assert any(action.timing for call in several for action in call.task.actions)
    last = [max(deed.end for deed in call.task.script.deeds) for call in several]
    assert sum(end > 3 for end in last) > 20  # so that there is something left to spoil


@pytest.mark.long
def test_search_brute_force_and_certificates_agree() -> None:
    for _, call in drawn(40):
        assert compare(call, BOTH, {}) is None, call.seed


def test_brute_force_follows_a_plan_by_what_is_so_behind_the_head_start() -> None:
    """Which of two actions of a name a plan means was looked up before it, where it could not be done."""
    call = random_call_among(3, 9200926)
    result = serendipity.plan(call.task, human_plan=call.human_plan, **call.keywords())
    assert truth.Truth(call.task).fault(result) is None


def test_what_a_bystander_leaves_otherwise_since_robots_have_been_there_is_left_by_these() -> None:
    """Pal leaves it ready where the robot has opened; only what robots change themselves was looked at."""
    call = random_call_among(3, 9401278)
    result = serendipity.plan(call.task, **call.keywords())
    assert result.statistics["left"] == {"open2": 0.3, "ready": 0.3} and result.cost == 1.85
    assert serendipity.verify(call.task, result).verdict == "proved"
    assert truth.Truth(call.task).fault(result) is None


@pytest.mark.parametrize("seed", [9102843, 9104691])
def test_who_gets_up_too_late_is_given_a_horizon(seed: int) -> None:
    """Without one there is none behind the head start, and the search refuses, as it has to."""
    call = random_call_among(3, seed)
    assert compare(call, BOTH, {}) is None and "horizon" in call.options


def test_brute_force_judges_answers_under_rules(monkeypatch: pytest.MonkeyPatch) -> None:
    bound = (call for people, call in drawn() if people == MOST_PEOPLE)
    call = next(one for one in bound if is_bound(one.task, call_of(one).options) and not one.human_plan)
    assert compare(call, BOTH, {}) is None
    monkeypatch.setattr(truth, "best", lambda *_: Optimum("infeasible"))
    said = compare(call, BOTH, {})
    assert said is not None and "brute force" in said.said and "automata" not in said.said


def beside_carol() -> Task:
    built = build(
        agents="ann bot cat carol",
        human="ann",
        init="near",
        goal="cup",
        actions={
            "fetch ann": "-> cup @ 3",
            "bring bot": "near -> cup !near",
            "purr cat": "-> purring",
            "wait carol": "-> waited",
            "drink carol": "near waited -> drunk",
        },
    )
    wants = Condition((built.facts.index("drunk"),))
    built = replace(built, own_goals=((3, wants),), known_variables=built.variables)
    return built.with_script(Script(people={"carol": [(2, "wait carol"), (3, "drink carol")]}))


def test_a_case_among_people_gets_smaller() -> None:
    """Who does nothing goes, with what they want; so does what bystanders do that does not matter."""
    call = PlanCall(beside_carol(), {})
    smallest = shrink(call, lambda tried: any(d.name == "drink carol" for d in tried.task.script.deeds)).task
    assert (smallest.agents, smallest.own_goals) == (("ann", "cat", "carol"), ())
    assert [(deed.agent, deed.name) for deed in smallest.script.deeds] == [(2, "drink carol")]
    alone = shrink(call, lambda tried: any(a.name == "bring bot" for a in tried.task.actions)).task
    assert (alone.agents, alone.own_goals, alone.script.people) == (("ann", "bot"), (), frozenset())


def test_a_case_among_people_is_told(tmp_path: Path) -> None:
    call = PlanCall(beside_carol(), {"nobody_pays": "true"}, seed=7)
    again = "serendipity crosscheck --people 2 --count 1 --seed 7"
    told = write_case(Disagreement(call, {}), tmp_path / "case", again=again).read_text()
    assert "#         'drink carol': 'near waited -> drunk'," in told
    assert "# carol wants drunk\n# carol begins in epoch 2: wait carol\n" in told
    assert told.endswith(f"# asked: --nobody-pays\n{again}\n")


def test_what_bystanders_want_is_renamed_with_everything_else() -> None:
    """It was not, and so they wanted other facts, or somebody else did."""
    call = Call(beside_carol(), call_of(PlanCall(beside_carol(), {"window_weight": "0"})).options)
    before, after = best(call.task, call.options), best(renamed(call).task, call.options)
    assert before.cost == after.cost == 3
    (agent, goal), *_ = renamed(call).task.own_goals
    assert (agent, len(goal.positive)) == (0, 1)
    assert agent in renamed(call).task.script.people


def test_brute_force_counts_in_one_unit() -> None:
    """What the human pays without robots was held against what they may in other units."""
    task = build(agents="hum rob", human="hum", goal="done", actions={"do hum": "-> done"})
    call = call_of(
        PlanCall(
            task, {"waiting_cost": "0.5", "nobody_pays": "true", "leave_price": "*=0.3"}, ((2, "do hum"),)
        )
    )
    answer = best(task, call.options, call.human_plan)
    assert (answer.cost, answer.saving_alone, answer.opportunity) == (1.5, 0.5, False)


def test_the_command(run: Runs) -> None:
    told = run("crosscheck --people 3 --count 4 --seed 1")
    assert (told.code, told.out) == (0, "4 calls, search, automata: 0 disagreements\n")
    told = run("crosscheck --people 3 --in-time")
    assert (told.code, told.err) == (2, "Error: --people: goes without --in-time\n")
