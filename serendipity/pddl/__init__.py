"""PDDL in, tasks out: the three layouts that name a task.

Text goes through nested words (:mod:`tree`) and sections (:mod:`sections`, :mod:`syntax`) to
checked lifted values (:mod:`resolve`, :mod:`scope`, :mod:`initial`, :mod:`lifted`), to lifted
actions in normal form (:mod:`normal`), to ground records (:mod:`join`, :mod:`instantiate`), and without what
can't happen (:mod:`prune`) to a task (:mod:`assemble`), all of it under a deadline (:mod:`work`).
"""

from serendipity.pddl.layouts import ALL, read_agents, read_folder, read_pddl
from serendipity.pddl.parsing.resolve import forget_parsed

__all__ = ["ALL", "forget_parsed", "read_agents", "read_folder", "read_pddl"]
