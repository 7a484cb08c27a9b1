"""What a person did, written down."""

from collections.abc import Iterator
from os import PathLike

from serendipity.model import InputError, Task
from serendipity.model.task.task import canonical_name
from serendipity.pddl.parsing.files import read_text
from serendipity.pddl.parsing.timed_plans import entries, plan_lines
from serendipity.recognition.recognise import ObservedGiven, named_actions


def recorded_actions(task: Task, given: ObservedGiven) -> tuple[str, ...]:
    """The actions that were written down, one after another; ``noop`` is an epoch of waiting.

    Where a file says when they begin, as human plans do, the person waits until then.

    Raises:
        InputError: a line is no action that the human takes part in, or one begins while another goes on.
    """
    human, found, over = task.agents[task.human], list[str](), 0
    for epoch, name, line in _recorded(task, given):
        ids = task.named.get(name, ())
        where = given if isinstance(given, str | PathLike) else None
        if not task.waits(name) and all(task.human not in task.actions[i].participants for i in ids):
            raise InputError(f"recorded action '{name}': expected an action of {human}'s", where, line)
        if epoch is not None and epoch <= over:
            raise InputError(f"recorded action '{name}': {human} is busy until epoch {over}", where, line)
        waited = 0 if epoch is None else epoch - 1 - over
        found += ["noop"] * waited + [name]
        over += waited + max((task.actions[i].duration for i in ids), default=1)
    return tuple(found)


def _recorded(task: Task, given: ObservedGiven) -> Iterator[tuple[int | None, str, int | None]]:
    """What was written down: the epoch, if it is said, the action, and its line."""
    if not isinstance(given, str | PathLike):
        yield from ((None, name, line) for name, line in named_actions(given, "human"))
        return
    lines = plan_lines(read_text(given), given, "recorded: ")
    for line, entry in zip(lines, entries(lines, task, given, "recorded: "), strict=True):
        epoch, name = (None, entry) if isinstance(entry, str) else entry
        yield epoch, canonical_name(name), line.line
