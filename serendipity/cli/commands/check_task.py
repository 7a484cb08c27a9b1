"""``serendipity check-task``: is a task what its author meant?"""

from pathlib import Path

import serendipity
from serendipity.cli.exit_codes import ExitCode
from serendipity.cli.options import limits, naming
from serendipity.cli.streams import output, progress


def check_task(
    files: naming.Files = None,
    human: naming.Human = None,
    robot: naming.Robots = None,
    agent: naming.Agents = None,
    team: naming.Team = None,
    example: naming.Example = None,
    time_limit: limits.TimeLimit = None,
    memory_limit: limits.MemoryLimit = None,
    format: output.Format = None,  # noqa: A002 - the option's name
    output_file: output.Output = None,
    quiet: output.Quiet = False,
    verbose: output.Verbose = 0,
) -> int:
    """Look at a task before planning. Its size, goals out of reach, and what is declared and not used."""
    form = output.prepare(format, output_file, verbose)
    name = naming.task_name(files, human, robot, agent, team, example)
    deadline = limits.begin(time_limit, memory_limit, "serendipity.lint")
    with progress.working("reading", quiet=quiet), limits.during("reading the task"):
        task = name.load(deadline)
    with progress.working("checking", quiet=quiet), limits.during("checking the task"):
        report = serendipity.check_task(task, _files(name), deadline=deadline)
    if form == "json":
        output.write_answer(report.to_json(), output_file)
    else:
        from serendipity.cli.text.render import rendered

        output.write_answer(rendered(report.told()), output_file)
    return ExitCode.ANSWERED if report.right else ExitCode.REFUTED


def _files(name: naming.TaskName) -> list[tuple[Path, Path]]:
    """Domain and problem of each pair of files that a task is read from."""
    if name.example is not None:
        from serendipity.scenarios.examples import DATA, EXAMPLES

        shipped = EXAMPLES[name.example]
        return [(DATA / shipped.domain, DATA / shipped.problem)]
    if name.agents:
        words = [text.partition("=")[2] for text in name.agents] + [name.team or ""]
        return [
            (Path(domain), Path(problem)) for domain, _, problem in (w.partition(",") for w in words if w)
        ]
    if len(name.files) == 2:
        return [(name.files[0], name.files[1])]
    folders = sorted(folder for folder in name.files[0].iterdir() if folder.is_dir())
    pairs = ((folder / "domain.pddl", folder / "problem.pddl") for folder in folders)
    return [(domain, problem) for domain, problem in pairs if domain.exists() and problem.exists()]
