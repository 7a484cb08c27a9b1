"""Fast Downward, a planner for a single agent, as processes: translator and search.

It is never imported, for it is under the GPL.  Both come with the optional extra ``bench``: the
translator from ``fast-downward.translate``, the search's binary from the wheel ``up-fast-downward``.
"""

from serendipity.evaluation.benchmark.fast_downward.installed import absent
from serendipity.evaluation.benchmark.fast_downward.run import ANY_PLAN, IPDB, LMCUT, Found, run

__all__ = ["ANY_PLAN", "IPDB", "LMCUT", "Found", "absent", "run"]
