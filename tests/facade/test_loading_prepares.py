"""What takes long on a large task is done when it is loaded, not in the first call."""

import pytest

import serendipity
from search.packed.packed_task import PackedTask
from serendipity import pddl


def _no_packing(*_: object) -> None:
    raise AssertionError("packed in a planning call")


@pytest.fixture
def folder(tmp_path):
    serendipity.generate_usar(tmp_path / "building", rooms=60, medkits=4, seed=1)
    return tmp_path / "building"


def test_a_large_task_is_packed_when_it_is_loaded(folder, monkeypatch):
    task = serendipity.load(folder)
    monkeypatch.setattr(PackedTask, "__init__", _no_packing)
    assert serendipity.plan(task, discount=0.6).status == "optimal"


def test_what_is_only_read_is_packed_by_the_first_call_and_both_plan_alike(folder, monkeypatch):
    task = pddl.read_folder(folder)
    with monkeypatch.context() as patch:
        patch.setattr(PackedTask, "__init__", _no_packing)
        with pytest.raises(AssertionError, match="packed in a planning call"):
            serendipity.plan(task, discount=0.6)
    loaded, read = (serendipity.plan(each, discount=0.6) for each in (serendipity.load(folder), task))
    assert (loaded.cost, loaded.plan) == (read.cost, read.plan)
