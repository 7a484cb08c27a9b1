"""Plan files that say when actions begin, in the form of competitions and in our own."""

from dataclasses import replace
from fractions import Fraction

import pytest

from serendipity.model import InputError, Task
from serendipity.pddl.parsing.timed_plans import entries, plan_lines
from serendipity_testing.builders import task


def home() -> Task:
    """A walk of four epochs, each two units of time long, and something short."""
    built = task(
        goal="out", actions={"walk h": "-> there @ 1 [4]", "leave h": "there -> out", "help r": " -> out"}
    )
    return replace(built, epoch=Fraction(2), known_variables=built.variables)


def read(text: str) -> list[object]:
    return [*entries(plan_lines(text, "plan.txt", "human plan: "), home(), "plan.txt", "human plan: ")]


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("12: (walk h)\n", [(7, "walk h")]),
        ("0: (walk h) [8]\n 10: (LEAVE H)\n", [(1, "walk h"), (6, "LEAVE H")]),
        ("0.000: (walk h) [8.000]\n8.001: (leave h) [2.0] ; the end\n", [(1, "walk h"), (5, "leave h")]),
        ("; a day\n; epoch 3\n(walk h)\n; epoch 9\n(leave h)\n", [(3, "walk h"), (9, "leave h")]),
        ("# epoch 2\nwalk h\n", [(2, "walk h")]),
        ("0: (walk h)\n20: (noop)\n", [(1, "walk h"), (11, "noop")]),
        ("(walk h)\n(leave h)\n", ["walk h", "leave h"]),
        ("1: walk h\n2: leave h\n", ["walk h", "leave h"]),
        ("3 - walk h\n", ["walk h"]),
        ('["walk h", "leave h"]', ["walk h", "leave h"]),
        ("(walk h) [8]\n", ["walk h"]),
        ("", []),
    ],
)
def test_times_are_told(text: str, expected: list[object]) -> None:
    assert read(text) == expected


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (
            "0: (walk h)\n(leave h)\n",
            "plan.txt:2: human plan: expected a time, as in '12: (walk ann bed sink)'",
        ),
        (
            "0: (walk h) (leave h)\n",
            "plan.txt:1: human plan: expected one action, as 'move commx room13 hall8'",
        ),
    ],
)
def test_what_is_wrong_is_said_with_its_line(text: str, message: str) -> None:
    with pytest.raises(InputError) as caught:
        read(text)
    assert str(caught.value).startswith(message)
