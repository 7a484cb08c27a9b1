"""The notebooks run from the top, and print what they show."""

import contextlib
import io
import json
from pathlib import Path
from typing import Any

import pytest

from tests.docs.blocks import ROOT

NOTEBOOKS = sorted((ROOT / "docs" / "notebooks").glob("*.ipynb"))


def test_there_are_two() -> None:
    assert [path.stem for path in NOTEBOOKS] == ["own-domain", "paper"]


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_cells_print_what_is_shown(path: Path) -> None:
    names: dict[str, Any] = {}
    for cell in json.loads(path.read_text(encoding="utf-8"))["cells"]:
        if cell["cell_type"] != "code":
            continue
        printed = io.StringIO()
        with contextlib.redirect_stdout(printed):
            exec(compile("".join(cell["source"]), str(path), "exec"), names)
        shown = [out for out in cell["outputs"] if out["output_type"] == "stream"]
        assert all(out["output_type"] in ("stream", "execute_result") for out in cell["outputs"])
        assert printed.getvalue() == "".join("".join(out["text"]) for out in shown)
