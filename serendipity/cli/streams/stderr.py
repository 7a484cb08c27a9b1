"""Lines on standard error: readable, short, and lost without a complaint where nobody listens."""

import sys
from collections.abc import Mapping
from typing import Final

from serendipity.cli.exit_codes import ExitCode
from serendipity.model.errors import REPORT, is_unexpected
from serendipity.model.printable import message


def tell(text: str) -> None:
    """Write one message to people."""
    write_line(message(text))


def write_line(line: str) -> None:
    """Write a line as it is; nothing happens where standard error is closed or full."""
    if sys.stderr is None:
        return
    try:
        sys.stderr.write(f"{line}\n")
        sys.stderr.flush()
    except (OSError, ValueError):
        return


def is_terminal() -> bool:
    """Whether a person sees what is written."""
    return sys.stderr is not None and sys.stderr.isatty()


_MOST: Final = 10


def broken_tasks(reasons: Mapping[str, str]) -> ExitCode:
    """Say why by task, and with which exit code the command ends."""
    for task, reason in list(reasons.items())[:_MOST]:
        tell(f"Error: {task}: {reason}{f': {REPORT}' if is_unexpected(reason) else ''}")
    if len(reasons) > _MOST:
        tell(f"Error: and {len(reasons) - _MOST} tasks more")
    faults = any(map(is_unexpected, reasons.values()))
    return ExitCode.UNEXPECTED if faults else ExitCode.WRONG_INPUT
