"""Executions with a simulated person, again and again: what is asked for, and what becomes of each run."""

from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from contextlib import closing, nullcontext
from dataclasses import asdict, dataclass, fields
from fractions import Fraction
from functools import cached_property
from random import Random
from typing import Any, Final, Literal, TypedDict, Unpack

from search import PreparedTask
from search.kernel.library import library
from serendipity.execution.adapters import AdapterChoice, Faults, Maker
from serendipity.execution.execution import Execution, own_goals
from serendipity.execution.leftovers import about_robots
from serendipity.execution.log import log_lines
from serendipity.execution.persons import Person, Persona, moment_of, persona_from
from serendipity.execution.recorded import recorded_actions
from serendipity.execution.robot_policy import RobotPolicy
from serendipity.execution.runs import Run, Runs
from serendipity.facade.planning import plan
from serendipity.model import HumanModel, HumanPlan, PlanError, Result, Task, UsageError
from serendipity.model.arguments import FUNCTION, TASK_IN_TIME, WHOLE, expect, expect_or_none
from serendipity.model.keywords import CHOICES, Interference, listing, require_one_of
from serendipity.model.numbers import Number
from serendipity.model.resources.processes import in_processes
from serendipity.model.task.course import BrokenPlanError
from serendipity.model.task.execution import variant_named
from serendipity.model.task.passing import epoch_later
from serendipity.recognition import GoalsGiven, LibraryGiven, Noise, plan_library
from serendipity.robot import Durations

SURE: Final = Fraction(9, 10)
"""The posterior from which on a goal counts as known."""

TIES: Final = ("fixed", "drawn")
"""Which of their optimal plans a person follows: the canonical one, or one that the dice draw."""


_Finished = tuple[Run, tuple[dict[str, Any], ...]]
"""The row of a run and the lines of its log."""


class ExecutionOptions(TypedDict, total=False):
    """What :func:`execute` hands on to each :class:`Execution`, which says what it means."""

    discount: Number
    deadline: float | None
    setup: float
    beta: Number
    noise: Noise | str | None
    mode: Literal["serendipity", "communication"]
    interference: Interference
    leave_free: str | None


@listing
def execute(
    task: Task,
    human: str | Sequence[str] = "observant",
    *,
    runs: int = 1,
    seed: int = 0,
    ties: Literal["fixed", "drawn"] = "fixed",
    faults: Faults | str | None = None,
    adapter: str | Maker | None = None,
    durations: Durations | str | None = None,
    epoch_seconds: float | None = None,
    human_model: HumanModel | None = None,
    goals: GoalsGiven | None = None,
    plans: LibraryGiven | None = None,
    epochs: int | None = None,
    jobs: int = 1,
    on_progress: Callable[[int, int], None] | None = None,
    **options: Unpack[ExecutionOptions],
) -> Runs:
    """Let a simulated person, robots and the world go on epoch by epoch, again and again.

    Args:
        task: where things stand; its goal is the person's.
        human: ``observant``, ``local``, ``omniscient``, ``noisy:P`` or ``recorded:FILE``; or the names of
            recorded actions.
        runs: how many.
        seed: of the first run's dice; the others count on from it.
        ties: ``fixed``: the person follows the canonical one of their optimal plans; ``drawn``: any.  With
            ``plans``, who is omniscient follows the most probable one to their goal; ``drawn``: any by its
            probability.
        faults: how unreliable robots are, ``"fail=0.1,slow=0.1,drop=0.01"`` for example.
        adapter: what carries out what robots do: ``simulated``, ``pybullet`` (in physics), or what makes a
            :class:`serendipity.robot.Adapter` for a run from the task and its dice; None: simulated where
            there are faults or durations, else whatever is possible is done within the epoch.
        durations: of what simulated robots do, ``"move=2..4,*=1"`` for example: seconds by the first word of
            an action.
        epoch_seconds: how long an epoch is for robots; None: 1, and 5 for figures in physics.
        human_model: what robots take the person to be; None: what they are, ``observant`` if in doubt.
        goals: goals that the person may have; robots do not know which.
        plans: a library of plans that the person may follow, instead of ``goals``.
        epochs: the most of a run; None: ten times the length of the person's plan, and a hundred.
        jobs: processes.
        on_progress: called with the number of runs that are over, and of all.
        **options: ``discount``, ``deadline``, ``setup``, ``beta``, ``noise``, ``mode``,
            ``interference`` and ``leave_free`` of :class:`Execution`; without the last robots that have no
            goals of their own may leave changed only what names them, or people may change, where they know
            the person's goal (``"*"``: anything).

    Raises:
        UsageError: an argument is wrong.
        InputError: a file is wrong; it says where.
        PlanError: one of ``plans`` is not possible.
    """
    expect(TASK_IN_TIME, task=task)
    expect(WHOLE, runs=runs, seed=seed, jobs=jobs)
    expect_or_none(WHOLE, epochs=epochs)
    expect_or_none(FUNCTION, on_progress=on_progress)
    for what, number in (("runs", runs), ("jobs", jobs), ("epochs", 1 if epochs is None else epochs)):
        if number < 1:
            raise UsageError(f"{what}: expected at least 1, got {number}")
    require_one_of("ties", ties, TIES)
    if isinstance(human, str):
        name, persona = human, persona_from(task, human)
    else:
        name, persona = "recorded", Persona("recorded", actions=recorded_actions(task, human))
    if persona.told and goals is not None and (task.robot_goal or options.get("mode") == "communication"):
        why = "with robots' own goals, or communication, an omniscient person's goal is known"
        raise UsageError(f"goals: {why}")
    usual = persona.human_model if plans is None else "omniscient"
    model = usual if human_model is None else human_model
    require_one_of("human_model", model, CHOICES["human_model"])
    if plans is not None and model != "omniscient":
        raise UsageError("human_model: with plans only 'omniscient' is possible")
    adapters = AdapterChoice(adapter, faults, durations, epoch_seconds)
    alone = plan(task, mode="individual")
    if options.get("leave_free") is None and goals is None and plans is None and not task.robot_goal:
        options["leave_free"] = about_robots(task)
    series = _Series(
        task=task,
        persona=persona,
        name=name,
        drawn=ties == "drawn",
        adapters=adapters,
        epochs=epochs or 100 + 10 * _length(alone),
        alone=alone.human_cost,
        arguments={"human_model": model, "goals": goals, "plans": plans, "told": persona.told, **options},
    )
    series.untimed()  # what is wrong shows before the first run
    assignments = [(series, number, seed + number - 1) for number in range(1, runs + 1)]
    done = _all_run(assignments, jobs, on_progress)
    return Runs(series.name, tuple(row for row, _ in done), tuple(lines for _, lines in done))


def _all_run(
    assignments: Sequence[tuple["_Series", int, int]],
    jobs: int,
    on_progress: Callable[[int, int], None] | None,
) -> list[_Finished]:
    """The rows and logs of all runs, in their order."""
    library()  # says once if there is none, and not once for each process
    done: list[_Finished] = []
    for finished in map(_run, assignments) if jobs == 1 else in_processes(_run, assignments, jobs):
        done.append(finished)
        if on_progress is not None:
            on_progress(len(done), len(assignments))
    return sorted(done, key=lambda pair: pair[0].run)


def _length(alone: Result) -> int:
    """The length of a human plan in epochs."""
    times = alone.human_plan_times
    return len(alone.human_plan or ()) if times is None else times.epochs


def _run(assignment: tuple["_Series", int, int]) -> _Finished:
    series, number, seed = assignment
    return series.run(number, seed)


@dataclass(frozen=True)
class _Series:
    """The runs of one call, and what is worked out once for all of them; in another process it begins anew.

    Tables are kept: those of the person's, and those of the robots'.  Robots who have had time before the
    first epoch begin each run with the plan that they had then.

    Attributes:
        task: where each run begins.
        persona: who the person is.
        name: what they are called.
        drawn: whether dice draw which of their optimal plans they follow.
        adapters: what carries out what robots do.
        epochs: the most of a run.
        alone: what the person pays alone; None where they don't get there.
        arguments: of :class:`Execution`.
    """

    task: Task
    persona: Persona
    name: str
    drawn: bool
    adapters: AdapterChoice
    epochs: int
    alone: float | None
    arguments: Mapping[str, Any]

    def __reduce__(self) -> tuple[Any, ...]:
        return _Series, tuple(getattr(self, field.name) for field in fields(self))

    @cached_property
    def _prepared(self) -> PreparedTask:
        return PreparedTask(self.task)

    def untimed(self, **arguments: Any) -> Execution:
        """An execution without a deadline."""
        return Execution(self.task, **{**self.arguments, **arguments, "deadline": None})

    @cached_property
    def _ready(self) -> RobotPolicy:
        """Robots who have had time before the first epoch."""
        told, surely, untimed = self.arguments["told"], self.adapters.surely, self.untimed()
        robots = RobotPolicy(untimed.task, untimed.options, None, told=told, surely=surely)
        Execution(self.task, **{**self.arguments, "robots": robots})
        return robots

    def run(self, number: int, seed: int) -> _Finished:
        """One of the runs."""
        task, dice, luck = self.task, Random(f"person {seed}"), Random(f"robots {seed}")
        adapter, faults = self.adapters.adapter(task, luck), self.adapters.faults
        person = self.persona.person(task, dice, drawn=self.drawn, prepared=self._prepared)
        given = {**self.arguments, "adapter": adapter}
        known = given["goals"] is None and given["plans"] is None and not task.needs_time
        if given.get("deadline") is not None and known:
            given |= {"setup": 0, "robots": self._ready.again()}
        run, spoilt = Execution(task, **given), 0
        if self.drawn and run.goal is not None and given["plans"] is not None:
            habits = own_goals(task, (one.aim for one in plan_library(task, given["plans"])))
            (run.goal,) = dice.choices([one.name for one in habits], [float(one.prior) for one in habits])
        left = [task.agents[i] for i in task.robots]
        with nullcontext() if adapter is None else closing(adapter):
            while not run.done and run.epoch <= self.epochs:
                gone = faults.dropped(left, luck)
                if gone:
                    run.drop(gone)
                    left = [robot for robot in left if robot not in gone]
                spoilt += _spoils(run, person)
            arrived = run.done
            while arrived and run.epoch <= self.epochs and (not run.done or _at_work(run)):
                if run.done:
                    run.step()  # robots may end what they have to do
                else:
                    spoilt += _spoils(run, person)  # and have undone what the person has
        decided = [passed.decided for passed in run.passed]
        verdicts = Counter(each.verdict for each in decided)
        row = Run(
            run=number,
            seed=seed,
            reached=run.done,
            epochs=len(run.passed),
            alone=self.alone,
            human_cost=float(run.human_cost),
            cost=float(run.cost),
            helped=sum(any(s.agents != (run.human,) for s in p.steps) for p in run.passed),
            spoilt=spoilt,
            stopped=verdicts["stopped"],
            late=verdicts["late"],
            open=sum(d.verdict != "late" and d.plan is not None and not d.proved for d in decided),
            slowest=max((each.seconds for each in decided), default=0.0),
            left=len(run.left),
            **_recognised(run, run.goal),
        )
        ties = TIES[self.drawn]
        notes = {"run": number, "seed": seed, "policy": self.name, "ties": ties, "faults": asdict(faults)}
        return row, tuple(log_lines(run, **notes))


def _at_work(run: Execution) -> bool:
    """Whether robots have something to do still that they see to."""
    return bool(run.left and (run.decided.actions or run.decided.plan)) or bool(
        run.task.robot_goal and run.going
    )


def _spoils(run: Execution, person: Person) -> bool:
    """Play an epoch; whether it is robots who made what the person had in mind impossible."""
    before = run.now
    passed = run.step(person.choose(moment_of(run)))
    plan = person.plan
    own = [step for step in passed.steps if run.human in step.agents]
    if plan is None or any(len(step.agents) > 1 for step in own):
        return False
    done = [before.actions[variant_named(before, step.action, step.agents, before.init)] for step in own]
    try:
        alone = epoch_later(before, done)
    except BrokenPlanError:
        return False
    return _works(alone, plan) and not _works(run.now, plan)


def _works(task: Task, plan: HumanPlan) -> bool:
    try:
        task.variants_of(plan)
    except PlanError:
        return False
    return True


def _recognised(run: Execution, true: str | None) -> dict[str, Any]:
    """``known``, ``leads`` and ``wrong`` of a row, by the name of the person's goal among the candidates."""
    if true is None:
        return {"known": None, "leads": None, "wrong": 0}
    known, leads, wrong = None, None, 0
    for passed in run.passed:
        goals = passed.decided.goals
        known = (known or passed.epoch) if goals[true] >= SURE else None
        first = all(share < goals[true] for name, share in goals.items() if name != true)
        leads = (leads or passed.epoch) if first else None
        acted = bool(passed.decided.actions or passed.decided.offers)
        wrong += acted and goals[true] < max(goals.values())
    return {"known": known, "leads": leads, "wrong": wrong}
