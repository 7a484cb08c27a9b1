"""Who the human may be in a problem of a suite: somebody who might do it alone."""

import serendipity
from serendipity.evaluation.benchmark.coverage import Problem, Roles


def may_alone(problem: Problem, who: Roles) -> bool:
    """Whether the human alone may reach the goal, if nothing is ever deleted."""
    task = serendipity.load_pddl(problem.domain_file, problem.problem_file, who.human, who.robots)
    known = set(task.init)
    waiting = [task.actions[i] for i in task.human_actions]
    while ready := [action for action in waiting if known.issuperset(action.pre)]:
        waiting = [action for action in waiting if not known.issuperset(action.pre)]
        known.update(*(action.add for action in ready))
    return known.issuperset(task.goal.positive)
