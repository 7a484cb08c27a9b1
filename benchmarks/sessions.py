"""Sessions in households: how long the answer after each executed epoch takes.

    python -m benchmarks.sessions [--epochs N] [--stray SHARE] [--names p4,p6,p8]

A session plans at discount 0.9, an epoch is executed as the answer has it, the session plans again, and so
on until the table is laid; then the next one begins, until so many epochs were executed.  In a share of them
somebody does not get around to what was planned.  Processor time; first answers are told apart.
"""

import time
from collections.abc import Iterator
from itertools import cycle
from random import Random

from benchmarks.problems import PROBLEMS, load, run
from serendipity import Session, Task
from serendipity.evaluation.measuring.figures import percentile


def main(epochs: int = 200, stray: float = 0, names: str = "p4,p6,p8") -> None:
    """Measure and print."""
    domain = PROBLEMS / "home" / "domain.pddl"
    tasks = [load((domain, domain.with_name(f"{name}.pddl"), "ann")) for name in names.split(",")]
    taken = dict[str, list[float]]()
    answers = (timed for task in cycle(tasks) for timed in _day(task, stray, Random(f"{task.name} {stray}")))
    left = epochs
    while left:
        kind, seconds = next(answers)
        taken.setdefault(kind, []).append(seconds)
        left -= kind != "first"
    for kind, times in taken.items():
        told = ", ".join(f"p{share} {1000 * percentile(times, share / 100):.1f} ms" for share in (50, 90, 99))
        print(f"{kind:<10} {len(times):4} answers: {told}, longest {1000 * max(times):.0f} ms")


def _day(task: Task, stray: float, dice: Random) -> Iterator[tuple[str, float]]:
    """After what each answer came, and the time that it took, until there is nothing left to do."""
    session, kind = Session(task, discount=0.9), "first"
    while True:
        begun = time.process_time()
        answer = session.plan()
        yield kind, time.process_time() - begun
        steps = [step for step in answer.plan or session.rest or () if step.epoch == 1]
        if not (answer.plan or session.rest):
            return
        late = dice.choice([step.agents for step in steps] or [()]) if dice.random() < stray else None
        kind = "as planned" if late is None else "otherwise"
        session.execute(step.action for step in steps if step.agents != late)


if __name__ == "__main__":
    run(main, __doc__)
