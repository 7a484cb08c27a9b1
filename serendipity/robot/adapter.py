"""What stands between the loop, which knows epochs and actions, and robots, which need time and fail."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final, Literal, NamedTuple, Protocol, get_args

from serendipity.model.answers.fields import Written

Outcome = Literal["done", "failed", "running"]
"""What became of an action by the end of an epoch: it took place, it never will, or it takes longer."""

OUTCOMES: Final[tuple[Outcome, ...]] = get_args(Outcome)


class Order(NamedTuple):
    """Something that robots are to do.

    Attributes:
        agents: everybody who takes part, the person included where they do.
        action: its name.
        epochs: that are planned for it.
    """

    agents: tuple[str, ...]
    action: str
    epochs: int = 1


class Epoch(NamedTuple):
    """What an epoch asks of robots.

    Attributes:
        number: from 1.
        state: ids of the facts that are true when it begins.
        human: what the person does by themselves meanwhile, by name; None: nothing.
        orders: what robots are to do, all at the same time.
    """

    number: int
    state: frozenset[int]
    human: str | None
    orders: tuple[Order, ...]


@dataclass(frozen=True, slots=True)
class Report(Written):
    """What came of an order.

    Attributes:
        outcome: by the end of the epoch.
        seconds: that were spent on it so far, in the robots' own time.
        note: what the robot has to say about it, in words.
    """

    outcome: Outcome
    seconds: float = 0.0
    note: str = ""


class Adapter(Protocol):
    """Carries out what is decided, by robots that are real or not."""

    def execute(self, epoch: Epoch) -> Sequence[Report]:
        """Carry out the orders of an epoch until it is over; a report for each, in their order.

        An order that was ``running`` and comes again goes on; one that does not come again is given up.
        It is asked in every epoch, without orders, too.
        """

    def close(self) -> None:
        """Give back whatever it holds; there are no more epochs."""
