"""Libraries load when they are used, and not before."""

import subprocess
import sys

import pytest

from serendipity.cli.on_demand import NAMES
from tests.cli.conftest import Runs

SOLVERS = ("pulp", "highspy")


def modules_after(program: str) -> set[str]:
    """Modules that a program has loaded when it ends."""
    shown = f"{program}\nimport sys\nprint(' '.join(sys.modules))"
    done = subprocess.run([sys.executable, "-c", shown], capture_output=True, text=True, check=True)
    return set(done.stdout.splitlines()[-1].split())


def loaded_after(program: str) -> set[str]:
    return {name.split(".")[0] for name in modules_after(program)}


def test_only_the_command_that_is_called_loads() -> None:
    command = ["plan", "--example", "room2", "--discount", "0.6"]
    loaded = modules_after(f"from serendipity.cli.app import main\nassert main({command!r}) == 0")
    assert not loaded & {f"serendipity.cli.{name.replace('-', '_')}" for name in NAMES if name != "plan"}
    assert not loaded & {"logging", "tempfile", "random", "json", "serendipity.scenarios.generate"}
    assert not loaded & {"serendipity.facade.in_time", "serendipity.facade.rules", "search.modes.scenarios"}


def test_a_signal_is_listened_to_before_anything_loads() -> None:
    loaded = modules_after("import serendipity.cli.entry")
    assert not {name for name in loaded if name.startswith(("serendipity.", "typing", "typer"))} - {
        "serendipity._version",
        "serendipity.cli",
        "serendipity.cli.entry",
        "serendipity.cli.process",
        "serendipity.cli.process.signals",
    }


@pytest.mark.long
@pytest.mark.parametrize(
    "command",
    [
        ["plan", "--example", "room2", "--discount", "0.6"],
        ["plan", "--example", "room2", "--format", "json"],
        ["examples"],
    ],
)
def test_nothing_heavy_loads_for(command: list[str]) -> None:
    loaded = loaded_after(f"from serendipity.cli.app import main\nassert main({command!r}) == 0")
    assert not loaded & {*SOLVERS, "networkx", "numpy", "rich", "pydantic", "unified_planning"}


@pytest.mark.parametrize("quiet", [False, True])
def test_a_missing_kernel_is_one_line(quiet: bool, process: Runs, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("SERENDIPITY_KERNEL", "off")
    done = process(f"plan --example room2 --format json {'--quiet' if quiet else ''}")
    assert '"kernel": "none (SERENDIPITY_KERNEL=off)"' in done.out
    assert done.err.count("\n") == done.err.count("no compiled kernel (SERENDIPITY_KERNEL=off)") == 1 - quiet


def test_importing_the_package_imports_nothing_else() -> None:
    loaded = loaded_after("import serendipity; serendipity.__version__; dir(serendipity)")
    assert not loaded & {*SOLVERS, "search", "verify", "typer", "rich", "networkx", "numpy"}
