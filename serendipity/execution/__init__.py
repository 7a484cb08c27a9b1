"""Help while it happens: a person, robots and the world go on epoch by epoch."""

from serendipity.execution.decided import VERDICTS, Decided, Passed
from serendipity.execution.execution import Execution
from serendipity.execution.persons import (
    Moment,
    Noisy,
    Omniscient,
    Person,
    Recorded,
    Replanner,
    moment_of,
)
from serendipity.execution.world import Actuator, Outcome

__all__ = [
    "VERDICTS",
    "Actuator",
    "Decided",
    "Execution",
    "Moment",
    "Noisy",
    "Omniscient",
    "Outcome",
    "Passed",
    "Person",
    "Recorded",
    "Replanner",
    "moment_of",
]
