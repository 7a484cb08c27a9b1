"""``serendipity bench``: planning calls and integer programs on the same tasks, side by side."""

import csv
import io
import tempfile
from collections.abc import Iterator
from dataclasses import astuple, fields
from pathlib import Path
from typing import Annotated

import typer

from serendipity.cli import output
from serendipity.cli.exit_codes import ExitCode
from serendipity.cli.render import Grid, Line, rendered
from serendipity.model import InputError, Task

HEADER = ("mode", "contender", "ratio", "calls", "solved", "median", "95 %", "max")


def bench(
    folder: Annotated[
        Path | None,
        typer.Argument(help="Tasks in folders, as for `reproduce`; generated buildings without one."),
    ] = None,
    stride: Annotated[int, typer.Option(min=1, help="Take every N-th task of the folder.")] = 1,
    rooms: Annotated[int, typer.Option(min=2, help="Rooms of generated buildings.")] = 21,
    medkits: Annotated[int, typer.Option(min=1, help="Their medkits.")] = 2,
    robots: Annotated[int, typer.Option(min=1, help="Their robots.")] = 1,
    seeds: Annotated[int, typer.Option(min=1, help="How many to generate.")] = 10,
    modes: Annotated[str, typer.Option(help="Modes, separated by commas.")] = "serendipity,communication",
    discounts: Annotated[str, typer.Option(help="Discounts, separated by commas.")] = "0,0.5,0.9",
    contenders: Annotated[
        str, typer.Option(help="Some of search, automata, paper, separated by commas.")
    ] = "search,automata",
    repeat: Annotated[int, typer.Option(min=1, help="Calls of the search per figure.")] = 5,
    time_limit: Annotated[float, typer.Option(min=0, help="Seconds for each call.")] = 60.0,
    output_file: output.Output = None,
) -> int:
    """Measure the search beside our integer program and the paper's; -o writes every timing as CSV."""
    from serendipity import benchmark

    output.check_output(output_file)
    with tempfile.TemporaryDirectory() as scratch:
        if folder is None:
            tasks = list(_generated(Path(scratch), rooms, medkits, robots, seeds))
        else:
            tasks = list(_loaded(folder, stride))
    timings = list(
        benchmark.measure(
            tasks,
            modes.split(","),
            discounts.split(","),
            contenders.split(","),
            repeat=repeat,
            time_limit=time_limit,
        )
    )
    print_parts = [Line(f"{len(tasks)} tasks; {benchmark.machine()}"), Line()]
    typer.echo(rendered([*print_parts, Grid(HEADER, benchmark.summary(timings))]))
    if output_file is not None:
        text = io.StringIO()
        writer = csv.writer(text, lineterminator="\n")
        writer.writerow([field.name for field in fields(benchmark.Timing)])
        writer.writerows(astuple(timing) for timing in timings)
        output.write_answer(text.getvalue(), output_file)
    return ExitCode.ANSWERED


def _loaded(folder: Path, stride: int) -> Iterator[Task]:
    from serendipity import load

    if not folder.is_dir():
        raise InputError("expected a folder of tasks", folder)
    found = sorted(path for path in folder.iterdir() if path.is_dir())
    if not found:
        raise InputError("expected a folder for each task in it", folder)
    for path in found[::stride]:
        yield load(path)


def _generated(scratch: Path, rooms: int, medkits: int, robots: int, seeds: int) -> Iterator[Task]:
    from serendipity import generate_usar, load

    for seed in range(seeds):
        place = scratch / f"seed{seed}"
        generate_usar(place, rooms=rooms, medkits=medkits, robots=robots, seed=seed)
        yield load(place)
