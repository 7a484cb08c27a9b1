"""PDDL in, tasks out: the three layouts that name a task.

Text goes through :mod:`tokens` and plado's productions (:mod:`syntax`) to checked
lifted values (:mod:`resolve`, :mod:`lifted`), to conjunctive operators
(:mod:`normal`), to ground records (:mod:`join`, :mod:`instantiate`), and without
what can't happen (:mod:`prune`) to a task (:mod:`assemble`).
"""

from serendipity.pddl.layouts import load, load_agents, load_pddl
from serendipity.pddl.resolve import read_domain
from serendipity.pddl.syntax import parse_domain

__all__ = ["forget_parsed", "load", "load_agents", "load_pddl"]


def forget_parsed() -> None:
    """Forget the domains that were read, for measurements; equal texts are read once else."""
    parse_domain.cache_clear()
    read_domain.cache_clear()
