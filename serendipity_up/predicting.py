"""What the human is going to do, as an engine of unified-planning predicts it."""

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass

from unified_planning.engines import CompilationKind
from unified_planning.engines import PlanGenerationResultStatus as Status
from unified_planning.engines.factory import DEFAULT_ENGINES
from unified_planning.environment import get_environment
from unified_planning.exceptions import UPException
from unified_planning.model import Problem, ProblemKind
from unified_planning.model.problem_kind_versioning import LATEST_PROBLEM_KIND_VERSION
from unified_planning.plans import SequentialPlan

from serendipity.model import Task, UsageError
from serendipity_up.writing import own_problem


@dataclass(frozen=True, slots=True)
class EngineAnswer:
    """What an engine answered: indices of the problem's actions, None without a plan."""

    status: Status
    actions: tuple[int, ...] | None

    @property
    def optimal(self) -> bool:
        """Whether it says that there is no better plan."""
        return bool(self.status == Status.SOLVED_OPTIMALLY)

    @property
    def impossible(self) -> bool:
        """Whether it says that it has proved that there is no plan."""
        return bool(self.status == Status.UNSOLVABLE_PROVEN)


def predict(task: Task, engine: str, *, time_limit: float | None = None) -> tuple[str, ...] | None:
    """A plan of the human alone, by any engine of unified-planning.

    Args:
        task: the task.
        engine: its name in the factory, for example ``fast-downward-opt``.
        time_limit: seconds, or None.

    Returns:
        Names of actions, for ``human_plan=``; None if the engine says that the human has no plan.

    Raises:
        UsageError: there is no such engine, it can't have such problems, or it found neither; or actions
            take time.
    """
    if task.needs_time:
        raise UsageError("predict_with: is for tasks in which no action takes time")
    solved = solve_with(engine, own_problem(task), time_limit)
    if solved.actions is not None:
        return tuple(task.actions[task.human_actions[i]].name for i in solved.actions)
    if solved.impossible or solved.status == Status.UNSOLVABLE_INCOMPLETELY:
        return None
    raise UsageError(f"predict_with: engine '{engine}' found no plan of the human: {solved.status.name}")


def solve_with(engine: str, problem: Problem, time_limit: float | None = None) -> EngineAnswer:
    """What an engine makes of a ground problem."""
    factory = get_environment().factory
    try:
        with _no_credits(), factory.OneshotPlanner(name=_known(engine)) as planner:
            if planner.supports(problem.kind):
                result = planner.solve(problem, timeout=time_limit)
                return _solved(problem, result.status, result.plan)
            kind = CompilationKind.NEGATIVE_CONDITIONS_REMOVING
            with factory.Compiler(problem_kind=problem.kind, compilation_kind=kind) as compiler:
                compiled = compiler.compile(problem, kind)
            result = planner.solve(compiled.problem, timeout=time_limit)
            plan = result.plan
            if plan is not None:
                plan = plan.replace_action_instances(compiled.map_back_action_instance)
            return _solved(problem, result.status, plan)
    except UPException as error:
        raise UsageError(f"engine '{engine}': {' '.join(str(error).split())}") from None


def counts_actions_only(engine: str) -> bool:
    """Whether an engine can't have actions of different costs."""
    kind = ProblemKind(("ACTION_BASED", "ACTIONS_COST"), version=LATEST_PROBLEM_KIND_VERSION)
    return not get_environment().factory.engine(_known(engine)).supports(kind)


def _known(engine: str) -> str:
    engines = get_environment().factory.engines
    package = DEFAULT_ENGINES.get(engine, ("", ""))[0].partition(".")[0].replace("_", "-")
    if engine not in engines and package.startswith("up-"):
        raise UsageError(f"engine '{engine}' is not installed: `pip install {package}`")
    if engine not in engines:
        raise UsageError(f"engine '{engine}': expected one of {', '.join(sorted(engines))}")
    return engine


def _solved(problem: Problem, status: Status, plan: SequentialPlan | None) -> EngineAnswer:
    if plan is None:
        return EngineAnswer(status, None)
    numbers = {action.name: i for i, action in enumerate(problem.actions)}
    return EngineAnswer(status, tuple(numbers[instance.action.name] for instance in plan.actions))


@contextmanager
def _no_credits() -> Iterator[None]:
    """Nothing is printed about who made an engine."""
    environment = get_environment()
    before = environment.credits_stream
    environment.credits_stream = None
    try:
        yield
    finally:
        environment.credits_stream = before
