"""The options of ``plan`` that change what an answer means.

Their legal values and defaults are those of ``serendipity.model.Options``, which also
validates them: here they are text, so that ``0.1`` stays exactly a tenth.
"""

from collections.abc import Mapping
from dataclasses import fields
from pathlib import Path
from typing import Annotated, Any, Final

import typer

from serendipity.cli.choices import choices
from serendipity.model.keywords import CHOICES
from serendipity.model.options import Options

_DEFAULTS: Final = {field.name: getattr(Options(), field.name) for field in fields(Options)}
_LIMITS: Final = ("time_limit", "memory_limit")


def _option(name: str, help: str, metavar: str | None = None) -> Any:  # noqa: A002 - typer's word
    default = _DEFAULTS[name]
    shown = "" if default is None else f" [default: {default}]"
    return typer.Option(
        f"--{name.replace('_', '-')}",
        **choices(*(metavar.split("|") if metavar else CHOICES[name])),
        help=help + shown,
        show_default=False,
    )


Mode = Annotated[str | None, _option("mode", "What kind of plan.")]
Discount = Annotated[str | None, _option("discount", "Taken off the cost of robots' actions, 0 to 1.", "D")]
Horizon = Annotated[
    str | None, _option("horizon", "Epochs; by default as many as the human's plan has.", "N|inf")
]
HumanPlan = Annotated[
    Path | None,
    typer.Option(metavar="FILE", help="What the human will do, an action a line; predicted by default."),
]
WindowWeight = Annotated[
    str | None, _option("window_weight", "K: cost of each epoch that the window lasts.", "K")
]
MaxWindow = Annotated[str | None, _option("max_window", "Longest window, in epochs.", "N")]
Suffix = Annotated[str | None, _option("suffix", "What the human does after the window.")]
Preservation = Annotated[
    str | None, _option("preservation", "What has to be left of the state of the human's plan (Def. 3.1).")
]
Interference = Annotated[str | None, _option("interference", "Which actions may share an epoch.")]
MaxCost = Annotated[
    str | None, _option("max_cost", "Reject plans that cost more; 'human': than the human's own.", "X|human")
]
CommunicationWeight = Annotated[
    str | None,
    _option("communication_weight", "Cost per unit of announced actions of the human.", "W"),
]
KeepPrefix = Annotated[
    bool | None,
    typer.Option("--keep-prefix", help="In communication mode: windows, as in the paper's second (7b)."),
]
HumanModel = Annotated[str | None, _option("human_model", "How the human reacts.")]
Ties = Annotated[str | None, _option("ties", "Which of the human's optimal plans counts.")]
MaxTies = Annotated[str | None, _option("max_ties", "The most of those plans that are tried.", "N")]
NoBlock = Annotated[
    bool | None,
    typer.Option("--no-block/--allow-block", help="Whether robots may leave the human without a plan."),
]


def given(**options: str | bool | Path | None) -> dict[str, Any]:
    """The options that the user gave; what is left out keeps its default."""
    return {name: value for name, value in options.items() if value is not None}


def among(arguments: Mapping[str, Any], *, limits: bool = False) -> dict[str, Any]:
    """Those arguments of a command that are options of a planning call, and that the user gave.

    Args:
        arguments: of the command, by name: its ``locals()``.
        limits: with the time and memory limit, where the answer is to name them.
    """
    names = (name for name in _DEFAULTS if limits or name not in _LIMITS)
    return given(**{name: arguments[name] for name in names if name in arguments})
