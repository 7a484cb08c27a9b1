"""The shell completes commands, options, their values, and the names of examples."""

import pytest

from serendipity.cli.on_demand import NAMES
from serendipity.cli.streams.manner import STYLES
from serendipity.cli.streams.output import FORMATS
from serendipity.model.keywords import CHOICES
from serendipity.scenarios.examples import EXAMPLES
from tests.cli.conftest import Runs


@pytest.mark.parametrize(
    ("words", "expected"),
    [
        ("", {*NAMES}),
        ("ver", {"verify"}),
        ("plan --mode ", {*CHOICES["mode"]}),
        ("plan --mode comm", {"communication"}),
        ("plan --max-cost ", {"human"}),
        ("plan --example ", {*EXAMPLES}),
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
