"""The library is loaded only when it is used, and knows the engine from then on."""

import subprocess
import sys
from pathlib import Path

import pytest


def run(code: str, folder: Path) -> str:
    script = folder / "script.py"
    script.write_text(code)
    done = subprocess.run([sys.executable, script], capture_output=True, text=True, check=False, cwd=folder)
    assert done.returncode == 0, done.stderr
    return done.stdout.strip()


def test_without_the_library_one_line_says_what_is_missing(tmp_path: Path) -> None:
    code = """
import sys
sys.modules["unified_planning"] = None
try:
    import serendipity.up
except ImportError as error:
    print(error)
"""
    assert run(code, tmp_path) == (
        "serendipity.up needs unified-planning: install the extra, serendipity-planner[up]"
    )


@pytest.mark.long
def test_importing_registers_the_engine_once(tmp_path: Path) -> None:
    """In the environment that is there already, and in those to come."""
    code = """
from unified_planning.environment import Environment, get_environment
get_environment()
import serendipity.up
serendipity.up.register()
for environment in (get_environment(), Environment()):
    factory = environment.factory
    print(factory.preference_list.count("serendipity"), factory.engine("serendipity").__name__)
with get_environment().factory.OneshotPlanner(name="serendipity"):
    pass
"""
    first, second, *rest = run(code, tmp_path).splitlines()
    assert first == second == "1 SerendipityEngine"
    assert any("Serendipity" in line for line in rest)


@pytest.mark.long
def test_up_ini_registers_the_engine(tmp_path: Path) -> None:
    (tmp_path / "up.ini").write_text(
        "[engine serendipity]\nmodule_name: serendipity.up.engine\nclass_name: SerendipityEngine\n"
    )
    code = """
from unified_planning.shortcuts import OneshotPlanner, get_environment
get_environment().credits_stream = None
with OneshotPlanner(name="serendipity", params={"mode": "composite"}) as planner:
    print(planner.name)
"""
    assert run(code, tmp_path) == "serendipity"
