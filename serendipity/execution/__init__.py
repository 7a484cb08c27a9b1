"""Help while it happens: a person, robots and the world go on epoch by epoch."""

from serendipity.execution.crews import ADAPTERS, Crew, Maker
from serendipity.execution.decided import VERDICTS, Decided, Passed, Reported, event_lines
from serendipity.execution.execution import Execution
from serendipity.execution.faults import Faults
from serendipity.execution.log import LogLine, as_text, log_lines, read_logs, replay
from serendipity.execution.outlook import Outlook, Robots
from serendipity.execution.persons import (
    Moment,
    Noisy,
    Omniscient,
    Person,
    Recorded,
    Replanner,
    moment_of,
)
from serendipity.execution.policies import POLICIES, Policy, policy_from
from serendipity.execution.runs import TIES, Run, Runs, execute

__all__ = [
    "ADAPTERS",
    "POLICIES",
    "TIES",
    "VERDICTS",
    "Crew",
    "Decided",
    "Execution",
    "Faults",
    "LogLine",
    "Maker",
    "Moment",
    "Noisy",
    "Omniscient",
    "Outlook",
    "Passed",
    "Person",
    "Policy",
    "Recorded",
    "Replanner",
    "Reported",
    "Robots",
    "Run",
    "Runs",
    "as_text",
    "event_lines",
    "execute",
    "log_lines",
    "moment_of",
    "policy_from",
    "read_logs",
    "replay",
]
