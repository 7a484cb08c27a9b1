"""What loads with the kit, with its plugin, and without hypothesis."""

import subprocess
import sys
import tomllib
from importlib.util import find_spec
from pathlib import Path

import pytest

import serendipity_testing
from serendipity_testing import plugin
from tests.cli.test_start_up import modules_after as loaded_after

ROOT = Path(__file__).resolve().parents[2]


def printed(program: str) -> str:
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True)
    return done.stdout


@pytest.mark.long
def test_hypothesis_loads_for_strategies_only() -> None:
    program = "import serendipity_testing as kit\nkit.task, kit.best, kit.check_planner, kit.random_call"
    assert "hypothesis" not in loaded_after(program)
    assert "hypothesis" in loaded_after(f"{program}\nkit.tasks")


def test_the_plugin_alone_loads_next_to_nothing() -> None:
    ours = {
        name
        for name in loaded_after("import serendipity_testing.plugin")
        if name.partition(".")[0] in ("serendipity", "serendipity_testing")
    }
    assert ours == {"serendipity_testing", "serendipity_testing.plugin"}


def test_without_hypothesis_there_is_one_line_that_names_the_extra() -> None:
    program = """
import sys
sys.modules["hypothesis"] = None
from serendipity_testing import best, task
try:
    from serendipity_testing import tasks
except ImportError as error:
    print(error.name, error, sep="; ")
"""
    assert printed(program) == (
        "hypothesis; serendipity.testing.strategies needs hypothesis: install the extra,"
        " serendipity-planner[testing]\n"
    )


@pytest.mark.parametrize("name", serendipity_testing.__all__)
def test_every_public_name_loads(name: str) -> None:
    assert getattr(serendipity_testing, name) is not None
    assert find_spec(f"serendipity_testing.{name}") is None, "a module of that name would take its place"
    assert name in dir(serendipity_testing)


def test_other_names_are_attribute_errors() -> None:
    with pytest.raises(AttributeError, match="'planets'"):
        serendipity_testing.planets  # noqa: B018


def test_pytest_finds_the_plugin_where_the_package_is_installed() -> None:
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    assert project["entry-points"]["pytest11"] == {"serendipity": plugin.__name__}
    assert "testing" in project["optional-dependencies"]["all"][0]
