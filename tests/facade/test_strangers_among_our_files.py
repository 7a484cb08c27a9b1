"""Packages of others by our names, and files among ours, are noticed: by the lists of what was installed."""

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
OURS = ("serendipity", "search", "verify")
PROGRAM = "import serendipity\ntry: serendipity.plan\nexcept ImportError as error: print(error.name, error)"


@pytest.fixture
def installed(tmp_path: Path) -> Path:
    """A folder as an installer leaves it, with the list of what it has put there."""
    home = tmp_path / "site-packages"
    for package in OURS:
        shutil.copytree(ROOT / package, home / package, ignore=shutil.ignore_patterns("__pycache__"))
    _record(home, "serendipity-planner", [path for path in home.rglob("*") if path.is_file()])
    return home


def _record(home: Path, name: str, files: list[Path]) -> None:
    info = home / f"{name.replace('-', '_')}-1.1.1.dist-info"
    info.mkdir()
    (info / "METADATA").write_text(f"Metadata-Version: 2.1\nName: {name}\nVersion: 1.1.1\n")
    lines = (f"{file.relative_to(home).as_posix()},sha256=x,{file.stat().st_size}\n" for file in files)
    (info / "RECORD").write_text("".join(lines))


def _add(home: Path, name: str, *paths: str) -> None:
    files = [home / path for path in paths]
    for file in files:
        file.write_text("expect = None\n")
    _record(home, name, files)


def _run(*path: Path, words: str = "", cwd: Path | None = None) -> subprocess.CompletedProcess[str]:
    """The program with these folders to import from, or a command line of ours."""
    return subprocess.run(
        [sys.executable, *(["-m", "serendipity", words] if words else ["-c", PROGRAM])],
        env=os.environ | {"PYTHONPATH": os.pathsep.join(map(str, path))},
        cwd=cwd or path[0].parent,
        capture_output=True,
        text=True,
    )


def test_nobody_else_is_no_complaint(installed: Path) -> None:
    (installed / "verify" / "notes.py").touch()  # of nobody's list: the user's own business
    assert _run(installed).stdout == ""


@pytest.mark.parametrize(
    ("name", "paths"),
    [
        ("verify", ("verify/__init__.py", "verify/expect.py")),  # installed after ours
        ("verify", ("verify/expect.py",)),  # before ours, which replaced its first file
        ("serendipity", ("serendipity/interface.py",)),
    ],
)
def test_another_distribution_is_named_with_what_to_do(
    name: str, paths: tuple[str, ...], installed: Path
) -> None:
    _add(installed, name, *paths)
    _, _, said = _run(installed).stdout.partition(" ")
    assert said.startswith(f"{name} 1.1.1 has put files among those of serendipity-planner in {installed}: ")
    assert f"`pip uninstall {name}`, and then `pip install --force-reinstall" in said
    done = _run(installed, words="examples")
    assert (done.returncode, done.stdout, done.stderr) == (2, "", f"Error: {said}")


def test_the_command_notices_that_the_package_is_another_ones(installed: Path) -> None:
    _add(installed, "serendipity", "serendipity/__init__.py")
    done = _run(installed, words="examples")
    assert done.returncode == 2
    assert done.stderr.startswith("Error: serendipity 1.1.1 has put files among those of serendipity-planner")


def test_what_an_uninstaller_took_is_to_be_installed_again(installed: Path) -> None:
    (installed / "verify" / "__init__.py").unlink()
    done = _run(installed, words="examples")
    assert done.returncode == 2
    assert done.stderr.endswith("again, `pip install --force-reinstall --no-deps serendipity-planner`\n")
    assert done.stderr.count("\n") == 1


def test_a_file_in_the_working_folder_does_not_come_before_ours(tmp_path: Path) -> None:
    (tmp_path / "search.py").write_text("raise SystemExit('the stranger ran')")
    assert _run(ROOT, words="examples", cwd=tmp_path).returncode == 0


@pytest.mark.parametrize("name", ["search", "verify"])
@pytest.mark.parametrize("kind", ["package", "module", "namespace"])
def test_a_strangers_package_is_refused_by_name(name: str, kind: str, tmp_path: Path) -> None:
    folder = tmp_path / name
    if kind != "module":
        folder.mkdir()
    if kind != "namespace":
        file = folder / "__init__.py" if kind == "package" else folder.with_suffix(".py")
        file.write_text("raise SystemExit('the stranger ran')")
    done = _run(tmp_path, ROOT, cwd=tmp_path)
    if kind == "namespace":  # Python itself prefers our package to a folder without __init__.py
        assert (done.returncode, done.stdout) == (0, "")
    else:
        assert done.stdout.startswith(f"{name} serendipity needs its own package '{name}'")
        assert str(tmp_path) in done.stdout and "uninstall or rename" in done.stdout
