"""Answers of silent assistance (semantics 7)."""

from collections.abc import Iterator
from importlib import import_module

from search.modes.assistance import assist
from serendipity.facade.call import Call
from serendipity.model.answers.answer import Answer


def load_arrays() -> None:
    """Load what only large tasks need, and takes longer than a short time limit."""
    import_module("search.modes.assistance.distances.layers")
    import_module("search.modes.assistance.distances.perimeter")


def answers(call: Call) -> Iterator[Answer]:
    """Answers of falling value; costs are the sums of both totals, which their bounds tell apart."""
    return assist(call.prepared, call.options, call.deadline)
