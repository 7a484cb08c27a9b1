"""``serendipity check-task``: is a task what its author meant?"""

from pathlib import Path

import serendipity
from serendipity.cli.exit_codes import ExitCode
from serendipity.cli.options import limits, naming
from serendipity.cli.streams import output, progress
from serendipity.cli.text.render import shown


def check_task(*, task: naming.TaskName, limited: limits.Limits, to: output.Destination) -> int:
    """Look at a task before planning. Its size, goals out of reach, and what is declared and not used."""
    form = to.prepare()
    named = task.settled()
    deadline = limited.begin("serendipity.lint")
    loaded = named.read(deadline)
    with progress.working("checking"), limits.during("checking the task"):
        report = serendipity.check_task(loaded, _files(named), deadline=deadline)
    output.write_answer(shown(report, form), to.output_file)
    return ExitCode.ANSWERED if report.right else ExitCode.REFUTED


def _files(name: naming.TaskName) -> list[tuple[Path, Path]]:
    """Domain and problem of each pair of files that a task is read from."""
    if name.example is not None:
        from serendipity.scenarios.examples import DATA, EXAMPLES

        shipped = EXAMPLES[name.example]
        return [(DATA / shipped.domain, DATA / shipped.problem)]
    if name.agent:
        agents, team = name.pairs()
        return [*agents.values(), *([] if team is None else [team])]
    files = name.files or []
    if len(files) == 2:
        return [(files[0], files[1])]
    folders = sorted(folder for folder in files[0].iterdir() if folder.is_dir())
    pairs = ((folder / "domain.pddl", folder / "problem.pddl") for folder in folders)
    return [(domain, problem) for domain, problem in pairs if domain.exists() and problem.exists()]
