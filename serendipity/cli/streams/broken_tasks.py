"""What is said of tasks of a suite that could not be worked on, when all others are done."""

from collections.abc import Mapping
from typing import Final

from serendipity.cli.exit_codes import ExitCode
from serendipity.cli.streams.stderr import tell
from serendipity.model.errors import REPORT, is_unexpected

_MOST: Final = 10


def broken_tasks(reasons: Mapping[str, str]) -> ExitCode:
    """Say why by task, and with which exit code the command ends."""
    for task, reason in list(reasons.items())[:_MOST]:
        tell(f"Error: {task}: {reason}{f': {REPORT}' if is_unexpected(reason) else ''}")
    if len(reasons) > _MOST:
        tell(f"Error: and {len(reasons) - _MOST} tasks more")
    faults = any(map(is_unexpected, reasons.values()))
    return ExitCode.UNEXPECTED if faults else ExitCode.WRONG_INPUT
