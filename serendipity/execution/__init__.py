"""Help while it happens: a person, robots and the world go on epoch by epoch."""

from serendipity._siblings import require_siblings

require_siblings("search", "verify")

from serendipity.execution.adapters import Faults  # noqa: E402
from serendipity.execution.decided import VERDICTS, Decided, Outlook, Passed, Reported, Robots  # noqa: E402  # checked before  # noqa: E402
from serendipity.execution.execution import Execution  # noqa: E402
from serendipity.execution.habits import Habits, KnownPlan, learn  # noqa: E402
from serendipity.execution.log import LogLine, as_text, log_lines, read_logs, replay  # noqa: E402
from serendipity.execution.persons import (  # noqa: E402
    Moment,
    Noisy,
    Omniscient,
    Person,
    Recorded,
    Replanner,
    moment_of,
    person_of,
)
from serendipity.execution.runs import Run, Runs  # noqa: E402
from serendipity.execution.series import execute  # noqa: E402

__all__ = [
    "VERDICTS",
    "Decided",
    "Execution",
    "Faults",
    "Habits",
    "KnownPlan",
    "LogLine",
    "Moment",
    "Noisy",
    "Omniscient",
    "Outlook",
    "Passed",
    "Person",
    "Recorded",
    "Replanner",
    "Reported",
    "Robots",
    "Run",
    "Runs",
    "as_text",
    "execute",
    "learn",
    "log_lines",
    "moment_of",
    "person_of",
    "read_logs",
    "replay",
]
