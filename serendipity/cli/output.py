"""Where answers go: stdout, or a file that is there whole or not at all."""

import json
import logging
import os
import stat
import sys
import tempfile
from pathlib import Path
from typing import Annotated, Any, Final

import typer

from serendipity.model import UsageError

FORMATS: Final = ("text", "json")

Format = Annotated[
    str | None, typer.Option("--format", metavar="|".join(FORMATS), help="Text, or JSON for -o *.json.")
]
Output = Annotated[Path | None, typer.Option("-o", "--output", metavar="FILE", help="Write the answer here.")]
Quiet = Annotated[bool, typer.Option("--quiet", "-q", help="No warnings and no progress on stderr.")]
Verbose = Annotated[int, typer.Option("--verbose", "-v", count=True, help="Log to stderr; -vv logs more.")]


def prepare(wanted: str | None, output: Path | None, verbosity: int) -> str:
    """Before the work: the log, what can be known to be wrong with ``-o``, and the format in force.

    Raises:
        UsageError: there is no such format, or ``output`` can't be written.
    """
    start_logging(verbosity)
    form = choose_format(wanted, output)
    check_output(output)
    return form


def choose_format(wanted: str | None, output: Path | None) -> str:
    """The format in force: the one asked for, else JSON for ``-o *.json``, else text.

    Raises:
        UsageError: there is no such format.
    """
    if wanted is None:
        return "json" if output is not None and output.suffix == ".json" else "text"
    if wanted not in FORMATS:
        raise UsageError(f"--format: expected one of {', '.join(FORMATS)}, got '{wanted}'")
    return wanted


def check_output(output: Path | None, option: str = "-o") -> None:
    """Complain about a file to be written before the work is done, not after.

    Raises:
        UsageError: its folder is missing or can't be written to, or it is a folder itself.
    """
    if output is None:
        return
    if output.is_dir():
        raise UsageError(f"{option}: expected a file, but {output} is a folder")
    if not output.parent.is_dir():
        raise UsageError(f"{option}: there is no folder {output.parent}")
    if not os.access(output.parent, os.W_OK) and not output.exists():
        raise UsageError(f"{option}: the folder {output.parent} can't be written to")


def as_json(value: dict[str, Any]) -> str:
    """A JSON object as text, indented."""
    return json.dumps(value, indent=1, ensure_ascii=False, allow_nan=False) + "\n"


def write_answer(answer: str | bytes, output: Path | None, option: str = "-o") -> None:
    """Write an answer to ``output``; a text to stdout where that is None.

    Raises:
        UsageError: the file can't be written, with the system's reason.
    """
    if output is None:
        _print(answer if isinstance(answer, str) else answer.decode())
        return
    try:
        _write_whole(output.resolve(), answer.encode() if isinstance(answer, str) else answer)
    except OSError as error:
        raise UsageError(f"{option}: {output} can't be written: {error.strerror}") from None


def _print(text: str) -> None:
    try:
        sys.stdout.write(text)
        sys.stdout.flush()
    except BrokenPipeError:
        # The reader has stopped, as `head` does: no error, also not when Python closes the stream.
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())


def _write_whole(path: Path, content: bytes) -> None:
    if path.exists() and not stat.S_ISREG(path.stat().st_mode):  # a device or a pipe: nothing to replace
        path.write_bytes(content)
        return
    handle, name = tempfile.mkstemp(dir=path.parent, prefix=f".{path.name}.")
    try:
        with os.fdopen(handle, "wb") as file:
            file.write(content)
        Path(name).chmod(path.stat().st_mode & 0o777 if path.exists() else 0o666 & ~_umask())
        Path(name).replace(path)
    except BaseException:
        Path(name).unlink(missing_ok=True)
        raise


def _umask() -> int:
    mask = os.umask(0)
    os.umask(mask)
    return mask


def warn(lines: tuple[str, ...], *, quiet: bool) -> None:
    """Print warnings to stderr, unless the user asked for quiet."""
    if not quiet:
        for line in lines:
            sys.stderr.write(f"Warning: {' '.join(line.split())}\n")


def start_logging(verbosity: int) -> None:
    """Log to stderr: nothing but warnings at 0, progress at 1 (``-v``), everything at 2."""
    level = (logging.WARNING, logging.INFO, logging.DEBUG)[min(verbosity, 2)]
    handler = logging.StreamHandler(sys.stderr)
    handler.setFormatter(logging.Formatter("%(levelname)s %(name)s: %(message)s"))
    for name in ("serendipity", "search", "verify"):
        logger = logging.getLogger(name)
        logger.handlers = [handler]  # of this call; one of an earlier call would write everything twice
        logger.setLevel(level)
