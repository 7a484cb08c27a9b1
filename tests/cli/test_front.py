"""``serendipity front`` on the command line."""

from pathlib import Path

from tests.cli.conftest import Runs, assert_one_line


def test_the_front_on_the_command_line(run: Runs) -> None:
    asked = "front --example flights --discount 0.9 --disturbance "
    shown = run(f"{asked} ask=1 --format json --picture front.svg")
    assert (shown.code, '"schema": "serendipity.front/1"' in shown.out) == (0, True)
    assert "ask 1, meet 0, sight 0" in run(f"{asked} ask=1").out
    assert_one_line(run(f"{asked} ask=1 -o front.png"), "-o: is for text and data", "--picture front.png")
    wrong = run(f"{asked} nag=1")
    assert wrong.code == 2
    assert wrong.err.startswith(
        "Error: disturbance: expected weights such as ask=1,meet=1,sight=1, got 'nag=1'"
    )


def test_the_front_over_goals_on_the_command_line(run: Runs) -> None:
    Path("goals.txt").write_text("0.5: conducted_triage commx room1\n0.5: at commx hall1\n")
    asked = "front --example room2 --discount 0.9"
    shown = run(f"{asked} --goals goals.txt --verify --format csv")
    assert (shown.code, shown.out.count("proved")) == (0, 2)
    regret = run(f"{asked} --goals goals.txt --risk regret")
    assert regret.out.startswith("commx alone: greatest regret ")
    refused = run(f"{asked} --observed goals.txt")
    assert (refused.code, "--observed: goes with --goals only" in refused.err) == (2, True)
