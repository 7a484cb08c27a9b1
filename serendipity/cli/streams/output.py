"""Where answers go: stdout, or files that are there whole or not at all."""

import os
import sys
from collections.abc import Collection
from contextlib import nullcontext
from pathlib import Path
from typing import Annotated, Any, Final, NamedTuple

import typer

from serendipity.cli.choices import choices
from serendipity.cli.streams.stderr import tell
from serendipity.model.errors import UsageError
from serendipity.writing.rows import FORMATS as ROWS
from serendipity.writing.rows import check_installed

FORMATS: Final = ("text", "json")
DATA: Final = (*FORMATS, *ROWS)
"""The formats of commands whose answers have rows."""

Format = Annotated[
    str | None,
    typer.Option("--format", help="Text, or JSON for -o *.json.", **choices(*FORMATS)),
]
DataFormat = Annotated[
    str | None,
    typer.Option("--format", help="By default after -o's name, else text.", **choices(*DATA)),
]
Output = Annotated[Path | None, typer.Option("-o", "--output", metavar="FILE", help="Write the answer here.")]


def _silence(quiet: bool) -> bool:
    """``--quiet`` goes for what is logged of a missing kernel, too."""
    if quiet or "logging" in sys.modules:
        import logging

        logging.getLogger("search.kernel").setLevel(logging.ERROR if quiet else logging.NOTSET)
    return quiet


Quiet = Annotated[
    bool,
    typer.Option("--quiet", "-q", callback=_silence, help="No warnings and no progress on stderr."),
]
Verbose = Annotated[int, typer.Option("--verbose", "-v", count=True, help="Log to stderr; -vv logs more.")]


class Answer(NamedTuple):
    """Something a command has to say.

    Attributes:
        content: a text, or the bytes of a picture.
        file: where it goes; None is stdout.
        option: that named the file, for errors.
    """

    content: str | bytes
    file: Path | None
    option: str = "-o"

    @property
    def encoded(self) -> bytes:
        """The bytes to be written."""
        return self.content.encode() if isinstance(self.content, str) else self.content


def prepare(
    wanted: str | None, output: Path | None, verbosity: int, formats: Collection[str] = FORMATS
) -> str:
    """Before the work: the log, what can be known to be wrong with ``-o``, and the format in force.

    Raises:
        UsageError: there is no such format, or ``output`` can't be written.
    """
    start_logging(verbosity)
    form = choose_format(wanted, output, formats)
    check_output(output)
    return form


def choose_format(wanted: str | None, output: Path | None, formats: Collection[str] = FORMATS) -> str:
    """The format in force: the one asked for, else the one that ``-o`` ends in, else the first.

    Raises:
        UsageError: there is no such format, or it can't be written here.
    """
    if wanted is None:
        suffix = "" if output is None else output.suffix[1:]
        wanted = suffix if suffix in formats else next(iter(formats))
    if wanted not in formats:
        raise UsageError(f"--format: expected one of {', '.join(formats)}, got '{wanted}'")
    if wanted == "parquet" and output is None:
        raise UsageError("--format: parquet is no text: expected -o FILE with it")
    check_installed(wanted)
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


def write_answer(answer: str | bytes, output: Path | None, option: str = "-o") -> None:
    """Write an answer to ``output``; a text to stdout where that is None.

    Raises:
        UsageError: it can't be written, with the system's reason.
    """
    write_answers([Answer(answer, output, option)])


def write_answers(answers: list[Answer]) -> None:
    """Write several answers: all of them, or none.

    Raises:
        UsageError: one of them can't be written, with the system's reason.
    """
    options = {str(answer.file): answer.option for answer in answers if answer.file is not None}
    files = {answer.file: answer.encoded for answer in answers if answer.file is not None}
    together: Any = nullcontext()
    if files:
        from serendipity.writing.together import written_together

        together = written_together(files)
    try:
        with together:
            for answer in answers:
                if answer.file is None:
                    say(answer.encoded.decode())
    except OSError as error:
        where = f"{options.get(error.filename, '-o')}: {error.filename}"
        raise UsageError(f"{where} can't be written: {error.strerror}") from None


def say(text: str) -> None:
    """Write a text to stdout.

    Raises:
        UsageError: it is closed or full.
    """
    if sys.stdout is None:
        raise UsageError("standard output is closed")
    try:
        sys.stdout.write(text)
        sys.stdout.flush()
    except BrokenPipeError:
        # The reader has stopped, as `head` does: no error, also not when Python closes the stream.
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
    except OSError as error:
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        raise UsageError(f"standard output can't be written: {error.strerror}") from None


def flush() -> None:
    """Make sure that what others have written to stdout, such as help, is there.

    Raises:
        UsageError: stdout is full.
    """
    if sys.stdout is not None:
        say("")


def warn(lines: tuple[str, ...], *, quiet: bool) -> None:
    """Print warnings to stderr, unless the user asked for quiet."""
    if not quiet:
        for line in lines:
            tell(f"Warning: {line}")


def start_logging(verbosity: int) -> None:
    """Log to stderr: nothing but warnings at 0, more at 1 (``-v``), everything at 2."""
    if not verbosity and "logging" not in sys.modules:
        return  # it takes longer to load than many a plan to find
    import logging

    level = (logging.WARNING, logging.INFO, logging.DEBUG)[min(verbosity, 2)]
    handler = logging.StreamHandler(sys.stderr)
    handler.setFormatter(logging.Formatter("%(levelname)s %(name)s: %(message)s"))
    for name in ("serendipity", "search", "verify"):
        logger = logging.getLogger(name)
        logger.handlers = [handler]  # of this call; one of an earlier call would write everything twice
        logger.setLevel(level)


def log_origin() -> None:
    """Log where the error that is being handled came from (``-vv``)."""
    if "logging" in sys.modules:
        import logging

        logging.getLogger("serendipity").debug("the error came from here", exc_info=True)
