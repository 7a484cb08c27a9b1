"""``serendipity learn``: the plans that somebody follows, from logs of their days."""

from typing import Annotated

from serendipity.cli.choices import option
from serendipity.cli.exit_codes import ExitCode
from serendipity.cli.options import naming, planning
from serendipity.cli.streams import output, progress
from serendipity.cli.text.render import shown
from serendipity.model import UsageError

_FILES = naming.files("TASK TRACES", "The task, named as for `plan`; then logs: `execute --log`, or CSV.")


def learn(
    *,
    task: Annotated[naming.TaskName, _FILES],
    on: Annotated[str | None, option("--on DAY", "mon to sun, weekday or weekend: count such days.")] = None,
    at: Annotated[str | None, option("--at HH:MM", "Count what begins up to an hour from then.")] = None,
    after: Annotated[
        str | None, option("--after ACTIVITY", "Count what follows it; 'nothing' at the start of a day.")
    ] = None,
    usual: Annotated[
        str | None,
        option("--usual N", "How many episodes the habits at all times count for. [default: 1]"),
    ] = None,
    to: output.Destination,
) -> int:
    """Count which plans a person follows, for `plan --plans`."""
    form = to.prepare()
    *named, traces = task.files or []
    if traces.suffix == ".pddl" or traces.is_dir():
        raise UsageError(f"learn: expected TASK and then TRACES, got {traces} last")
    loaded = task.but(files=named).load()
    from serendipity.execution import learn as learnt

    with progress.working("learning"):
        found = learnt(loaded, traces, **planning.given(on=on, at=at, after=after, usual=usual))
    output.write_answer(shown(found, form), to.output_file)
    return ExitCode.ANSWERED
