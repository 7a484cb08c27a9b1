"""The tasks that are shipped with the program."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Final

from serendipity.model import Deadline, Script, Task
from serendipity.model.arguments import DEADLINE, expect_or_none
from serendipity.model.keywords import require_one_of
from serendipity.model.numbers import Number
from serendipity.pddl import read_pddl

DATA: Final = Path(__file__).parent / "data"


@dataclass(frozen=True, slots=True)
class Example:
    """A shipped task.

    Attributes:
        name: what ``--example`` takes.
        domain: the PDDL domain, relative to the data folder.
        bystanders: of these the ones whose plans are fixed, with their actions one after another.
    """

    name: str
    summary: str
    domain: str
    problem: str
    human: str
    robots: tuple[str, ...]
    bystanders: Mapping[str, tuple[str, ...]] = field(default_factory=dict)

    def load(self, deadline: Deadline | None = None, epoch: Number | None = None) -> Task:
        """The task, with epochs of that length.

        Raises:
            LimitReachedError: the deadline came first.
        """
        domain, problem = DATA / self.domain, DATA / self.problem
        task = read_pddl(
            domain, problem, human=self.human, robots=self.robots, epoch=epoch, deadline=deadline
        )
        return task.with_script(Script(people=self.bystanders)) if self.bystanders else task


def _usar(name: str, summary: str) -> Example:
    return Example(name, summary, "usar/domain.pddl", f"usar/{name}.pddl", "commx", ("robot",))


def _domain(name: str, summary: str, human: str, *robots: str, **bystanders: tuple[str, ...]) -> Example:
    files = f"{name}/domain.pddl", f"{name}/{name}.pddl"
    return Example(name, summary, *files, human, (*robots, *bystanders), bystanders)


EXAMPLES: Final = {
    shipped.name: shipped
    for shipped in (
        _usar("room2", "the paper's III-C: a medkit handed over in passing pays from a discount above 0.5"),
        _usar("room5", "the paper's III-B: the human passes the medkit's room before meeting the robot"),
        _usar("room7", "the paper's III-D: no help without a word, 12.6 for 13 with one at discount 0.6"),
        _domain("parcels", "a parcel lies where the van comes past, and a detour is spared", "dora", "rolo"),
        _domain("flights", "a passenger has come half of the way, and no fuel is needed", "ada", "kite"),
        _domain("taxis", "one taxi makes way for another, which takes the next guest", "tom", "uno", "due"),
        _domain(
            "morning", "breakfast is made while its eater sleeps and washes, minute by minute", "ann", "robi"
        ),
        _domain(
            "office",
            "a meeting has the projector, a colleague the lift, and a talk is prepared upstairs",
            "eve",
            "rolf",
            carl=("walk carl post lobby", "ride carl lobby landing"),
        ),
    )
}
"""By name, in the order in which they are listed."""


def example(name: str, *, epoch: Number | None = None, deadline: Deadline | None = None) -> Task:
    """A task shipped with the program; ``serendipity examples`` lists them.

    Args:
        name: its name.
        epoch: how long an epoch is, in the unit of PDDL's durations; None to find out.
        deadline: polled; it may be one that planning shares.

    Raises:
        UsageError: there is no example of that name.
        LimitReachedError: the deadline came first.
    """
    expect_or_none(DEADLINE, deadline=deadline)
    require_one_of("example", name, EXAMPLES)
    return EXAMPLES[name].load(deadline, epoch)
