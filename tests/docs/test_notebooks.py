"""The notebooks run from the top, and print what they show."""

import ast
import contextlib
import io
import json
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import pytest

from tests.docs.blocks import ROOT

NOTEBOOKS = sorted((ROOT / "docs" / "notebooks").glob("*.ipynb"))


NEEDS = {"unified-planning": ("unified_planning", "up_fast_downward", "up_symk")}
"""What a notebook imports that need not be installed."""


def test_there_are_four() -> None:
    assert [path.stem for path in NOTEBOOKS] == ["own-domain", "paper", "study", "unified-planning"]


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_cells_print_what_is_shown(path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(path.parent)
    absent = [name for name in NEEDS.get(path.stem, ()) if find_spec(name) is None]
    if absent:
        pytest.skip(f"needs {', '.join(absent)}")
    names: dict[str, Any] = {}
    for cell in json.loads(path.read_text(encoding="utf-8"))["cells"]:
        if cell["cell_type"] != "code":
            continue
        printed = io.StringIO()
        with contextlib.redirect_stdout(printed):
            value = _executed("".join(cell["source"]), names)
        shown = "".join("".join(out["text"]) for out in cell["outputs"] if out["output_type"] == "stream")
        assert printed.getvalue() == shown
        results = [out["data"] for out in cell["outputs"] if out["output_type"] == "execute_result"]
        assert results == [] if value is None else [repr(value)] == results[0]["text/plain"]


def _executed(source: str, names: dict[str, Any]) -> object:
    """The value of a cell's last line, where that is an expression."""
    body = ast.parse(source).body
    last = body.pop() if isinstance(body[-1], ast.Expr) else None
    exec(compile(ast.Module(body, []), source, "exec"), names)
    return None if last is None else eval(compile(ast.Expression(last.value), source, "eval"), names)
