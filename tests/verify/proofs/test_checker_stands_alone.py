"""The checker is one short module that needs nothing but Python."""

import ast
import json
import subprocess
import sys
from pathlib import Path

from tests.verify.proofs.samples import sample
from verify.proofs import checker

_FILE = Path(checker.__file__)


def test_it_imports_nothing_but_the_standard_library() -> None:
    imported: set[str] = set()
    for node in ast.walk(ast.parse(_FILE.read_text())):
        if isinstance(node, ast.Import):
            imported.update(alias.name.split(".")[0] for alias in node.names)
        if isinstance(node, ast.ImportFrom):
            assert node.level == 0
            imported.add(str(node.module).split(".")[0])
    assert imported <= sys.stdlib_module_names


def test_it_has_300_lines_at_most() -> None:
    assert len(_FILE.read_text().splitlines()) <= 300


def test_it_counts_with_integers_only() -> None:
    tree = ast.parse(_FILE.read_text())
    assert not any(isinstance(node, ast.Div) for node in ast.walk(tree))
    assert not any(
        isinstance(node, ast.Constant) and isinstance(node.value, float) for node in ast.walk(tree)
    )
    assert not any(isinstance(node, ast.Name) and node.id == "float" for node in ast.walk(tree))


def test_it_runs_without_any_of_our_packages(tmp_path: Path) -> None:
    good, bad, none = tmp_path / "good.json", tmp_path / "bad.json", tmp_path / "none.json"
    good.write_text(json.dumps(sample("branched").proof))
    doctored = json.loads(good.read_text())
    doctored["programs"][0]["limit"] += 1
    bad.write_text(json.dumps(doctored))
    none.write_text("{}")

    def run(*files: Path) -> tuple[int, list[str]]:
        command = [sys.executable, "-I", "-S", str(_FILE), *map(str, files)]
        done = subprocess.run(command, capture_output=True, text=True, cwd=tmp_path, check=False)
        assert done.stderr == ""
        return done.returncode, done.stdout.splitlines()

    code, lines = run(good)
    assert (code, len(lines)) == (0, 1)
    assert lines[0].startswith(f"{good}: holds, ")
    assert run(good, bad)[0] == 1
    code, lines = run(bad, none, good)
    assert (code, len(lines)) == (2, 3)
