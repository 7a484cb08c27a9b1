"""Libraries load when they are used, and not before."""

import subprocess
import sys

import pytest

SOLVERS = ("pulp", "highspy")


def loaded_after(program: str) -> set[str]:
    """Top-level modules that a program has loaded when it ends."""
    shown = f"{program}\nimport sys\nprint(' '.join({{name.split('.')[0] for name in sys.modules}}))"
    done = subprocess.run(
        [sys.executable, "-c", shown],
        capture_output=True,
        text=True,
        check=True,
    )
    return set(done.stdout.splitlines()[-1].split())


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
    assert not loaded & {*SOLVERS, "networkx", "numpy", "rich", "pydantic"}


def test_importing_the_package_imports_nothing_else() -> None:
    loaded = loaded_after("import serendipity; serendipity.__version__; dir(serendipity)")
    assert not loaded & {*SOLVERS, "search", "verify", "plado", "typer", "rich", "networkx", "numpy"}
