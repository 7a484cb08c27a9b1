"""Exhaustive search without a horizon: A* over states of the whole team (semantics 3.4).

Without a horizon an epoch costs nothing, so that an action set can be taken apart and its actions executed
one after the other, those first that others of the set would disable.  Only sets in which actions disable
each other in a circle have to stay together.
"""

import numpy as np

from serendipity.model import Step
from serendipity.model.errors import LIMITS
from verify.base.execution import State
from verify.base.relevance import Relevant, relevant_part
from verify.base.subproblem import PricedPlan, Subproblem, least
from verify.base.undecided import during, why
from verify.exhaustive.team_problem import TeamProblem, team_problem
from verify.packed.cheapest_path import SumTooLargeError, TooManyPackedStatesError
from verify.packed.problem import TooLargeError
from verify.programs.agents.product import automata
from verify.programs.automata.network import distances, goal_states
from verify.programs.effort import Effort, Minimum


def cheapest(question: Subproblem, effort: Effort) -> Minimum:
    """The least cost of a plan with any number of epochs, within the question's limits.

    Args:
        question: its horizon is not looked at; its rule is ``free``.
        effort: its method says whether estimates of what is left may spare states.
    """
    bounded = effort.method != "exhaustive"
    with during("preparing the search for joint plans"):
        part = relevant_part(question)
    if part is None:
        return Minimum("none")
    for exact in (False, True):
        try:
            with during("preparing the search for joint plans"):
                team = team_problem(question, part, bounded=bounded, exact=exact)
            return _cheapest(question, team)
        except (TooLargeError, SumTooLargeError):
            continue  # sums may be: then once more with Python's integers
    return Minimum("undecided", reason="the task is too large for the exhaustive method")


def _cheapest(question: Subproblem, team: TeamProblem) -> Minimum:
    """The same over the states of a team.

    Raises:
        SumTooLargeError: machine words may not hold what it costs.
    """
    # operators weigh what they add to the objective: with communication that is no cost
    most = question.most if any(question.prices.talk) else least(question.most, question.most_cost)
    below = None if most is None else most + 1
    known: int | None = None
    try:
        known = int(team.problem.bounds(team.start)[0])
        search, found = team.problem.search(team.start, np.zeros(1, np.int64), below)
    except LIMITS as limit:
        return Minimum("undecided", bound=known, reason=why(limit, "searching joint plans"))
    except SumTooLargeError:
        raise
    except TooManyPackedStatesError as error:
        reason = str(error) or "there are too many joint states"
        return Minimum("undecided", bound=known, reason=reason)
    if found is None:
        return Minimum("none", states=search.states)
    _, path = search.path(found)
    sets = enumerate((team.sets[k] for k in path), start=1)
    steps = tuple(Step(epoch, i) for epoch, chosen in sets for i in chosen)
    cost = search.paid(found)
    return Minimum("found", PricedPlan(steps, None, cost, cost), cost, states=search.states)


class LeastLeft:
    """A lower bound on what is left to pay, in units: distances in the human's automaton.

    Robots' costs are only left out, so it holds whatever they do.
    """

    def __init__(self, question: Subproblem, part: Relevant) -> None:
        deadline = question.deadline
        groups = [frozenset(variable.facts) for variable in question.task.variables]
        machine = automata(question.task, part, groups, deadline)[question.task.human]
        weights = list(question.prices.team)
        left = distances(machine, weights, goal_states(question, machine), deadline)[0]
        self.facts = machine.facts
        self.by_state = dict(zip(machine.states, left, strict=True))

    def __call__(self, state: State) -> int | None:
        """The bound in a state; None: there is no way to the goals."""
        return self.by_state.get(state & self.facts, 0)
