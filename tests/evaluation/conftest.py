"""A suite of our own."""

import shutil
from pathlib import Path

import pytest

from serendipity.scenarios.examples import DATA


@pytest.fixture(scope="session")
def suite(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Parcels twice, flights once."""
    folder = tmp_path_factory.mktemp("suite")
    for name in ("flights", "parcels"):
        shutil.copytree(DATA / name, folder / name)
    first = folder / "parcels" / "parcels.pddl"
    text = first.read_text().replace("(and (at box inn) (at flour market))", "(at flour inn)")
    first.with_name("flour.pddl").write_text(text)
    return folder
