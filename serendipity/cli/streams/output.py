"""Where answers go: stdout, or files that are there whole or not at all."""

import os
import sys
from collections.abc import Collection, Sequence
from contextlib import nullcontext
from inspect import Parameter
from pathlib import Path
from typing import Annotated, Any, Final, NamedTuple

from serendipity.cli.choices import option
from serendipity.cli.groups import OptionGroup
from serendipity.cli.streams.manner import is_quiet
from serendipity.cli.streams.stderr import tell
from serendipity.model import UsageError
from serendipity.writing.rows import FORMATS as ROWS
from serendipity.writing.rows import check_installed

FORMATS: Final = ("text", "json")
DATA: Final = (*FORMATS, *ROWS)
"""The formats of commands whose answers have rows."""

PICTURES: Final = (".svg", ".png")


def formats(names: Sequence[str], help: str) -> Parameter:  # noqa: A002 - typer's word
    """``--format`` of a command whose answers have other formats than text and JSON."""
    kind = Annotated[str | None, option(f"--format {'|'.join(names)}", help)]
    return Parameter("format", Parameter.KEYWORD_ONLY, default=None, annotation=kind)


ROWS_TOO: Final = formats(DATA, "By default after -o's name, else text.")
"""That of commands whose answers have rows."""


class Destination(OptionGroup):
    """Where an answer goes, and in which format."""

    format: Annotated[str | None, option(f"--format {'|'.join(FORMATS)}", "Text, or JSON for -o *.json.")] = (
        None
    )
    output_file: Annotated[Path | None, option("-o, --output FILE", "Write the answer here.")] = None

    def prepare(self, formats: Collection[str] = FORMATS) -> str:
        """Before the work: what can be known to be wrong with ``-o``, and the format in force."""
        form = choose_format(self.format, self.output_file, formats)
        check_output(self.output_file)
        return form


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


def choose_format(wanted: str | None, output: Path | None, formats: Collection[str] = FORMATS) -> str:
    """The format in force: the one asked for, else the one that ``-o`` ends in, else the first."""
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
    """Complain about a file to be written before the work is done, not after."""
    if output is None:
        return
    if output.is_dir():
        raise UsageError(f"{option}: expected a file, but {output} is a folder")
    if not output.parent.is_dir():
        raise UsageError(f"{option}: there is no folder {output.parent}")
    if not os.access(output.parent, os.W_OK) and not output.exists():
        raise UsageError(f"{option}: the folder {output.parent} can't be written to")


def check_picture(picture: Path | None, option: str, to: Path | None) -> None:
    """Complain about a picture's file, as above, and one in the place of the answer's."""
    check_output(picture, option)
    if picture is not None and picture.suffix not in PICTURES:
        raise UsageError(f"{option}: expected a file that ends in {', '.join(PICTURES)}, got {picture}")
    if to is not None and to.suffix in PICTURES:
        raise UsageError(f"-o: is for text and data; a picture is {option} {to}")


def write_answer(answer: str | bytes, output: Path | None) -> None:
    """Write an answer to ``output``; a text to stdout where that is None."""
    write_answers([Answer(answer, output)])


def write_answers(answers: list[Answer]) -> None:
    """Write several answers: all of them, or none."""
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
    """Write a text to stdout."""
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
    """Make sure that what others have written to stdout, such as help, is there."""
    if sys.stdout is not None:
        say("")


def warn(*lines: str) -> None:
    """Print warnings to stderr, unless the user asked for quiet."""
    if not is_quiet():
        for line in lines:
            tell(f"Warning: {line}")
