"""``serendipity play``: a page on which a person plays the human."""

from contextlib import nullcontext
from fractions import Fraction
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Final

from serendipity.cli.choices import option
from serendipity.cli.exit_codes import ExitCode
from serendipity.cli.options import naming, planning
from serendipity.cli.streams import output, progress
from serendipity.cli.streams.manner import is_quiet
from serendipity.cli.streams.stderr import tell
from serendipity.model import UsageError, exact
from serendipity.model.options import limit_of

if TYPE_CHECKING:
    from serendipity_live.play.application import Host

_EXAMPLE: Final = "room2"
_VIEWS: Final = ("observant", "local")
_CONDITIONS: Final = ("none", "silent", "announced")
_USUAL: Final = {"view": "observant", "discount": Fraction(3, 5), "deadline": 2.0}
_RECORDS: Final = Path("serendipity-play")


def play(
    *,
    task: naming.TaskName,
    discount: Annotated[
        str | None, option("--discount D", "Taken off the cost of robots' actions, 0 to 1; by default 0.6.")
    ] = None,
    view: Annotated[
        str | None,
        option(
            f"--view {'|'.join(_VIEWS)}",
            "Whether you see everything (the default), or what is where you are.",
        ),
    ] = None,
    robots: Annotated[
        str | None,
        option(
            f"--robots-are {'|'.join(_CONDITIONS)}", "Whether robots help, and say so; by default silent."
        ),
    ] = None,
    goals: planning.Goals = None,
    deadline: Annotated[
        str | None, option("--deadline SECONDS", "For each decision of the robots; by default 2.")
    ] = None,
    labels: Annotated[
        Path | None, option("--labels FILE", "Sentences for the actions and goals of the domain.")
    ] = None,
    study: Annotated[
        Path | None, option("--study FOLDER", "Run a study, or go on with it; records go to the folder.")
    ] = None,
    report: Annotated[
        bool, option("--report", "Say what the conditions of the study come to, and end.")
    ] = False,
    records: Annotated[
        Path | None,
        option(
            "--records PLACE",
            "A folder for records, by default serendipity-play; or a record, to go on with it.",
        ),
    ] = None,
    rounds: Annotated[int | None, option("--rounds N", "Scenarios of a study; by default 4.")] = None,
    seed: Annotated[
        int | None, option("--seed S", "Of a study: scenarios and conditions; by default drawn.")
    ] = None,
    language: Annotated[
        str | None,
        option("--language en|de|FILE", "Of a study: what its page speaks; a file is one of the folder."),
    ] = None,
    host: Annotated[str, option("--host ADDRESS", "Where a study listens.")] = "127.0.0.1",
    port: Annotated[int, option("--port N", "0 for any that is free.")] = 8124,
    allow_host: Annotated[
        list[str] | None, option("--allow-host NAME", "Another name under which it may be asked.")
    ] = None,
) -> int:
    """Play the human yourself, on a page of this machine. It needs serendipity-planner[live]."""
    given = _given(view, robots, discount, deadline)
    named = bool(task.files or task.agent or task.example)
    _fits(
        study is not None,
        beside={
            "a task": named,
            "--robots-are": robots is not None,
            "--goals": goals is not None,
            "--records": records is not None,
        },
        only={
            "--report": report,
            "--rounds": rounds is not None,
            "--seed": seed is not None,
            "--language": language is not None,
            "--host": host != "127.0.0.1",
            "--allow-host": allow_host is not None,
        },
    )
    if rounds is not None and not 1 <= rounds <= 50:
        raise UsageError(f"--rounds: expected a number from 1 to 50, got {rounds}")
    try:
        from serendipity_live.guards import connections
        from serendipity_live.play.application import application
    except ImportError as missing:
        raise UsageError(f"play: needs {missing.name}: install serendipity-planner[live]") from None
    opened: Host
    if study is not None:
        from serendipity_live.study.design import open_design
        from serendipity_live.study.study import Study

        settings = {"rounds": rounds, "seed": seed, **given}
        if "discount" in given:
            settings["discount"] = str(given["discount"])
        with nullcontext() if report else connections.listening(host, port) as listener:
            with progress.working("playing scenarios"):
                design = open_design(study, labels, language, **settings)
            if listener is None:
                output.say(design.report)
                return ExitCode.ANSWERED
            opened = Study(design, study)
            url = connections.url(listener)
            _say(
                f"Participants join on {url}; Ctrl-C stops it. Recorded in {study}.\n"
                f"For whoever runs it: {url}/experimenter/{design.secret}/\n{design.report}"
            )
            for fault in opened.faults:
                tell(f"Warning: {fault}")
            connections.serve(application(opened, connections.hosts(host, allow_host or ())), listener)
        return ExitCode.ANSWERED
    from serendipity_live.play.labels import labels_for
    from serendipity_live.play.records import record_in
    from serendipity_live.play.round import RoundSetting
    from serendipity_live.play.rounds import SharedRounds

    shown = task.example if named else _EXAMPLE
    loaded = task.but(example=shown).load()
    with connections.listening(host, port) as listener:  # first, or a port in use leaves an empty record
        with progress.working("getting ready"):
            where = record_in(records or _RECORDS)
            how: dict[str, Any] = {**_USUAL, **given, "condition": robots or "silent", "goals": goals}
            setting = RoundSetting(shown or loaded.name, loaded, labels=labels_for(loaded, labels), **how)
            opened = SharedRounds(setting, where)
        _say(
            f"Play on {connections.url(listener)}; Ctrl-C stops it. Recorded in {where}.\n"
            f"To go on with this round another time: --records {where}\n"
        )
        connections.serve(application(opened, connections.hosts(host)), listener)
    return ExitCode.ANSWERED


def _say(text: str) -> None:
    if not is_quiet():
        output.say(text)


def _given(
    view: str | None, robots: str | None, discount: str | None, deadline: str | None
) -> dict[str, Any]:
    """What is said of how a round is played, checked."""
    for name, value, known in (("--view", view, _VIEWS), ("--robots-are", robots, _CONDITIONS)):
        if value is not None and value not in known:
            raise UsageError(f"{name}: expected one of {', '.join(known)}, got '{value}'")
    share = None if discount is None else exact(discount, "discount")
    if share is not None and not 0 <= share <= 1:
        raise UsageError(f"discount: expected a number in [0, 1], got {discount}")
    seconds = None if deadline is None else limit_of("deadline", deadline, "seconds")
    return planning.given(view=view, discount=share, deadline=seconds)


def _fits(study: bool, *, beside: dict[str, bool], only: dict[str, bool]) -> None:
    """Refuse what does not go with a study, or only with one."""
    wrong = next((option for option, given in (beside if study else only).items() if given), None)
    if wrong is not None and study:
        raise UsageError(f"--study: has scenarios, conditions and records of its own: leave out {wrong}")
    if wrong is not None:
        raise UsageError(f"{wrong}: goes with --study")
