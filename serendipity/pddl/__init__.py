"""PDDL in, tasks out: the three layouts that name a task.

Text goes through :mod:`tokens` and plado's productions (:mod:`syntax`) to checked
lifted values (:mod:`resolve`, :mod:`lifted`), to conjunctive operators
(:mod:`normal`), to ground records (:mod:`join`, :mod:`instantiate`), and without
what can't happen (:mod:`prune`) to a task (:mod:`assemble`).
"""

from serendipity.pddl.layouts import load, load_agents, load_pddl

__all__ = ["load", "load_agents", "load_pddl"]
