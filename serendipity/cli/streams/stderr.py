"""Lines on standard error: readable, short, and lost without a complaint where nobody listens."""

import sys

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
