"""The exact front of saving against disturbance: what each less of one costs of the other (semantics 13)."""

import threading
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from fractions import Fraction
from math import lcm
from typing import TYPE_CHECKING, Any, Final, Unpack

from serendipity.facade.planning import plan
from serendipity.model import Certificate, Deadline, PlanOptions, Result, Task, UsageError
from serendipity.model.answers.over_scenarios import MEASURES
from serendipity.model.arguments import FUNCTION, TASK_IN_TIME, expect, expect_or_none
from serendipity.model.keywords import listing
from serendipity.model.numbers import Number, as_written, plain
from serendipity.model.resources.limits import limits_from
from serendipity.model.table import Table, Tabular
from serendipity.model.task.disturbance import disturbance_from
from serendipity.model.task.plans import PlanEntry
from serendipity.model.telling import Grid, Line, Output

if TYPE_CHECKING:
    from serendipity.recognition import GoalsGiven, LibraryGiven, Noise, ObservedGiven

SCHEMA: Final = "serendipity.front/1"

_COLUMNS: Final = {"disturbance": float, "saving": float, "cost": float, "status": str, "proof": str}
_SHARE: Final = 0.5
"""The share of the time that is left for one more point."""


@dataclass(frozen=True, slots=True)
class FrontPoint:
    """A point of the front.

    Attributes:
        disturbance: how much the human is disturbed.
        result: the answer: none saves more that disturbs them no more.
        certificate: of it, or None.
    """

    disturbance: Fraction
    result: Result
    certificate: Certificate | None = None

    @property
    def saving(self) -> Fraction:
        """What the answer saves."""
        return as_written(self.result.saving or 0)

    def cells(self) -> tuple[Any, ...]:
        """The cells of its row."""
        proof = None if self.certificate is None else self.certificate.verdict
        return (float(self.disturbance), self.result.saving, self.result.cost, self.result.status, proof)


@dataclass(frozen=True, slots=True, repr=False)
class Front(Tabular, Output):
    """The front of saving against disturbance.

    Attributes:
        human: the human's name.
        human_cost: of their plan.
        points: of rising disturbance; no two are as good in both.
        disturbance: the weights, as options have them; None for the default.
        complete: whether each point is proved, and none is missing.
    """

    human: str
    human_cost: float | None
    points: tuple[FrontPoint, ...]
    disturbance: str | None
    complete: bool

    def table(self) -> Table:
        """The points, one a row."""
        return Table(_COLUMNS, tuple(point.cells() for point in self.points))

    def to_dict(self) -> dict[str, Any]:
        """The JSON object."""
        found = []
        for point in self.points:
            proof = None if point.certificate is None else point.certificate.to_dict()
            row = {"disturbance": float(point.disturbance), "result": point.result.to_dict()}
            found.append(row if proof is None else row | {"certificate": proof})
        return {
            "schema": SCHEMA,
            "human": self.human,
            "human_cost": self.human_cost,
            "disturbance": self.disturbance,
            "complete": self.complete,
            "points": found,
        }

    def told(self) -> Iterator[Line | Grid]:
        """The lines that ``front`` prints."""
        weights = disturbance_from(self.disturbance)
        said = ", ".join(f"{kind} {plain(getattr(weights, kind))}" for kind in ("ask", "meet", "sight"))
        several = [point.result.options.risk for point in self.points if point.result.goals]
        pays = f"alone: {MEASURES[several[0]]}" if several else "alone pays"
        yield Line(f"{self.human} {pays} {plain(self.human_cost)}; what disturbs: {said}")
        rows = [
            tuple(plain(cell) if isinstance(cell, float) else cell or "" for cell in point.cells())
            for point in self.points
        ]
        yield Grid(tuple(_COLUMNS), rows, numbered=True)
        if not self.complete:
            yield Line("a limit came first: there may be more points, or better ones")

    def _in_short(self) -> Iterator[str]:
        yield self.human
        yield f"{len(self.points)} points"

    def _repr_svg_(self) -> str:
        return str(drawn(self, ".svg"))


def drawn(front: Front, suffix: str) -> str | bytes:
    """A front as a picture, ``.svg`` or ``.png``.

    Raises:
        UsageError: there is no such form, or PNG lacks the extra ``plot``.
    """
    from serendipity.pictures import draw_front

    return draw_front([(point.disturbance, point.saving) for point in front.points], suffix)


@listing
def front(
    task: Task,
    *,
    human_plan: Iterable[PlanEntry] | None = None,
    goals: "GoalsGiven | None" = None,
    observed: "ObservedGiven" = (),
    beta: Number = 1,
    plans: "LibraryGiven | None" = None,
    noise: "Noise | str | None" = None,
    verify: bool = False,
    cancelled: threading.Event | None = None,
    deadline: Deadline | None = None,
    on_point: Callable[[FrontPoint], None] | None = None,
    **options: Unpack[PlanOptions],
) -> Front:
    """All that can be had of saving and of being left in peace: each point is the best of its disturbance.

    From the best answer on each next one has to disturb the human less (epsilon-constraint method), until
    they are left alone, or nothing is left that does.  Unless ``window_weight`` is given it is 0, so that
    what counts beside disturbance is cost alone.

    Args:
        task: the task.
        human_plan: the human's plan, as for :func:`serendipity.plan`.
        goals: goals that they may have, likewise; what disturbs them is the most of any scenario then.
        observed: likewise, as are the next three.
        beta: of the posterior.
        plans: that they may follow.
        noise: of ``observed``.
        verify: whether each point has a certificate.
        cancelled: as for :func:`serendipity.plan`.
        deadline: likewise.
        on_point: called with each answer on the way; one that saves no more than the next is left out.
        **options: as for :func:`serendipity.plan`; limits are for all points together.

    Raises:
        UsageError: an option is wrong.
        InputError: ``goals`` or ``observed`` are wrong; it says where.
    """
    expect(TASK_IN_TIME, task=task)
    expect_or_none(FUNCTION, on_point=on_point)
    seconds, memory = options.pop("time_limit", None), options.pop("memory_limit", None)
    limits = limits_from(seconds, memory, deadline, cancelled)
    if options.pop("max_disturbance", None) is not None:
        raise UsageError("max_disturbance: front finds all of them")
    given = options.get("disturbance")
    kinds = disturbance_from(given)
    step = Fraction(1, lcm(kinds.ask.denominator, kinds.meet.denominator, kinds.sight.denominator))
    asked: dict[str, Any] = {"window_weight": 0, **options, "disturbance": given or _text(kinds)}
    asked |= {"goals": goals, "observed": observed, "beta": beta, "plans": plans, "noise": noise}
    names = None if human_plan is None else tuple(human_plan)
    points: list[FrontPoint] = []
    complete, most = True, None
    while most is None or most >= 0:
        part = limits.part(_SHARE)
        answer = plan(task, human_plan=names, max_disturbance=most, deadline=part, **asked)
        amount = answer.figure("disturbance")
        if answer.cost is None or amount is None:
            complete = complete and answer.status == "infeasible"
            break
        point = FrontPoint(as_written(amount), answer, _proof(task, answer, part) if verify else None)
        if on_point is not None:
            on_point(point)
        complete = complete and answer.status == "optimal"
        points.append(point)
        most = point.disturbance - step
    human_cost = points[0].result.human_cost if points else None
    return Front(task.agents[task.human], human_cost, tuple(_best(points)), given, complete)


def _text(kinds: Any) -> str:
    return f"ask={kinds.ask},meet={kinds.meet},sight={kinds.sight}"


def _proof(task: Task, answer: Result, deadline: Deadline) -> Certificate:
    from serendipity.facade.certify import verify

    return verify(task, answer, deadline=deadline)


def _best(points: Iterable[FrontPoint]) -> Iterator[FrontPoint]:
    """The points that none is as good as in both, by rising disturbance."""
    most = Fraction(-1)
    for point in sorted(points, key=lambda point: (point.disturbance, -point.saving)):
        if point.saving > most:
            most = point.saving
            yield point
