"""Every example that --help shows runs, in the order shown; and the shell completes what can be said."""

import re
from pathlib import Path

import pytest

from serendipity.cli.help_examples import EXAMPLES, SERVERS
from serendipity.cli.on_demand import NAMES
from serendipity.cli.streams.manner import STYLES
from serendipity.cli.streams.output import FORMATS
from serendipity.model.keywords import CHOICES
from serendipity.scenarios.examples import EXAMPLES as TASKS
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


@pytest.mark.parametrize(
    ("words", "expected"),
    [
        ("", {*NAMES}),
        ("ver", {"verify"}),
        ("plan --mode ", {*CHOICES["mode"]}),
        ("plan --mode comm", {"communication"}),
        ("plan --max-cost ", {"human"}),
        ("plan --example ", {*TASKS}),
        ("explain --format ", {*FORMATS}),
        ("interruptions --progress ", {*STYLES}),
        ("verify --solver c", {"cbc"}),
        ("generate ", {"usar"}),
        ("generate usar --layout p", {"pair"}),
        ("show --epo", {"--epoch", "--epoch-length"}),
    ],
)
def test_completions(words: str, expected: set[str], run: Runs, monkeypatch: pytest.MonkeyPatch) -> None:
    line = f"serendipity {words}"
    monkeypatch.setenv("_SERENDIPITY_COMPLETE", "complete_bash")
    monkeypatch.setenv("COMP_WORDS", line)
    monkeypatch.setenv("COMP_CWORD", str(len(line.split(" ")) - 1))
    done = run("")
    assert (done.code, done.err) == (0, "")
    assert set(done.out.split()) == expected


def test_the_script_for_a_shell_is_printed(run: Runs, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("shellingham.detect_shell", lambda: ("bash", "/bin/bash"))
    done = run("--show-completion")
    assert done.code == 0
    assert "_SERENDIPITY_COMPLETE=complete_bash" in done.out
