"""Options where the human's goal is not known (semantics 8)."""

from pathlib import Path
from typing import Annotated

import typer

Goals = Annotated[
    Path | None,
    typer.Option(
        "--goals",
        metavar="FILE",
        help="Goals that the human may have: JSON, or 'prior: fact, fact' on each line.",
    ),
]
Observed = Annotated[
    Path | None,
    typer.Option("--observed", metavar="FILE", help="What the human has done so far, an action a line."),
]
Beta = Annotated[
    str | None,
    typer.Option("--beta", metavar="B", help="How strictly the human saves cost; 0 and more. [default: 1]"),
]
