"""Options of the commands that ask an integer program."""

from typing import Annotated

import typer

Solver = Annotated[str, typer.Option(help="highs, or cbc as a cross-check.", metavar="highs|cbc")]
Encoding = Annotated[
    str, typer.Option(help="Agent automata, or the paper's equations.", metavar="automata|paper")
]
