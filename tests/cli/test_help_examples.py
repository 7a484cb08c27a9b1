"""Every example that --help shows runs, in the order shown."""

from collections.abc import Callable

import pytest

from serendipity.cli.help_examples import EXAMPLES
from tests.cli.conftest import Run


def test_examples_of_help_run(run: Callable[[str], Run]) -> None:
    for command in EXAMPLES:
        program, rest = command.split(" ", 1)
        done = run(rest)
        assert program == "serendipity"
        assert done.code == 0, (command, done)
        assert done.err == ""


@pytest.mark.parametrize(
    "command", ["", "plan", "verify", "examples", "explain", "interruptions", "reproduce", "generate usar"]
)
def test_help_shows_its_examples(command: str, run: Callable[[str], Run]) -> None:
    done = run(f"{command} --help")
    shown = [text for text in EXAMPLES if text.startswith(f"serendipity {command}".rstrip())]
    assert done.code == 0
    assert shown
    for text in shown:
        assert text in done.out


@pytest.mark.parametrize("option", ["mode", "suffix", "preservation", "interference", "human_model", "ties"])
def test_help_names_the_choices_of_the_registry(option: str, run: Callable[[str], Run]) -> None:
    from serendipity.model.options import CHOICES

    shown = "".join(run("plan --help").out.split())
    assert f"--{option.replace('_', '-')}{'|'.join(CHOICES[option])}" in shown


def test_version(run: Callable[[str], Run]) -> None:
    import serendipity

    assert run("--version").out == f"serendipity {serendipity.__version__}\n"
