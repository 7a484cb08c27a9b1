"""Every example that --help shows runs, in the order shown."""

import re
from pathlib import Path

import pytest

from serendipity.cli.help_examples import EXAMPLES, SERVERS
from serendipity.cli.on_demand import NAMES
from tests.cli.conftest import Runs


@pytest.mark.long
def test_examples_of_help_run(run: Runs, tmp_path: Path) -> None:
    (tmp_path / "goals.txt").write_text("2: conducted_triage commx room1\n1: conducted_triage commx room2\n")
    for command in EXAMPLES:
        program, rest = command.split(" ", 1)
        done = run(rest)
        assert program == "serendipity"
        assert done.code == 0, (command, done)
        assert done.err == ""


def test_examples_of_servers_are_right_but_for_the_port(run: Runs, tmp_path: Path) -> None:
    for command in SERVERS:
        rest, _, port = command.split(" ", 1)[1].rpartition(" ")
        done = run(f"{rest} 70000")
        assert port.isdigit()
        assert (done.code, done.err) == (2, "Error: --port: expected a number from 0 to 65535, got 70000\n")
    assert [path.name for path in tmp_path.iterdir()] == []  # no record of what was not played


@pytest.mark.parametrize("command", [*(name for name in NAMES if name != "generate"), "generate usar"])
def test_help_shows_its_examples(command: str, run: Runs) -> None:
    done = run(f"{command} --help")
    shown = [text for text in (*EXAMPLES, *SERVERS) if text.startswith(f"serendipity {command}".rstrip())]
    assert done.code == 0
    assert shown
    for text in shown:
        assert text in done.out


def test_help_fits_a_terminal(run: Runs, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("COLUMNS", "80")
    shown = run("--help").out.splitlines()
    assert all(len(line) <= 80 and not line.endswith("...") for line in shown[1:])
    named = [line.split()[0] for line in shown if re.match(r"  [a-z]", line)]
    assert set(NAMES) <= set(named)
    examples = [line.strip() for line in shown if line.startswith("    serendipity ")]
    assert len(examples) < 10 and set(examples) <= {*EXAMPLES, *SERVERS, "serendipity COMMAND --help"}


def test_version(run: Runs) -> None:
    import serendipity
    from search.kernel.library import state

    assert run("--version").out == f"serendipity {serendipity.__version__}, kernel: {state()}\n"
