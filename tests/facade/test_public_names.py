"""What ``import serendipity`` promises, and what it refuses."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

import serendipity

ROOT = Path(__file__).resolve().parents[2]


@pytest.mark.parametrize("name", serendipity.__all__)
def test_every_public_name_loads(name: str) -> None:
    assert getattr(serendipity, name) is not None
    assert name in dir(serendipity)


def test_other_names_are_attribute_errors() -> None:
    with pytest.raises(AttributeError, match="'plans'"):
        serendipity.plans  # noqa: B018


@pytest.mark.parametrize("name", ["search", "verify"])
@pytest.mark.parametrize("kind", ["package", "module", "namespace"])
def test_a_strangers_package_is_refused_by_name(name: str, kind: str, tmp_path: Path) -> None:
    if kind == "module":
        (tmp_path / f"{name}.py").write_text("raise SystemExit('the stranger ran')")
    else:
        (tmp_path / name).mkdir()
        if kind == "package":
            (tmp_path / name / "__init__.py").write_text("raise SystemExit('the stranger ran')")
    program = (
        "import serendipity\ntry: serendipity.plan\nexcept ImportError as error: print(error.name, error)"
    )
    done = subprocess.run(
        [sys.executable, "-c", program],
        env=os.environ | {"PYTHONPATH": os.pathsep.join([str(tmp_path), str(ROOT)])},
        cwd=tmp_path,
        capture_output=True,
        text=True,
        check=True,
    )
    if kind == "namespace":  # Python itself prefers our package to a folder without __init__.py
        assert done.stdout == ""
    else:
        assert done.stdout.startswith(f"{name} serendipity needs its own package '{name}'")
        assert str(tmp_path) in done.stdout
        assert "uninstall or rename" in done.stdout


@pytest.mark.parametrize("package", ["serendipity", "search", "verify"])
def test_annotations_are_for_others_too(package: str) -> None:
    assert (ROOT / package / "py.typed").exists()
