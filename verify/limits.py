"""The limits of the verifier: sizes from which on another method is tried, times, and methods left out.

They decide how soon something is proved, never whether it is true: whatever they are, no answer may be
another one, only ``undecided``.  Tests draw them at random, so that ways for large tasks are gone on small
ones, where brute force can see what is right::

    with limited(few_states=1, many_moves=0, methods=("-programs",)):
        serendipity.verify(task, result)

What a method of the table may take (``verify.calls.methods``) stands there; what its parts may, here.
"""

from collections.abc import Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from dataclasses import dataclass, replace
from typing import Any, Final

PARTS: Final = (
    "relevance-pruning",  # of programs: moves of the agents that are on no plan within the limits
    "few-facts",  # of relevance pruning: automata over few facts first
    "arc-pruning",  # of programs: the same by epoch
    "solver",  # of programs
)
"""Parts of methods that can be left out, too."""


@dataclass(frozen=True, slots=True)
class VerifierLimits:
    """The limits; a thread or a process of its own begins with these."""

    # names of methods and of their parts: the only ones used, or, with a minus sign, those that are not
    methods: tuple[str, ...] = ()
    coefficient: int = 10**7  # of a solver's program at most; see ``verify.solvers.mip``
    # sums of costs in machine words stay below it, as what stands for no way has to be more than any
    weight: int = 2**60
    automaton_states: int = 2_000  # facts are left out of an automaton rather than pass this size
    states_a_value: int = 24  # the same, for each value of the variable with the most values
    automaton_moves: int = 100_000  # of an automaton so large that once a fact does not fit no other is tried
    many_actions: int = 5_000  # actions from which on small automata go before the large ones
    many_moves: int = 4_000  # moves from which on it pays to bound them whatever the epoch
    alone_states: int = 50_000  # of the human alone, in a program
    own_states: int = 200_000  # of the human alone that are looked at
    many_own_states: int = 1_000  # the same, before they are packed
    projected_states: int = 20_000  # of what only the human changes
    compared_actions: int = 3_000  # that are compared with each other, all with all, by the exhaustive method
    misfits: int = 500  # ends of windows whose completion takes too many epochs, before others are left
    packed_facts: int = 2_500  # of a task whose states are packed
    packed_actions: int = 30_000  # the same
    few_states: int = 20_000  # packed states after which better bounds are worth their time
    packed_states: int = 50_000_000  # of any search
    exact_states: int = 500_000  # the same, where costs are too large for machine words
    states_at_once: int = 8_192  # packed states whose actions are looked for at once
    robot_states: int = 400_000  # of one robot beside the human's timetable, after an epoch
    left_behind: int = 1_000_000  # what robots may leave behind together
    left_pairs: int = 30_000_000  # the same, before what is equal is put together
    policies: int = 300_000  # groups of scenarios that are not told apart, and of what may be done in them
    moments: int = 200_000  # states and minds of people who replan
    several_plans: int = 3  # the human's optimal plans for which one search beside all of them pays
    solved_here: int = 15_000  # coefficients of a program with which HiGHS is late by some 20 ms at most
    solver_seconds: float = 0.25  # for which HiGHS may work in this process: as long as one takes to start
    quick_seconds: float = 0.5  # for bounds over packed states, as long as few states may be enough
    quick_share: float = 0.1  # of the time left, for the same
    careful_seconds: float = 5.0  # for bounds that are to spare many states
    careful_share: float = 0.25  # of the time left, for the same
    aside_seconds: float = 2.0  # for what a certificate says beside its claims
    rules_seconds: float = 1.0  # for what the human would do in a policy's states, in a check by rules
    end_share: float = 0.05  # of a time limit, kept for the end: dropping what was made takes time, too


_CURRENT: ContextVar[VerifierLimits] = ContextVar("limits", default=VerifierLimits())  # noqa: B039 - never changed


def limits() -> VerifierLimits:
    """The limits that hold now."""
    return _CURRENT.get()


def uses(name: str) -> bool:
    """Whether a method, or a part of one, is not left out."""
    chosen = limits().methods
    only = [each for each in chosen if not each.startswith("-")]
    return f"-{name}" not in chosen and (not only or name in only or name in PARTS)


@contextmanager
def limited(**given: Any) -> Iterator[None]:
    """Other limits for a while, by the names of :class:`VerifierLimits`."""
    before = _CURRENT.set(replace(limits(), **given))
    try:
        yield
    finally:
        _CURRENT.reset(before)
