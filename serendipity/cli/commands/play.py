"""``serendipity play``: a page on which a person plays the human."""

from pathlib import Path
from typing import Annotated, Final

import typer

from serendipity.cli.choices import choices
from serendipity.cli.exit_codes import ExitCode
from serendipity.cli.options import naming
from serendipity.cli.streams import output, progress
from serendipity.cli.text import goals as goal_options
from serendipity.model import UsageError
from serendipity.model.numbers import exact
from serendipity.model.options import limit_of

_EXAMPLE: Final = "room2"
_VIEWS: Final = ("observant", "local")
_CONDITIONS: Final = ("none", "silent", "announced")


def play(
    files: naming.Files = None,
    human: naming.Human = None,
    robot: naming.Robots = None,
    agent: naming.Agents = None,
    team: naming.Team = None,
    example: naming.Example = None,
    discount: Annotated[
        str, typer.Option("--discount", metavar="D", help="Taken off the cost of robots' actions, 0 to 1.")
    ] = "0.6",
    view: Annotated[
        str,
        typer.Option(
            "--view", help="Whether you see everything, or what is where you are.", **choices(*_VIEWS)
        ),
    ] = "observant",
    robots: Annotated[
        str,
        typer.Option("--robots-are", help="Whether robots help, and say so.", **choices(*_CONDITIONS)),
    ] = "silent",
    goals: goal_options.Goals = None,
    deadline: Annotated[
        str, typer.Option("--deadline", metavar="SECONDS", help="For each decision of the robots.")
    ] = "2",
    study: Annotated[
        Path | None,
        typer.Option("--study", metavar="FOLDER", help="Run a study; records go to the folder."),
    ] = None,
    records: Annotated[
        Path,
        typer.Option(
            "--records", metavar="FOLDER", help="Where every event is written down, unless --study."
        ),
    ] = Path("serendipity-play"),
    rounds: Annotated[
        int, typer.Option("--rounds", metavar="N", help="Scenarios of a study without a task.")
    ] = 4,
    seed: Annotated[
        int, typer.Option("--seed", metavar="S", help="Of a study: scenarios and conditions.")
    ] = 1,
    port: Annotated[int, typer.Option("--port", metavar="N", help="0 for any that is free.")] = 8124,
    quiet: output.Quiet = False,
    verbose: output.Verbose = 0,
) -> int:
    """Play the human yourself, on a page of this machine; needs serendipity-planner[live]."""
    output.start_logging(verbose)
    for option, value, known in (("--view", view, _VIEWS), ("--robots-are", robots, _CONDITIONS)):
        if value not in known:
            raise UsageError(f"{option}: expected one of {', '.join(known)}, got '{value}'")
    if not 1 <= rounds <= 50:
        raise UsageError(f"--rounds: expected a number from 1 to 50, got {rounds}")
    share = exact(discount, "discount")
    if not 0 <= share <= 1:
        raise UsageError(f"discount: expected a number in [0, 1], got {discount}")
    seconds = limit_of("deadline", deadline, "seconds")
    named = bool(files or agent or example)
    if study is not None and named:
        raise UsageError("--study: has scenarios of its own, name no task beside it")
    try:
        from serendipity.live.guards import addresses
        from serendipity.live.play.application import Host, application
        from serendipity.live.play.opening import open_study, open_table, record_in
        from serendipity.live.server import serve as run
    except ImportError as missing:
        raise UsageError(f"play: needs {missing.name}: install serendipity-planner[live]") from None
    how = {"discount": share, "view": view, "goals": goals, "deadline": seconds}
    host: Host
    shown = example if named else _EXAMPLE
    task = None if study is not None else naming.load(files, human, robot, agent, team, shown, quiet=quiet)
    with addresses.listening("127.0.0.1", port) as listener:  # first, or a port in use leaves an empty record
        if task is None:
            assert study is not None
            with progress.working("drawing scenarios", quiet=quiet):
                where, host = study, open_study(study, rounds, seed, **how)
        else:
            with progress.working("getting ready", quiet=quiet):
                where = record_in(records)
                host = open_table(shown or task.name, task, where, condition=robots, **how)
        if not quiet:
            output.say(f"Play on {addresses.url(listener)}; Ctrl-C stops it. Recorded in {where}.\n")
        run(application(host, addresses.hosts("127.0.0.1")), listener)
    return ExitCode.ANSWERED
