"""Is the plan that comes with a policy a run of the game, and does it cost what is said?"""

from fractions import Fraction

from serendipity.model import PlanStep, Result, Task
from serendipity.model.numbers import agrees
from verify.policy.board import Board
from verify.policy.closed import BrokenError


def check_run(task: Task, board: Board, result: Result) -> None:
    """Return if the plan is a run in which the human acts optimally, at the totals reported.

    Args:
        board: its states and moves.
        result: an answer of mode ``assistance`` with a plan.

    Raises:
        BrokenError: naming the epoch at fault.
        UndecidedError: their own optimum could not be worked out.
    """
    assert result.plan is not None
    human = result.human
    for step in result.plan:
        _check_step(task, step)
    done = {(step.epoch, step.agents == (human,)): step.action for step in result.plan}
    if len(done) < len(result.plan):
        raise BrokenError("replay", "plan: an agent acts twice in one epoch")
    state, totals = board.start, [Fraction(0), Fraction(0)]
    for epoch in range(1, max((step.epoch for step in result.plan), default=0) + 1):
        cost, state = _supporter(board, state, done.get((epoch, False), "noop"), epoch)
        totals[1] += cost
        if not board.goal.holds(state):
            cost, state = _human(board, state, done.get((epoch, True)), epoch)
            totals[0] += cost
        elif (epoch, True) in done:
            raise BrokenError("replay", f"plan, epoch {epoch}: the goal holds before '{done[epoch, True]}'")
    if not board.goal.holds(state):
        raise BrokenError("replay", "plan: the goal does not hold after the last epoch")
    if not all(map(agrees, result.agent_costs.values(), totals)):
        raise BrokenError("cost", f"plan: costs {totals[0]} and {totals[1]}, not what agent_costs says")


def _supporter(board: Board, state: int, name: str, epoch: int) -> tuple[Fraction, int]:
    found = next(((cost, after) for cost, after, action in board.moves(state) if action == name), None)
    if found is None:
        raise BrokenError("replay", f"plan, epoch {epoch}: the supporter can't do '{name}'")
    return found


def _human(board: Board, state: int, name: str | None, epoch: int) -> tuple[Fraction, int]:
    for reply in board.replies(state):
        if reply.name == name:
            return reply.cost, reply.state
    what = "wait" if name is None else f"do '{name}'"
    raise BrokenError("replay", f"plan, epoch {epoch}: the human would not {what}")


def _check_step(task: Task, step: PlanStep) -> None:
    """Return if a step has an agent and a cost that an action of its name has."""
    actions = [task.actions[i] for i in task.named.get(step.action, ())]
    agents = [tuple(task.agents[i] for i in action.participants) for action in actions]
    if step.agents not in agents:
        raise BrokenError("replay", f"plan, epoch {step.epoch}: there is no '{step.action}' of these agents")
    if not any(agrees(step.cost, action.cost) for action in actions):
        raise BrokenError("cost", f"plan, epoch {step.epoch}: '{step.action}' does not cost {step.cost:g}")
