"""Logs as they are read back."""

import json

from serendipity.execution import Execution, LogLine, log_lines


def as_lines(run: Execution) -> list[LogLine]:
    """The lines of an execution's log, by way of JSON."""
    lines = json.loads(json.dumps(list(log_lines(run, seed=1))))
    return [LogLine(number, line) for number, line in enumerate(lines, start=1)]
