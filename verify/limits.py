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
    """The limits; a thread or a process of its own begins with these.

    Attributes:
        methods: names of methods and of their parts: the only ones that are used, or, with a minus sign in
            front, those that are not; see :func:`verify.calls.methods.chosen`.
        coefficient: of a solver's program at most; see ``verify.solvers.mip``.
        weight: sums of costs in machine words stay below it; those of operators together, so that sums stay
            below what stands for no way.
        automaton_states: facts are left out of an automaton rather than pass this size.
        states_a_value: the same, for each value of the variable with the most values.
        automaton_moves: of an automaton that is large enough: once a fact does not fit, no other is tried.
        many_actions: actions from which on small automata go before the large ones.
        many_moves: moves from which on it pays to bound them whatever the epoch.
        alone_states: of the human alone, in a program.
        own_states: of the human alone that are looked at.
        many_own_states: the same, before they are packed.
        projected_states: of what only the human changes.
        compared_actions: that are compared with each other, all with all, by the exhaustive method.
        misfits: ends of windows whose cheapest completion takes too many epochs, after which others are
            not looked at.
        packed_facts: of a task whose states are packed.
        packed_actions: the same.
        few_states: packed states after which better bounds are worth their time.
        packed_states: of any search.
        exact_states: the same, where costs are too large for machine words.
        states_at_once: packed states whose actions are looked for at once.
        robot_states: of one robot beside the human's timetable, after an epoch.
        left_behind: what robots may leave behind together.
        left_pairs: the same, before what is equal is put together.
        policies: groups of scenarios that are not told apart, and of what may be done in them.
        moments: states and minds of people who replan.
        several_plans: the human's optimal plans for which one search beside all of them pays.
        solved_here: coefficients of a program up to which HiGHS overruns its limit by some 20 ms at most.
        solver_seconds: for which HiGHS may work in this process, and about what it takes to start one.
        quick_seconds: for bounds over packed states, as long as few states may be enough.
        quick_share: of the time left, for the same.
        careful_seconds: for bounds that are to spare many states.
        careful_share: of the time left, for the same.
        aside_seconds: for what a certificate says beside its claims.
        rules_seconds: for what the human would do in a policy's states, where rules alone are checked.
        end_share: of a time limit, kept for the end: dropping what was made takes time, too.
    """

    methods: tuple[str, ...] = ()
    coefficient: int = 10**7
    weight: int = 2**60
    automaton_states: int = 2_000
    states_a_value: int = 24
    automaton_moves: int = 100_000
    many_actions: int = 5_000
    many_moves: int = 4_000
    alone_states: int = 50_000
    own_states: int = 200_000
    many_own_states: int = 1_000
    projected_states: int = 20_000
    compared_actions: int = 3_000
    misfits: int = 500
    packed_facts: int = 1_500
    packed_actions: int = 30_000
    few_states: int = 20_000
    packed_states: int = 50_000_000
    exact_states: int = 500_000
    states_at_once: int = 8_192
    robot_states: int = 400_000
    left_behind: int = 1_000_000
    left_pairs: int = 30_000_000
    policies: int = 300_000
    moments: int = 200_000
    several_plans: int = 3
    solved_here: int = 15_000
    solver_seconds: float = 0.25
    quick_seconds: float = 0.5
    quick_share: float = 0.1
    careful_seconds: float = 5.0
    careful_share: float = 0.25
    aside_seconds: float = 2.0
    rules_seconds: float = 1.0
    end_share: float = 0.05


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
