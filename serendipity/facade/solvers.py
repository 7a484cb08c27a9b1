"""The solver that answers a call, by its mode."""

from collections.abc import Callable
from importlib import import_module
from typing import Final

from serendipity.facade import one_plan, ties
from serendipity.facade.call import Solver
from serendipity.model.options import Options


def _assistance(options: Options) -> Solver:
    """Answers of falling value (semantics 7); costs are the sums of both totals."""
    # Loaded only here, before time counts: the other modes do not need it.
    from search.modes.assistance import assist

    if options.time_limit is not None:  # what only large tasks need takes longer to load than a short limit
        import_module("search.modes.assistance.distances.layers")
        import_module("search.modes.assistance.distances.perimeter")
    return lambda call: assist(call.prepared, call.options, call.deadline)


SOLVERS: Final[dict[str, Callable[[Options], Solver]]] = {
    "serendipity": lambda _: ties.answers,
    "individual": lambda _: one_plan.answers,
    "communication": lambda _: ties.answers,
    "composite": lambda _: one_plan.answers,
    "assistance": _assistance,
}
"""By mode; each loads what its solver needs."""
