"""Options of the commands that ask an integer program."""

from pathlib import Path
from typing import Annotated

import typer

from serendipity.cli.choices import choices

Solver = Annotated[str, typer.Option(help="highs, or cbc as a cross-check.", **choices("highs", "cbc"))]
Encoding = Annotated[
    str, typer.Option(help="Agent automata, or the paper's equations.", **choices("automata", "paper"))
]
Method = Annotated[
    str,
    typer.Option(
        help="What proves that nothing is better; program: the solver, even where reachability could; "
        "exhaustive: a search of all states; auto: both in turns.",
        **choices("auto", "program", "exhaustive"),
    ),
]
Proof = Annotated[
    Path | None,
    typer.Option("--proof", metavar="FILE", help="Write what convinced it, for `check-proof`; .gz packs it."),
]
