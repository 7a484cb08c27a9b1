"""Search, integer programs and certificates agree on random calls; a disagreement is found and shrunk."""

from dataclasses import replace
from pathlib import Path

import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from serendipity import Deadline, Result, load
from serendipity_testing.builders import task as build
from serendipity_testing.cases import case_4
from serendipity_testing.crosscheck import JUDGES, compare, shows_it_too
from serendipity_testing.crosscheck import judges as judging
from serendipity_testing.disagreement import Disagreement
from serendipity_testing.generator.calls import PlanCall, random_call
from serendipity_testing.shrinking import shrink
from serendipity_testing.written_case import command_line, write_case
from tests.cli.conftest import Runs, assert_one_line

SEARCH = JUDGES["search"]

seeds = st.integers(0, 10**9)


@pytest.mark.long
@given(seeds)
@example(108)  # at a limit, the human alone: of their cheapest plans not the canonical one
@example(720386)  # on the way, an opportunity before it is known what the human gains alone
@example(672)  # at a limit, over ties: a plan of the least cost, with more actions than there need be
def test_search_and_automata_agree(seed: int) -> None:
    found = compare(random_call(seed), {name: JUDGES[name] for name in ("search", "automata")})
    assert found is None, str(found)


@pytest.mark.long
@settings(max_examples=20)
@given(seeds)
def test_all_judges_agree(seed: int) -> None:
    found = compare(random_call(seed), JUDGES)
    assert found is None, str(found)


def _blind(call: PlanCall, deadline: Deadline) -> Result:
    """A judge that overlooks every opportunity."""
    answer = SEARCH(call, deadline)
    if not answer.opportunity or answer.human_cost is None:
        return answer
    return replace(answer, opportunity=False, cost=answer.human_cost, saving=0.0)


@pytest.mark.long
def test_a_blind_judge_is_found_out_and_the_case_shrunk(tmp_path: Path) -> None:
    judges = {"search": SEARCH, "blind": _blind}
    call = PlanCall(case_4(), {"mode": "communication", "discount": "0.9", "interference": "strict"})
    found = compare(call, judges)
    assert found is not None
    smallest = shrink(call, shows_it_too(found, judges))
    found = compare(smallest, judges)
    assert found is not None
    assert "refuted" in found.said["blind"]
    assert len(smallest.task.actions) < 12 < len(call.task.actions)
    assert "interference" not in smallest.options
    commands = write_case(found, tmp_path / "case")
    assert f"serendipity plan {tmp_path / 'case'} --human h" in commands.read_text()
    task = load(tmp_path / "case", human="h")
    assert SEARCH(replace(smallest, task=task), Deadline()).cost == SEARCH(smallest, Deadline()).cost


def test_a_session_keeps_the_places_of_a_local_human() -> None:
    """Made anew after the first epoch, the task would have a variable whose values look like places."""
    task = build(
        agents="hum rob",
        human="hum",
        init="free_hum",
        goal="on_b_table",
        actions={
            "lift_a_b hum": "free_hum -> hold_hum_a clear_b !free_hum @ 0.5",
            "lift_b_c hum": "free_hum clear_b -> hold_hum_b !free_hum @ 2.5",
            "lift_b_c rob": "-> hold_rob_b",
            "put_a_table hum": "hold_hum_a -> free_hum !hold_hum_a @ 0",
            "put_b_table hum": "hold_hum_b -> clear_b on_b_table !hold_hum_b @ 0.1",
            "take_b hum rob": "free_hum hold_rob_b -> hold_hum_b !free_hum",
        },
    )
    call = PlanCall(task, {"mode": "serendipity", "human_model": "local"})
    assert compare(call, {"search": SEARCH}) is None


def test_judges_without_time_agree_with_everybody() -> None:
    call = PlanCall(case_4(), {"mode": "communication", "discount": "0.9"})
    assert compare(call, {"search": SEARCH, "automata": JUDGES["automata"]}, time_limit=0) is None


def test_command_lines_quote_nothing_away() -> None:
    call = PlanCall(case_4(), {"mode": "communication", "keep_prefix": "true", "max_window": "2"})
    words = command_line(call, Path("a b"), "solve --encoding paper")
    assert words == (
        "serendipity solve --encoding paper 'a b' --human h --mode communication --keep-prefix --max-window 2"
    )
    given = PlanCall(case_4(), {"human_model": "local", "no_block": "false"}, ("move h a b",))
    assert command_line(given, Path("c")) == (
        "serendipity plan c --human h --human-model local --allow-block --human-plan c/plan.txt"
    )


def test_a_given_plan_is_written_beside_the_task(tmp_path: Path, run: Runs) -> None:
    plan = ("enter h", "leave h")
    task = build(
        init="out", goal="home", actions={"enter h": "-> in", "leave h": "in -> home", "aid r": "-> in"}
    )
    found = Disagreement(PlanCall(task, {}, plan), {"search": "this", "paper": "that"})
    commands = write_case(found, tmp_path / "case").read_text().splitlines()
    line = next(line for line in commands if line.startswith("serendipity plan"))
    assert run(f"{line.removeprefix('serendipity')} --format json").code == 0


# -- the command


def test_command_with_an_unknown_judge(run: Runs) -> None:
    known = "search, automata, paper, cbc, program, exhaustive, false-certificates"
    assert_one_line(run("crosscheck --judges search,oracle"), f"expected some of {known}, got 'oracle'")


def test_command_writes_a_disagreement(monkeypatch: pytest.MonkeyPatch, run: Runs) -> None:
    monkeypatch.setitem(judging.JUDGES, "search", _blind)
    done = run("crosscheck --seed 0 --count 200 --judges search,automata -o case")
    assert (done.code, "a disagreement" in done.out) == (1, True)
    assert "serendipity crosscheck --count 1 --seed " in Path("case/commands.txt").read_text()
