"""Beside a large task a collection takes longer than a short deadline: there is none while it plans."""

import gc

import pytest

import serendipity
from serendipity.model.resources.collection import no_collection


@pytest.fixture
def seen():
    return []


@pytest.fixture
def asked(seen):
    def visible(*_):
        seen.append(gc.isenabled())
        return True

    return {"task": serendipity.example("room2"), "human_model": "local", "visible": visible, "discount": 0.6}


def test_the_collector_is_off_while_it_plans_and_on_between_answers_and_behind(asked, seen):
    between = [gc.isenabled() for _ in serendipity.plan_anytime(**asked)]
    serendipity.plan(**asked)
    assert seen and not any(seen)
    assert all(between) and gc.isenabled()


def test_what_stays_is_not_looked_at_at_the_end():
    started = []
    gc.collect()
    gc.callbacks.append(lambda *event: started.append(event))
    try:
        with no_collection():
            kept = [[] for _ in range(100_000)]
        kept.append([])
    finally:
        gc.callbacks.pop()
    assert not started


def test_what_the_caller_has_frozen_stays_so():
    gc.collect()
    gc.freeze()
    try:
        frozen = gc.get_freeze_count()
        with no_collection():
            kept = [[] for _ in range(100_000)]
        assert gc.get_freeze_count() == frozen
        assert kept
    finally:
        gc.unfreeze()
