"""The import contracts speak of every room that there is: a new one has to be given its place."""

import tomllib
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[1]
_SETTINGS = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))
CONTRACTS = {contract["name"]: contract for contract in _SETTINGS["tool"]["importlinter"]["contracts"]}


def children(package: str) -> set[str]:
    """The modules and packages directly inside a package."""
    folder = ROOT / package.replace(".", "/")
    found = {path.stem for path in folder.glob("*.py")} | {
        path.parent.name for path in folder.glob("*/__init__.py")
    }
    return {f"{package}.{name}" for name in found - {"tests"} if not name.startswith("_")}


PACKAGES = [name.removeprefix("rooms of ") for name in CONTRACTS if name.startswith("rooms of ")]


@pytest.mark.parametrize("package", PACKAGES)
def test_every_room_has_a_place(package: str) -> None:
    contract = CONTRACTS[f"rooms of {package}"]
    layers = contract["layers"] if contract["type"] == "layers" else contract["modules"]
    named = {name.strip() for layer in layers for name in layer.split("|")}
    listed = {name for name in named if name.startswith(f"{package}.")}
    differing = sorted(listed ^ children(package))
    assert not differing, f"'rooms of {package}' in pyproject.toml and the folder differ in {differing}"


def test_search_and_verify_import_the_model_only() -> None:
    forbidden = CONTRACTS["of serendipity, search and verify import the model only"]["forbidden_modules"]
    beside = {folder.name for folder in ROOT.glob("serendipity_*") if folder.is_dir()}
    assert set(forbidden) == children("serendipity") - {"serendipity.model"} | beside
