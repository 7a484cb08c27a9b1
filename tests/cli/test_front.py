"""``serendipity front`` on the command line."""

from tests.cli.conftest import Runs


def test_the_front_on_the_command_line(run: Runs) -> None:
    asked = "front --example flights --discount 0.9 --disturbance "
    shown = run(f"{asked} ask=1 --format json --picture front.svg")
    assert (shown.code, '"schema": "serendipity.front/1"' in shown.out) == (0, True)
    assert "ask 1, meet 0, sight 0" in run(f"{asked} ask=1").out
    wrong = run(f"{asked} nag=1")
    assert wrong.code == 2
    assert wrong.err.startswith(
        "Error: disturbance: expected weights such as ask=1,meet=1,sight=1, got 'nag=1'"
    )
