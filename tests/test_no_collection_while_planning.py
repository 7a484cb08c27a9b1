"""Beside a large task a collection takes longer than a short deadline: there is none while it plans."""

import gc

import pytest

import serendipity


@pytest.fixture
def seen():
    return []


@pytest.fixture
def asked(seen):
    def visible(agent, fact, state):
        seen.append(gc.isenabled())
        return True

    return {"task": serendipity.example("room2"), "human_model": "local", "visible": visible, "discount": 0.6}


def test_plan_switches_the_collector_off_and_on_again(asked, seen):
    serendipity.plan(**asked)
    assert seen
    assert not any(seen)
    assert gc.isenabled()


def test_between_answers_it_is_on(asked, seen):
    between = [gc.isenabled() for _ in serendipity.plan_anytime(**asked)]
    assert seen
    assert not any(seen)
    assert all(between)
