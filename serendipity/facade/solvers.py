"""Which solver answers a call, by its mode."""

from collections.abc import Callable
from typing import Final

from serendipity.facade import one_plan, ties
from serendipity.facade.call import Solver
from serendipity.model.options import Options


def _assistance(options: Options) -> Solver:
    # Loaded only here, before time counts: the other modes do not need it.
    from serendipity.facade import assistance

    if options.time_limit is not None:
        assistance.load_arrays()
    return assistance.answers


SOLVERS: Final[dict[str, Callable[[Options], Solver]]] = {
    "serendipity": lambda _: ties.answers,
    "individual": lambda _: one_plan.answers,
    "communication": lambda _: ties.answers,
    "composite": lambda _: one_plan.answers,
    "assistance": _assistance,
}
"""By mode; each loads what its solver needs."""
