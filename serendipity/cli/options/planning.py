"""The options of ``plan`` that change what an answer means, or how it is looked for.

Their legal values and defaults are those of ``serendipity.model.Options``, which also
validates them: here they are text, so that ``0.1`` stays exactly a tenth.
"""

from collections.abc import Mapping
from inspect import Parameter
from pathlib import Path
from typing import Annotated, Any, Final

from serendipity.cli.choices import option
from serendipity.cli.groups import OptionGroup
from serendipity.model import Options, Task, UsageError
from serendipity.model.keywords import CHOICES, InterruptionOptions
from serendipity.model.task.plans import PlanEntry

_TEXTS: Final[Mapping[str, tuple[str, str]]] = {
    "mode": ("What kind of plan.", ""),
    "discount": ("Taken off the cost of robots' actions, 0 to 1.", "D"),
    "horizon": ("Epochs; by default as many as the human's plan has.", "N|inf"),
    "window_weight": ("K: cost of each epoch that the window lasts.", "K"),
    "max_window": ("Longest window, in epochs.", "N"),
    "suffix": ("What the human does after the window.", ""),
    "preservation": ("What has to be left of the state of the human's plan (Def. 3.1).", ""),
    "interference": ("Which actions may share an epoch.", ""),
    "max_cost": ("Reject plans that cost more; 'human': than the human's own.", "X|human"),
    "communication_weight": ("Cost per unit of announced actions of the human.", "W"),
    "human_model": ("How the human reacts.", ""),
    "ties": ("Which of the human's optimal plans counts.", ""),
    "max_ties": ("The most of those plans that are tried.", "N"),
    "waiting_cost": ("Cost of each epoch in which the human waits before their last action.", "W"),
    "head_start": ("Epochs of waiting before the human's plan (semantics 10.2).", "N"),
    "policy": ("Over several goals or plans: whether robots watch, or commit themselves.", ""),
    "risk": ("What is minimised over several goals or plans.", ""),
    "leave_free": ("Only facts that fit may be left changed, as in 'at robot *, dirty *'.", "PATTERNS"),
    "leave_price": ("What each other fact costs that is left changed.", "PATTERN=PRICE,..."),
    "disturbance": ("Weights of what disturbs the human (semantics 13).", "ask=W,meet=W,sight=W"),
    "max_disturbance": ("The most that help may disturb the human.", "D"),
    "strategies": (
        "Search with these strategies only, or with all but some; -v tells what came of each.",
        "NAME,-NAME",
    ),
}
"""Help, and what stands for a value; without that, values are those of ``CHOICES``."""


def told(name: str) -> Any:
    """An option of :class:`Options` that is told as a text, as typer has it."""
    text, metavar = _TEXTS[name]
    default = getattr(Options(), name)
    return option(
        f"--{name.replace('_', '-')} {metavar or '|'.join(CHOICES[name])}",
        text if default is None else f"{text} [default: {default}]",
        show_default=False,
    )


_OTHERS: Final[Mapping[str, Any]] = {
    "human_plan": Annotated[
        Path | None,
        option("--human-plan FILE", "What the human will do, an action a line; predicted by default."),
    ],
    "keep_prefix": Annotated[
        bool | None, option("--keep-prefix", "In communication mode: windows, as in the paper's second (7b).")
    ],
    "nobody_pays": Annotated[
        bool | None,
        option(
            "--nobody-pays/--somebody-pays",
            "Whether help may cost no person anything. [default: where there are bystanders]",
        ),
    ],
    "noticed": Annotated[
        bool | None,
        option("--noticed", "The human leaves their plan only for what they have seen (semantics 14)."),
    ],
    "no_block": Annotated[
        bool | None, option("--no-block/--allow-block", "Whether robots may leave the human without a plan.")
    ],
}

_ALL: Final = (
    *("mode", "discount", "horizon", "human_plan", "window_weight", "max_window", "suffix", "preservation"),
    *("interference", "max_cost", "communication_weight", "keep_prefix", "human_model", "ties", "max_ties"),
    *("no_block", "waiting_cost", "head_start", "policy", "risk", "nobody_pays", "leave_free", "leave_price"),
    *("disturbance", "max_disturbance", "noticed", "strategies"),
)
"""In the order of help."""

WINDOWS: Final = tuple(name for name in _ALL if name in (*InterruptionOptions.__annotations__, "human_plan"))
"""What makes a difference to windows."""
EXPLAINED: Final = (
    *_ALL[: _ALL.index("keep_prefix")],
    *("human_model", "no_block", "waiting_cost", "head_start"),
)
"""What can be explained."""
FRONT: Final = tuple(name for name in _ALL if name not in ("max_disturbance", "ties", "max_ties"))
"""What a front of saving against disturbance is asked with."""
_UNKNOWN: Final = (
    *("human_model", "no_block", "policy", "risk", "leave_free", "leave_price"),
    *("disturbance", "max_disturbance", "noticed", "strategies"),
)
PROGRAMS: Final = tuple(name for name in _ALL if name not in _UNKNOWN)
"""What integer programs know."""


GOALS: Final = option(
    "--goals FILE", "Goals that the human may have: JSON, or 'prior: fact, fact' on each line."
)
Goals = Annotated[Path | None, GOALS]
Plans = Annotated[
    Path | None, option("--plans FILE", "Plans that the human may follow, with probabilities: JSON.")
]
Observed = Annotated[
    Path | None, option("--observed FILE", "What the human has done so far, an action a line.")
]
Beta = Annotated[
    str | None, option("--beta B", "How strictly the human saves cost; 0 and more. [default: 1]")
]
Noise = Annotated[
    str | None,
    option("--noise miss=P,wrong=Q", "How often what is done is missed, and what is seen is wrong."),
]
"""Where the human's goal is not known (semantics 8)."""

Solver = Annotated[str, option("--solver highs|cbc", "highs, or cbc as a cross-check.")]
Encoding = Annotated[str, option("--encoding automata|paper", "Agent automata, or the paper's equations.")]
Method = Annotated[
    str,
    option(
        "--method auto|program|exhaustive",
        "What proves that nothing is better; program: the solver, even where reachability could; "
        "exhaustive: a search of all states; auto: both in turns.",
    ),
]
Proof = Annotated[
    Path | None,
    option("--proof FILE", "Write what convinced it, for `check-proof`; .gz packs it; .pbp is for VeriPB."),
]
"""Of an integer program, and of what proves."""


class Planning(OptionGroup):
    """Options of a planning call; ``given`` has the others that the user gave, by name."""

    def __init__(self, human_plan: Path | None = None, **options: str | bool | None) -> None:
        self.human_plan = human_plan
        self.given = given(**options)

    @classmethod
    def parameters(cls, *more: tuple[str, ...]) -> list[Parameter]:
        """What typer is shown: all options, or those that are named."""
        kind = Parameter.KEYWORD_ONLY
        return [
            Parameter(name, kind, default=None, annotation=_shown(name))
            for names in more or [_ALL]
            for name in names
        ]

    def plan_of(self, task: Task) -> tuple[PlanEntry, ...] | None:
        """The plan in the file that was named, which is the human's in the task; None without one."""
        if self.human_plan is None:
            return None
        from serendipity.cli.files.plans import timed_plan

        asked = Options(head_start=self.given.get("head_start", 0))
        return timed_plan(self.human_plan, task, asked.head_start)


def _shown(name: str) -> Any:
    return _OTHERS[name] if name in _OTHERS else Annotated[str | None, told(name)]


def require_nothing_observed(**given: object) -> None:
    """A UsageError where the human's goal is known, and options say how to tell it."""
    for name, value in given.items():
        if value is not None:
            raise UsageError(f"--{name}: goes with --goals only")


def given(**options: object) -> dict[str, Any]:
    """The options that the user gave; what is left out keeps its default."""
    return {name: value for name, value in options.items() if value is not None}
