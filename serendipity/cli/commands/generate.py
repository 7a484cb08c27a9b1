"""``serendipity generate``: seeded tasks of any size."""

from pathlib import Path
from typing import Annotated, Any

import typer

from serendipity.cli.choices import option
from serendipity.cli.help_examples import epilog
from serendipity.cli.streams.output import say
from serendipity.model.printable import printable

app = typer.Typer(
    name="generate",
    help="Write seeded tasks of any size as PDDL.",
    rich_markup_mode=None,
    add_completion=False,
)


@app.callback()
def _group() -> None:
    """Keeps ``usar`` a command of its own while it is the only one."""


@app.command(epilog=epilog("generate"))
def usar(
    output: Annotated[Path, option("-o, --output DIR", "Folder to write to.")],
    rooms: Annotated[int, option("--rooms N", "Locations, halls included.")] = 21,
    medkits: Annotated[int, option("--medkits M", "Medkits.")] = 2,
    robots: Annotated[int, option("--robots K", "Robots.")] = 1,
    seed: Annotated[int, option("--seed S", "Equal seeds give equal files.")] = 0,
    extra_edges: Annotated[
        int, option("--extra-edges E", "Connections beyond a tree; each closes a cycle.")
    ] = 0,
    corridors: Annotated[
        int | None,
        option("--corridors C", "Corridors that the halls form: fewer are longer; by chance by default."),
    ] = None,
    preset: Annotated[
        str | None,
        option("--preset figure2|room2|room5|room7", "The paper's building; or one of its examples."),
    ] = None,
    layout: Annotated[
        str,
        option("--layout agents|pair", "A folder per agent and superagent/, or one domain and one problem."),
    ] = "agents",
) -> None:
    """Write a search-and-rescue building: a human, robots, medkits and a place for triage."""
    from serendipity.scenarios.generate import generate_usar

    named: dict[str, Any] = {"preset": preset, "layout": layout}
    written = generate_usar(
        output,
        rooms=rooms,
        medkits=medkits,
        robots=robots,
        seed=seed,
        extra_edges=extra_edges,
        corridors=corridors,
        **named,
    )
    say("".join(f"{printable(str(path))}\n" for path in written))
