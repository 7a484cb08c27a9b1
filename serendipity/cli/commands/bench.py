"""``serendipity bench``: the search, integer programs and Fast Downward on the same calls; scaling series."""

import tempfile
from collections.abc import Iterator, Sequence
from dataclasses import astuple, fields
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from serendipity.cli.choices import choices
from serendipity.cli.exit_codes import ExitCode
from serendipity.cli.streams import output, progress
from serendipity.cli.text.render import Grid, Line, rendered
from serendipity.model import InputError, Task, UsageError
from serendipity.writing.csv_text import as_csv

if TYPE_CHECKING:
    from serendipity.evaluation.benchmark import Sample, Timing


def bench(
    folder: Annotated[
        Path | None,
        typer.Argument(help="Tasks in folders, as for `reproduce`; generated buildings without one."),
    ] = None,
    stride: Annotated[int, typer.Option(min=1, help="Take every N-th task of the folder.")] = 1,
    rooms: Annotated[int, typer.Option(min=2, help="Rooms of generated buildings.")] = 21,
    medkits: Annotated[int, typer.Option(min=1, help="Their medkits.")] = 2,
    robots: Annotated[int, typer.Option(min=1, help="Their robots.")] = 1,
    seeds: Annotated[
        int | None,
        typer.Option(min=1, help="How many to generate: 10; for each value of a scaling series 5."),
    ] = None,
    modes: Annotated[
        str,
        typer.Option(
            help="Modes, separated by commas; composite-inf is composite mode without a horizon, the "
            "only one that Fast Downward knows."
        ),
    ] = "serendipity,communication,composite-inf",
    discounts: Annotated[str, typer.Option(help="Discounts, separated by commas.")] = "0,0.5,0.9",
    contenders: Annotated[
        str,
        typer.Option(
            help="Some of search (first calls), in-turn (each task's discounts one after another), again "
            "(the same call again), automata, paper, fast-downward, separated by commas."
        ),
    ] = "search,in-turn,automata,fast-downward",
    scaling: Annotated[
        str | None,
        typer.Option(
            help="How the search scales instead: some of rooms, medkits, robots, length, modes, discounts.",
            **choices("AXES", "all"),
        ),
    ] = None,
    repeat: Annotated[
        int, typer.Option(min=1, help="Calls per figure, after a warm-up; passes for in-turn.")
    ] = 5,
    time_limit: Annotated[float, typer.Option(min=0, help="Seconds for each call.")] = 20.0,
    output_file: output.Output = None,
    plot: Annotated[
        Path | None,
        typer.Option("--plot", metavar="FILE", help="Log-log plot: .png, .svg or .pdf (needs matplotlib)."),
    ] = None,
    quiet: output.Quiet = False,
) -> int:
    """Measure the search beside integer programs and Fast Downward; -o writes every timing as CSV."""
    _check_files(output_file, plot)
    if scaling is not None:
        if folder is not None:
            raise UsageError("--scaling: generates its buildings, so it takes no folder")
        return _scaling(scaling, seeds, time_limit, output_file, plot, quiet=quiet)
    from serendipity.evaluation import benchmark

    chosen, absent = _present(contenders.split(","))
    with tempfile.TemporaryDirectory() as scratch:
        if folder is None:
            tasks = list(_generated(Path(scratch), rooms, medkits, robots, seeds or 10))
        else:
            tasks = list(_loaded(folder, stride))
    timings: list[Timing] = []
    found = benchmark.measure(
        tasks, modes.split(","), discounts.split(","), chosen, repeat=repeat, time_limit=time_limit
    )
    with progress.counting("tasks", quiet=quiet) as on_progress:
        for timing in found:
            timings.append(timing)
            on_progress(len({timing.task for timing in timings}), len(tasks))
    output.warn(absent, quiet=quiet)
    most = f"{benchmark.peak_memory():.0f} MiB with all tasks in memory"
    parts: list[Line | Grid] = [
        Line(f"{len(tasks)} tasks; {benchmark.machine()}"),
        Line(f"Processor time; at most {time_limit:g} s a call; {most}."),
        Line(),
    ]
    ratios = benchmark.ratios(timings)
    if ratios:
        parts += [Grid(benchmark.RATIOS_HEADER, ratios), Line()]
    parts.append(Grid(benchmark.TIMES_HEADER, benchmark.times(timings)))
    answers = [output.Answer(rendered(parts), None), *_as_csv(timings, output_file)]
    if plot is not None:
        from serendipity.evaluation.benchmark.plot import side_by_side

        answers.append(output.Answer(side_by_side(timings, plot.suffix), plot, "--plot"))
    output.write_answers(answers)
    return ExitCode.ANSWERED


def _scaling(
    axes: str,
    seeds: int | None,
    time_limit: float,
    output_file: Path | None,
    plot: Path | None,
    *,
    quiet: bool,
) -> int:
    from serendipity.evaluation import benchmark

    names = list(benchmark.AXES) if axes == "all" else axes.split(",")
    total = len(benchmark.planned(names, seeds or 5))
    samples: list[Sample] = []
    with progress.counting("tasks", quiet=quiet) as on_progress:
        for sample in benchmark.scale(names, seeds=seeds or 5, time_limit=time_limit):
            samples.append(sample)
            on_progress(len(samples), total)
    parts: list[Line | Grid] = [
        Line(f"{len(samples)} tasks, each in a process of its own; {benchmark.machine()}"),
        Line(f"Medians of processor time, at most {time_limit:g} s a call; the most memory."),
        Line(),
        Grid(benchmark.SCALING_HEADER, benchmark.scaling_table(samples)),
        Line(),
        Line("Exponents of time and memory, fitted to all tasks of an axis on a log-log scale:"),
        Line(),
        Grid(benchmark.EXPONENTS_HEADER, benchmark.exponents(samples)),
    ]
    answers = [output.Answer(rendered(parts), None), *_as_csv(samples, output_file)]
    if plot is not None:
        from serendipity.evaluation.benchmark.plot import series

        answers.append(output.Answer(series(samples, plot.suffix), plot, "--plot"))
    output.write_answers(answers)
    return ExitCode.ANSWERED


def _check_files(output_file: Path | None, plot: Path | None) -> None:
    output.check_output(output_file)
    if plot is not None:
        from serendipity.evaluation.benchmark.plot import check_suffix

        output.check_output(plot, "--plot")
        check_suffix(plot.suffix)


def _present(names: Sequence[str]) -> tuple[list[str], tuple[str, ...]]:
    """The contenders that can run here, and a warning for each that can't."""
    from serendipity.evaluation.benchmark import CONTENDERS

    reasons = {name: CONTENDERS[name].absent() for name in names if name in CONTENDERS}
    absent = tuple(reason for reason in reasons.values() if reason is not None)
    return [name for name in names if reasons.get(name) is None], absent


def _as_csv(
    rows: "Sequence[Timing] | Sequence[Sample]", output_file: Path | None
) -> "Iterator[output.Answer]":
    if output_file is not None and rows:
        header = [field.name for field in fields(rows[0])]
        yield output.Answer(as_csv(header, (astuple(row) for row in rows)), output_file)


def _loaded(folder: Path, stride: int) -> Iterator[Task]:
    from serendipity.pddl import read_folder

    if not folder.is_dir():
        raise InputError("expected a folder of tasks", folder)
    found = sorted(path for path in folder.iterdir() if path.is_dir())
    if not found:
        raise InputError("expected a folder for each task in it", folder)
    for path in found[::stride]:
        yield read_folder(path)


def _generated(scratch: Path, rooms: int, medkits: int, robots: int, seeds: int) -> Iterator[Task]:
    from serendipity import generate_usar
    from serendipity.pddl import read_folder

    for seed in range(seeds):
        place = scratch / f"seed{seed}"
        generate_usar(place, rooms=rooms, medkits=medkits, robots=robots, seed=seed)
        yield read_folder(place)
