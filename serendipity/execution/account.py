"""What robots did in a run and why, in sentences: what happened, not what a plan would have been."""

from collections.abc import Iterator, Sequence
from itertools import groupby

from serendipity.execution.decided import Passed
from serendipity.model.numbers import plain


def account(passed: Sequence[Passed], human: str, alone: float | None) -> Iterator[str]:
    """What robots did in some epochs, and what it came to.

    Args:
        passed: the epochs, from the first one on.
        human: the person's name.
        alone: what they would have paid alone; None where they had no plan.
    """
    for _, same in groupby(passed, key=_what):
        epochs = list(same)
        first, last = epochs[0], epochs[-1]
        span = f"Epoch {first.epoch}" if first is last else f"Epochs {first.epoch} to {last.epoch}"
        steps = [step for epoch in epochs for step in epoch.steps if step.agents != (human,)]
        does = f" ({', '.join(step.action for step in steps)})" if steps else ""
        yield f"{span}: {first.decided.reason}{does}."
    if passed:
        end = passed[-1]
        instead = "" if alone is None else f" instead of {plain(alone)} alone"
        arrived = f"{human} paid {plain(end.human_cost)}{instead}, the team {plain(end.cost)}."
        yield arrived if end.done else f"{human} is not there yet."


def _what(passed: Passed) -> tuple[object, ...]:
    """What epochs of one sentence have in common."""
    why = passed.decided.because
    return passed.decided.verdict, None if why is None else (why.kind, why.cause)
