"""The typer application: its commands, and the one place where errors become exit codes."""

import io
import sys
from collections.abc import Sequence
from contextvars import copy_context
from typing import Annotated, Final

import typer

from serendipity import __version__
from serendipity.cli.exit_codes import ExitCode
from serendipity.cli.help_examples import epilog
from serendipity.cli.on_demand import Commands
from serendipity.cli.options import settings
from serendipity.cli.streams import output
from serendipity.cli.streams.manner import log_origin
from serendipity.cli.streams.stderr import tell
from serendipity.model import LimitReachedError, SerendipityError
from serendipity.model.errors import REPORT, limit_words, told

app = typer.Typer(
    name="serendipity",
    cls=Commands,
    help="Plan help for a person who did not ask for it, and prove that none is better.",
    epilog=epilog(),
    rich_markup_mode=None,
    pretty_exceptions_enable=False,
    context_settings={"help_option_names": ["-h", "--help"]},
)


def _show_version(wanted: bool) -> None:
    if wanted:
        from search.kernel.library import state

        output.say(f"serendipity {__version__}, kernel: {state()}\n")
        raise typer.Exit


@app.callback()
def _root(
    context: typer.Context,
    version: Annotated[  # noqa: ARG001 - its callback prints it
        bool,
        typer.Option("--version", callback=_show_version, is_eager=True, help="Print version and kernel."),
    ] = False,
    no_settings: Annotated[
        bool, typer.Option("--no-settings", help="Heed no serendipity.toml and no [tool.serendipity].")
    ] = False,
) -> None:
    command = context.invoked_subcommand
    if command in settings.COMMANDS and not no_settings:
        context.default_map = {command: settings.begin(command)}


def main(argv: Sequence[str] | None = None) -> int:
    """Run a command line, or the process's, and return its exit code; errors are one line on stderr."""
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper):
            stream.reconfigure(errors="backslashreplace")  # names that the terminal can't show
    try:
        code = copy_context().run(_run, sys.argv[1:] if argv is None else argv)
    except (typer.Abort, KeyboardInterrupt):
        code = ExitCode.INTERRUPTED
    if code == ExitCode.INTERRUPTED:  # typer may have turned Ctrl-C into this code
        tell("Interrupted.")
    return code


def _run(argv: Sequence[str]) -> int:
    try:
        code = int(app(args=argv or ["--help"], prog_name="serendipity", standalone_mode=False) or 0)
        output.flush()
    except typer.TyperException as error:
        return _fail(error.format_message())
    except LimitReachedError as error:
        return _stop(str(error), error.reason)
    except MemoryError:
        return _stop(limit_words("memory-limit"), "memory-limit")
    except (SerendipityError, ImportError) as error:
        log_origin()
        return _fail(f"{error}{settings.origin(str(error))}")
    except OSError as error:
        where = error.filename or "standard output"
        return _fail(f"{where} can't be written: {error.strerror}")
    except SystemExit as left:  # typer's way out where the reader of its help has stopped, and of completion
        return ExitCode.ANSWERED if left.code == 1 else int(left.code or 0)
    except typer.Abort:
        raise
    except Exception as error:  # a fault of ours
        log_origin()
        _fail(f"{told(error)}: {REPORT}")
        return ExitCode.UNEXPECTED
    return code


_MORE: Final = {
    "time-limit": "; give more with --time-limit",
    "memory-limit": "; give more with --memory-limit, or on a machine that has more",
}
"""What to do about a limit that came before there was anything to answer."""


def _stop(message: str, reason: str) -> int:
    tell(f"{message[0].upper()}{message[1:]}{_MORE.get(reason, '')}")
    return ExitCode.UNDECIDED


def _fail(message: str) -> int:
    tell(f"Error: {message}")
    return ExitCode.WRONG_INPUT
