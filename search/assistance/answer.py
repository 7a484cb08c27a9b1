"""From a task and options to the answer of mode ``assistance`` (SPEC 7)."""

from collections.abc import Iterator
from dataclasses import dataclass

from search.assistance.bound import Bound
from search.assistance.branching import Branching
from search.assistance.game import INFINITE, Game
from search.assistance.rules import Mean, Worst
from search.assistance.shortest import Shortest
from search.assistance.solution import ZERO, Costs
from search.assistance.writing import Writer
from search.clock import Clock, OutOfTimeError
from serendipity.model.options import Options
from serendipity.model.plans import Step
from serendipity.model.policy import Policy
from serendipity.model.task import HumanPlan, Task


@dataclass(frozen=True, slots=True)
class Assistance:
    """An answer, proved or on the way to it.

    Attributes:
        status: as in :class:`serendipity.model.Result`.
        lower: no policy is worth less.
        upper: what the policy is worth, or at most worth; None without one.
        human_plan: his canonical optimal plan alone; None if there is none, or it is unknown.
        policy: what the supporter does; None without one.
        plan: both agents' actions, S before P in each epoch; None where P may choose.
        reason: why there is no policy.
        expanded: states expanded.
    """

    status: str
    lower: Costs
    upper: Costs | None = None
    human_plan: HumanPlan | None = None
    policy: Policy | None = None
    plan: tuple[Step, ...] | None = None
    reason: str | None = None
    expanded: int = 0


def assist(task: Task, options: Options, clock: Clock) -> Iterator[Assistance]:
    """Answers of falling value; the last one is the best known.

    Args:
        task: one human and one robot.
        options: ``ties`` and ``no_block`` count.
        clock: deadline and cancellation.

    Raises:
        UsageError: there is not exactly one robot.
    """
    game = Game(task, clock)
    search: Shortest | Branching | None = None
    writer = Writer(game, options.ties)
    try:
        search = _search(game, options)
        for _ in search.run():
            yield _answer(writer, search, "feasible")
        solved = search.solution(floors=False).upper is not None
        yield _answer(writer, search, "optimal" if solved else "infeasible")
    except OutOfTimeError:
        if search is None:
            yield Assistance("unknown", ZERO, reason="time-limit")
            return
        found = search.solution(floors=False).upper is not None
        yield _answer(writer, search, "feasible" if found else "unknown")


def _search(game: Game, options: Options) -> Shortest | Branching:
    bound = Bound(game)
    no_block = bool(options.no_block)
    if options.ties in ("fixed", "optimistic"):
        return Shortest(game, bound, fixed=options.ties == "fixed", no_block=no_block)
    return Branching(game, bound, Worst() if options.ties == "robust" else Mean(), no_block=no_block)


def _answer(writer: Writer, search: Shortest | Branching, status: str) -> Assistance:
    solution = search.solution(floors=status == "optimal")
    has_policy = status in ("optimal", "feasible")
    return Assistance(
        status,
        lower=solution.lower or ZERO,
        upper=solution.upper,
        human_plan=writer.human_plan(),
        policy=writer.policy(solution, with_floors=status == "optimal") if has_policy else None,
        plan=writer.plan(solution) if has_policy else None,
        reason={"infeasible": "no-plan", "unknown": "time-limit"}.get(status),
        expanded=search.expanded,
    )


def joint_optimum(task: Task, clock: Clock | None = None) -> Costs | None:
    """The bound on every policy from ``I``: both together, without turns, or a relaxation of it.

    None where not even both together reach the goal.
    """
    game = Game(task, clock or Clock())
    value = Bound(game)(game.init)
    return None if value >= INFINITE else game.pair(value)
