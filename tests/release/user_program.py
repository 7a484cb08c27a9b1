"""A program as a user writes it: every type checker that reads ``py.typed`` knows what it handles.

Where a line is marked as wrong, it is; a checker in strict mode complains if it can't see that.
"""

from collections.abc import Sequence

import serendipity
from serendipity import Certificate, Execution, PlanStep, Result, Session, Task, UsageError, Window


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
    session = Session(task, discount=0.6)
    answer = session.plan()
    run = Execution(task, discount=0.6)
    for name in answer.human_plan or ():
        if not run.done:
            run.step(name if name in run.possible() else None)
    return len(run.passed)


def wrong(result: Result, task: Task) -> None:
    """What a type checker has to see."""
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
        serendipity.plan(task, mode="sideways")
    except UsageError as error:
        print(error)


if __name__ == "__main__":
    main()
