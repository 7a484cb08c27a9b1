"""Files that grow line by line, and outlive whoever writes them."""

import os
from contextlib import suppress
from pathlib import Path


def append(file: Path, line: str) -> None:
    """Add a line to a file, which is made where it is missing; on return it is on disk.

    Raises:
        OSError: the system refuses; the file is then as it was before.
    """
    before = file.stat().st_size if file.exists() else None
    try:
        with file.open("ab") as opened:
            opened.write(line.encode() + b"\n")
            opened.flush()
            os.fsync(opened.fileno())
    except OSError:
        _cut(file, before)
        raise


def _cut(file: Path, size: int | None) -> None:
    """Take away what has been written beyond a size; the whole file where that is None."""
    with suppress(OSError):
        if size is None:
            file.unlink(missing_ok=True)
        elif file.is_file():
            os.truncate(file, size)
