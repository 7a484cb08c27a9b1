"""Bugs to plant in the planner, one at a time, and the calls in which they have to show.

The verifier shares nothing with ``search``; what it may share is the model, so bugs in the
model's rule for an epoch are planted for everybody, the verifier included.
"""

from tests.verify.planted import actions, answers, bounds, costs, spaces, walks
from tests.verify.planted.bug import Bug

PLANTED: tuple[Bug, ...] = actions.BUGS + costs.BUGS + spaces.BUGS + bounds.BUGS + walks.BUGS + answers.BUGS

__all__ = ["PLANTED", "Bug"]
