"""The typer application: its commands, and the one place where errors become exit codes."""

import io
import logging
import sys
from collections.abc import Sequence
from typing import Annotated

import typer

from serendipity import __version__
from serendipity.cli import (
    bench,
    crosscheck,
    examples,
    explain,
    generate,
    interruptions,
    plan,
    recognise,
    reproduce,
    show,
    simulate,
    solve,
    verify,
)
from serendipity.cli.exit_codes import ExitCode
from serendipity.cli.help_examples import epilog
from serendipity.model import SerendipityError

log = logging.getLogger("serendipity")

app = typer.Typer(
    name="serendipity",
    help="Plan help for a person who did not ask for it, and prove that none is better.",
    epilog=epilog(),
    add_completion=False,
    no_args_is_help=True,
    rich_markup_mode=None,
    pretty_exceptions_enable=False,
    context_settings={"help_option_names": ["-h", "--help"]},
)
app.command("plan", epilog=epilog("plan"))(plan.plan)
app.command("verify", epilog=epilog("verify"))(verify.verify)
app.command("simulate", epilog=epilog("simulate"))(simulate.simulate)
app.command("explain", epilog=epilog("explain"))(explain.explain)
app.command("interruptions", epilog=epilog("interruptions"))(interruptions.interruptions)
app.command("recognise", epilog=epilog("recognise"))(recognise.recognise)
app.command("reproduce", epilog=epilog("reproduce"))(reproduce.reproduce)
app.command("show", epilog=epilog("show"))(show.show)
app.command("solve", epilog=epilog("solve"))(solve.solve)
app.command("crosscheck", epilog=epilog("crosscheck"))(crosscheck.crosscheck)
app.command("bench", epilog=epilog("bench"))(bench.bench)
app.command("examples", epilog=epilog("examples"))(examples.examples)
app.add_typer(generate.app, name="generate")


def _show_version(wanted: bool) -> None:
    if wanted:
        typer.echo(f"serendipity {__version__}")
        raise typer.Exit


@app.callback()
def _root(
    version: Annotated[
        bool, typer.Option("--version", callback=_show_version, is_eager=True, help="Print the version.")
    ] = False,
) -> None:
    pass


def main(argv: Sequence[str] | None = None) -> int:
    """Run a command line and return its exit code; errors are one line on stderr.

    Args:
        argv: arguments without the program's name; those of the process where None.
    """
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper):
            stream.reconfigure(errors="backslashreplace")  # names that the terminal can't show
    try:
        code = int(app(args=argv, prog_name="serendipity", standalone_mode=False) or 0)
    except typer.TyperException as error:
        return _fail(error.format_message())
    except (SerendipityError, ImportError) as error:
        log.debug("the error came from here", exc_info=True)
        return _fail(str(error))
    except (typer.Abort, KeyboardInterrupt):
        code = ExitCode.INTERRUPTED
    if code == ExitCode.INTERRUPTED:  # typer may have turned Ctrl-C into this code
        sys.stderr.write("Interrupted.\n")
    return code


def _fail(message: str) -> int:
    sys.stderr.write(f"Error: {' '.join(message.split())}\n")
    return ExitCode.WRONG_INPUT
