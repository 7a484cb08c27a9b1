"""Planning again and again in a control loop: what doesn't change between calls is kept."""

import threading
import weakref
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import suppress
from functools import cached_property
from itertools import combinations
from typing import Any, Final, Unpack

from search import PreparedTask
from serendipity.facade.call import Given, options_from
from serendipity.facade.memory import SessionMemory
from serendipity.facade.planning import AnytimeOptions, SessionOptions, planned, planned_anytime
from serendipity.facade.prepared import HELD
from serendipity.facade.results import named_plan, named_steps
from serendipity.facade.said import entries, on_the_way, plain, time_of
from serendipity.model import HumanPlan, InputError, Options, PlanError, PlanStep, Result, Task, UsageError
from serendipity.model.arguments import BY_NAME, FLAG, TASK_IN_TIME, expect
from serendipity.model.keywords import listing
from serendipity.model.options import MAX_EPOCH
from serendipity.model.schemas import schema_fault
from serendipity.model.task.actions import NOOP, GroundAction, apply, conflicting
from serendipity.model.task.course import BrokenPlanError
from serendipity.model.task.facts import Facts
from serendipity.model.task.passing import epoch_later, going_on, taken_up
from serendipity.model.task.plans import PlanEntry, TimedPlan, left_after
from serendipity.model.task.plans_in_time import cost_alone, times_of
from serendipity.model.task.task import canonical_name, several

SNAPSHOT: Final = "serendipity.session/1"

_EXCEPT: Final = ", or this is a later one of its session: expected the task that it began with"


class Session:
    """A task in its present state, and the human's plan as far as it is known.

    In time the script counts from the present state, too, and what has begun goes on (semantics 10.4). A head
    start counts from where the session has begun.

    Packed actions, finite-domain variables and projections are kept from call to call,
    also after an epoch has been executed or a fact has changed; a new goal packs anew.

    Args:
        task: where things stand.
        human_plan: the human's plan, as :func:`serendipity.plan` takes it, or None to predict it.
        **options: defaults of every call, as for :func:`serendipity.plan`.
    """

    @listing
    def __init__(
        self, task: Task, *, human_plan: Iterable[PlanEntry] | None = None, **options: Unpack[SessionOptions]
    ) -> None:
        expect(TASK_IN_TIME, task=task)
        asleep = plain(options).head_start
        self._begun = task
        """Whose digest serves all sessions that begin with it."""
        self._prepared = HELD.take(task)
        weakref.finalize(self, HELD.hold, self._prepared).atexit = False
        self._options = options
        self._given = None if human_plan is None else entries(task, human_plan)
        """A plan that nothing has been made of yet: it may be one only after the next change."""
        self._human_plan: HumanPlan | None = None
        """The plan; at most one of the two is known."""
        self._predicted = False
        """Whether it is not the caller who has said so."""
        self._is_outdated = False
        """Whether it is known not to be what a human would do who looks up."""
        self._up = asleep
        """The epoch with which the head start is over, as it was asked for last."""
        self._cancelled = threading.Event()
        self._memory = SessionMemory()

    def __repr__(self) -> str:
        return f"Session({self.task!r:.90})"

    @property
    def task(self) -> Task:
        """The task from the present state."""
        return self._prepared.task

    @property
    def human_plan(self) -> tuple[PlanEntry, ...] | None:
        """The plan of the human, behind what is left of a head start; None until it is given or predicted.

        In time its epochs count from now, or from the end of the head start.
        """
        return self._given if self._human_plan is None else named_plan(self.task, self._human_plan)

    @property
    def rest(self) -> tuple[PlanStep, ...] | None:
        """The rest of the last answer's plan, its epochs counted from now; None once the world deviates.

        It can be finished, whatever the question from the present state would be answered with.
        """
        rest = self._memory.rest
        return None if rest is None else named_steps(self.task, rest.options.discount, rest.steps)

    @listing
    def plan(self, **options: Unpack[SessionOptions]) -> Result:
        """The best answer from the present state (see :func:`serendipity.plan`)."""
        self._cancelled.clear()
        chosen: dict[str, Any] = {**self._options, **options}
        known = self._known_plan(chosen)
        answer = planned(self._prepared, known, self._cancelled, self._memory, **chosen)
        self._learn(answer)
        return answer

    @listing
    def plan_anytime(self, **options: Unpack[AnytimeOptions]) -> Iterator[Result]:
        """Answers as they get better; :meth:`cancel` ends them with the incumbent.

        Nothing is told of them to ``on_improvement``, where the session has one.

        Raises:
            UsageError: goals or plans, or what is said of them, are options of the session or of this call.
        """
        self._cancelled.clear()
        chosen = on_the_way(self._options, options)
        known = self._known_plan(chosen)
        for answer in planned_anytime(self._prepared, known, self._cancelled, self._memory, **chosen):
            self._learn(answer)
            yield answer

    def snapshot(self) -> dict[str, Any]:
        """Where it stands, as a JSON object: schema ``serendipity.session/1``, for :meth:`restore`.

        Raises:
            UsageError: what the human sees is a function.
        """
        other = self._options.keys() - Options.__dataclass_fields__.keys()
        if other:
            raise UsageError(f"snapshot: {min(other)} is no plain value; give it to each call")
        task, asked, begun = self.task, plain(self._options).to_dict(), self._begun
        time, passed = {}, min(self._memory.passed, MAX_EPOCH)  # with which every script is over
        if begun.needs_time or passed or self._asleep:
            going = going_on(begun, passed, task)
            time = {"time": {"passed": passed, "going": going, "asleep": self._asleep}}
        return {
            "schema": SNAPSHOT,
            "task": begun.digest,
            **time,
            "options": {name: asked[name] for name in self._options if name in asked},
            "facts": [task.facts[fact] for fact in sorted(task.init)],
            "goal": list(task.goal.literals(task.facts)),
            "human_plan": None if self.human_plan is None else list(self.human_plan),
            "predicted": self._predicted,
            "outdated": self._is_outdated,
            "answers": self._memory.written(task),
        }

    @classmethod
    def restore(cls, task: Task, snapshot: Mapping[str, Any], **options: Unpack[SessionOptions]) -> "Session":
        """A session that stands where another one stood, in this process or another.

        Args:
            task: the task that the other one began with, from any of its states.  In time a later ``task`` of
                that session may be another one: what is left of the script, and what goes on, is part of it.
            snapshot: what :meth:`snapshot` has told.
            **options: instead of those of the other one.

        Raises:
            InputError: the snapshot is of another task, or none.
        """
        expect(TASK_IN_TIME, task=task)
        expect(BY_NAME, snapshot=snapshot)
        plain(options)
        if fault := schema_fault(snapshot.get("schema"), SNAPSHOT):
            raise InputError(f"snapshot: {fault}")
        if snapshot.get("task") != task.digest:
            raise InputError(f"snapshot: it is of another task{_EXCEPT if 'time' in snapshot else ''}")
        try:
            options_from({**snapshot["options"]})
            asked: dict[str, Any] = {**snapshot["options"], **options}
            (passed, going, asleep), true = time_of(snapshot), [*snapshot["facts"]]
            is_predicted, is_outdated = snapshot["predicted"], snapshot.get("outdated", False)
            expect(FLAG, predicted=is_predicted, outdated=is_outdated)
            session = cls(taken_up(task, passed, going) if task.needs_time else task, **asked)
            session._begun, session._memory.passed = task, passed
            session._up = passed + (session._asleep if asleep is None else asleep)
            session.set_goal(snapshot["goal"])
            session.change({**dict.fromkeys(task.facts, False), **dict.fromkeys(true, True)})
            session.follow(snapshot["human_plan"])
            session._predicted, session._is_outdated = is_predicted, is_outdated
            session._memory.read(session.task, snapshot["answers"])
        except (KeyError, TypeError, ValueError, AttributeError, IndexError):
            raise InputError("snapshot: expected what Session.snapshot() writes") from None
        except UsageError as error:
            raise InputError(f"snapshot: {error}") from None
        return session

    def __reduce__(self) -> tuple[Any, ...]:
        raise TypeError("a session is not pickled: restore(task, snapshot()) begins one where it stands")

    def _known_plan(self, asked: Mapping[str, Any]) -> Given:
        if self._is_outdated:
            self._human_plan, self._given, self._is_outdated = None, None, False
        unsure = any(asked.get(name) is not None for name in ("goals", "plans"))
        asleep = max(0, plain(asked).head_start - self._memory.passed)
        others = unsure or asked.get("mode") == "assistance" or asleep != self._asleep
        unknown = self.human_plan is None or (self._predicted and others)  # which predict the human otherwise
        return None if unknown else self._replayed

    def _replayed(self, head_start: int) -> HumanPlan:
        """The plan of the human, replayed behind a head start.

        Raises:
            PlanError: the names that were given are no plan.
        """
        if self._human_plan is None or head_start != self._asleep:
            assert self.human_plan is not None, "asked for a plan that nobody knows"
            self._human_plan, self._given = self.task.plan_from_names(self.human_plan, head_start), None
        return self._human_plan

    def _learn(self, answer: Result) -> None:
        head_start = answer.options.head_start
        self._up = self._memory.passed + head_start
        if answer.ties is not None or answer.goals is not None:
            return  # they are about several plans
        # Robots may have made another plan cheaper, and nothing helps beside this one.
        self._is_outdated = self._predicted and bool(answer.saving_alone) and not answer.opportunity
        if self.human_plan is None:
            his = answer.human_entries
            self._given = left_after(his, head_start) if his and head_start else his
            self._predicted = True

    def cancel(self) -> None:
        """End the running call, from any thread; it returns the incumbent."""
        self._cancelled.set()

    def execute(self, actions: Iterable[str]) -> None:
        """Move on by one epoch in which these actions were executed, or begun (none or noop: all waited).

        The human's plan goes on behind their action.  It is predicted anew after a joint
        action, after one that was not next, and where its rest does not work any more.  One that was
        predicted gives way to what is left of the answer's plan for them, once robots have done their
        part in it and that is cheaper.

        Raises:
            UsageError: an action is unknown or not applicable, or two of them conflict.
        """
        named = [name for name in several(actions, "actions") if not self.task.waits(canonical_name(name))]
        chosen = [self._action(name) for name in named]
        his = [action for action in chosen if self.task.human in action.participants]
        if self._in_time:
            self._execute_in_time(chosen, his)
        else:
            _require_compatible(chosen)
            self._move(self._prepared.at(apply(self.task.init, *chosen)), epochs=1)
            self._follow(his)
        self._take_up_rest()

    @property
    def _asleep(self) -> int:
        """What is left of the head start."""
        return max(0, self._up - self._memory.passed)

    @property
    def _in_time(self) -> bool:
        timed = any(not isinstance(entry, str) for entry in self._given or ())
        return self.task.needs_time or timed or isinstance(self._human_plan, TimedPlan) or self._asleep > 0

    def _execute_in_time(self, chosen: list[GroundAction], his: list[GroundAction]) -> None:
        self._keep_plan_if_it_works()
        before, plan, left = self.task, self._human_plan, list[tuple[int, str]]()
        asleep = self._asleep
        if plan is not None:
            left = times_of(before, plan).timed(before.actions[i].name for i in plan)
        try:
            later = epoch_later(before, chosen)
        except BrokenPlanError as error:
            raise UsageError(f"epoch: {error}") from None
        self._move(PreparedTask(later) if before.needs_time else self._prepared.at(later.init), epochs=1)
        if his:
            on_plan = not his[0].joint and bool(left) and left[0][1] == his[0].name
            plan, left = plan if on_plan else None, left[1:]
        is_late = not his and bool(left) and left[0][0] == 1 and left[0][1] != NOOP
        left_over = left if is_late or asleep else left_after(left, 1)
        self._human_plan, self._given = None, None if plan is None else tuple(left_over)
        self._keep_plan_if_it_works()

    def change(self, facts: Mapping[str, bool]) -> None:
        """Set facts to true or false, as they were seen.

        Raises:
            UsageError: there is no such fact.
        """
        expect(BY_NAME, facts=facts)
        state = self._facts.seen(self.task.init, facts.items())
        if state == self.task.init:
            return
        self._move(self._prepared.at(state), epochs=0)
        self._keep_plan_if_it_works()

    def follow(self, names: Iterable[PlanEntry] | None) -> None:
        """Say what the human is going to do from here; None predicts it anew.

        The next call replays it, and raises :class:`serendipity.PlanError` where it can't be executed.

        Raises:
            PlanError: an action is unknown, or begins in an epoch that there never is, or too early.
        """
        given = None if names is None else entries(self.task, names)
        self._human_plan, self._predicted, self._is_outdated = None, False, False
        self._given = given

    def set_goal(self, goal: Iterable[str]) -> None:
        """Give the human another goal: literals, ``!`` in front of those to be false.

        Raises:
            UsageError: there is no such fact.
        """
        self._prepared = self._prepared.with_goal(self._facts.condition(several(goal, "goal")))
        self._human_plan = self._given = None
        self._memory.forget()

    def _move(self, now: PreparedTask, *, epochs: int) -> None:
        before, self._prepared = self.task, now
        self._memory.moved(before, self.task, epochs=epochs)

    def _follow(self, his: list[GroundAction]) -> None:
        known = self.human_plan
        if known is not None and his:
            (action,) = his
            on_plan = not action.joint and known[:1] == (action.name,)
            self._human_plan = self._human_plan[1:] if on_plan and self._human_plan is not None else None
            self._given = self._given[1:] if on_plan and self._given is not None else None
        self._keep_plan_if_it_works()

    def _take_up_rest(self) -> None:
        rest, task, asleep = self._memory.rest, self.task, self._asleep
        if not self._predicted or self._human_plan is None or rest is None or not rest.steps:
            return
        plan: HumanPlan = tuple(step.action for step in rest.steps)
        if (
            any(task.actions[i].participants != (task.human,) for i in plan)
            or min(rest.steps).epoch <= asleep
        ):
            return
        if task.needs_time:
            named = [(step.epoch - asleep, task.actions[step.action].name) for step in sorted(rest.steps)]
            in_time = _plan_until(task, named, task.epochs_of(self._human_plan), asleep)
            if in_time is None:
                return
            plan = in_time
        price = rest.options.waiting_cost
        if cost_alone(task, plan, price, asleep) < cost_alone(task, self._human_plan, price, asleep):
            self._human_plan = plan

    def _keep_plan_if_it_works(self) -> None:
        try:
            if self._human_plan is not None:
                self._human_plan = self.task.variants_of(self._human_plan, self._asleep)
            elif self._given is not None:
                self._replayed(self._asleep)
        except PlanError:
            self._human_plan = self._given = None

    def _action(self, name: str) -> GroundAction:
        ids = self.task.named.get(canonical_name(name))
        if ids is None:
            raise UsageError(f"there is no action '{name}' in the task")
        actions = [self.task.actions[i] for i in ids]
        found = next((action for action in actions if action.applicable(self.task.init)), None)
        if found is None:
            raise UsageError(f"'{name}' is not applicable in the present state")
        return found

    @cached_property
    def _facts(self) -> Facts:
        """The facts by name, which no move changes."""
        return Facts(self.task.facts)


def _plan_until(task: Task, named: Sequence[PlanEntry], end: int, asleep: int) -> HumanPlan | None:
    """A human plan; where it misses the goal, with waiting until its end, for what others do; or None."""
    for his in (named, [*named, (end, NOOP)]):
        with suppress(PlanError):
            return task.plan_from_names(his, asleep)
    return None


def _require_compatible(chosen: list[GroundAction]) -> None:
    for action, other in combinations(chosen, 2):
        if conflicting(action, other, strict=False):
            raise UsageError(f"'{action.name}' and '{other.name}' can't share an epoch")
