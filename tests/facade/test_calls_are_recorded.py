"""Calls of the library say in records of ``logging`` how they ended, and nothing where nobody asks for it."""

import logging
import subprocess
import sys

import pytest

import serendipity


def test_calls_say_how_they_ended_and_in_how_many_seconds(caplog: pytest.LogCaptureFixture) -> None:
    with caplog.at_level(logging.DEBUG, logger="serendipity"):
        task = serendipity.example("room2")
        result = serendipity.plan(task, discount=0.6)
        serendipity.Session(task).plan(mode="composite")
        serendipity.verify(task, result)
        list(serendipity.plan_anytime(task, discount=0.6))
        with pytest.raises(serendipity.UsageError):
            serendipity.plan(task, discount=2)
    levels = {record.levelname for record in caplog.records if record.name == "serendipity"}
    said = [record.getMessage().rpartition(" in ")[0] for record in caplog.records if record.levelno > 10]
    assert levels == {"DEBUG", "INFO"}
    assert "turn all: better 1 times, bound 1012.6, settled" in said
    assert [words for words in said if not words.startswith("turn ")] == [
        "plan: serendipity: optimal, cost 12.6",
        "plan: composite: optimal, cost 13",
        "verify: proved",
        "plan_anytime: serendipity: optimal, cost 12.6",
        "plan: UsageError",
    ]


def test_nothing_is_said_or_loaded_unless_somebody_sets_it_up() -> None:
    program = """
import sys, serendipity
serendipity.plan(serendipity.example("room2"), discount=0.6)
assert "logging" not in sys.modules
import logging
serendipity.plan(serendipity.example("room2"), discount=0.6)
"""
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True)
    assert done.stdout == done.stderr == ""
