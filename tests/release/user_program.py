"""A program as a user writes it: every type checker that reads ``py.typed`` knows what it handles.

Where a line is marked as wrong, it is; a checker in strict mode complains if it can't see that.
"""

from collections.abc import Sequence
from typing import Unpack

import serendipity
from serendipity import (
    Certificate,
    Execution,
    Mode,
    Options,
    PlanOptions,
    PlanStep,
    Result,
    Session,
    Status,
    Task,
    UsageError,
    Window,
)


def helped(task: Task, discount: float) -> Result:
    """The best help, and whether it is proved."""
    result = serendipity.plan(task, discount=discount, on_improvement=lambda _better: None)
    certificate: Certificate = serendipity.verify(task, result)
    assert certificate.verdict == "proved"
    return result


def by_robot(steps: Sequence[PlanStep], robot: str) -> float:
    """What a robot's actions cost."""
    return sum(step.cost for step in steps if robot in step.agents)


def epochs(task: Task) -> int:
    """How long it takes where everybody does as planned, and nobody is in a hurry."""
    session = told(discount=0.6, max_cost="human", horizon=task.name.count("-") + 20)
    answer = session.plan()
    run = Execution(task, discount=0.6)
    for name in answer.human_plan or ():
        if not run.done:
            run.step(name if name in run.possible() else None)
    return len(run.passed)


def asked(mode: Mode) -> Options:
    """A mode, handed on."""
    return Options(mode=mode)


def told(**options: Unpack[PlanOptions]) -> Session:
    """Options, handed on."""
    return Session(serendipity.example("room2"), **options)


def wrong(result: Result, task: Task) -> None:
    """What a type checker has to see."""
    serendipity.plan(task, discont=0.6)  # type: ignore[call-arg]
    serendipity.plan(task, discount=[1])  # type: ignore[arg-type]
    serendipity.plan(task, mode="serendpity")  # type: ignore[arg-type]
    serendipity.interruptions(task, ties="robust")  # type: ignore[call-arg]
    serendipity.explain(task, mode="help")  # type: ignore[arg-type]
    serendipity.execute(task, disount=0.6)  # type: ignore[call-arg]
    serendipity.verify(task, result, solver="glpk")  # type: ignore[arg-type]
    Session(task, discont=0.6).plan(human_modell="local")  # type: ignore[call-arg]
    Options(discont=0.6)  # type: ignore[call-arg]
    status: Status = "optimum"  # type: ignore[assignment]
    assert result.status == status
    result.cost = 1.0  # type: ignore[misc]
    serendipity.plan(task.name)  # type: ignore[arg-type]
    len(result.window)  # type: ignore[arg-type]


def main() -> None:
    """Plan, prove, write down and execute; the frame of a library where one is installed."""
    task = serendipity.example("room2")
    result = helped(task, 0.6)
    window: Window | None = result.window
    assert window is not None and result.plan is not None and result.cost is not None
    steps: Sequence[PlanStep] = result.plan
    print(f"{result.cost:g} from epoch {window.start} on, of which robot {by_robot(steps, 'robot'):g}")
    print(f"{len(result.to_dataframe())} steps, {epochs(task)} epochs")
    again = Result.from_dict(result.to_dict())
    assert again == result
    try:
        asked("sideways")  # type: ignore[arg-type]
    except UsageError as error:
        print(error)


if __name__ == "__main__":
    main()
