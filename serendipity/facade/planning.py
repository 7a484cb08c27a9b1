"""Planning calls: options in, results out, incumbents on the way."""

import threading
from collections.abc import Callable, Iterable, Iterator, Mapping
from functools import partial
from importlib import import_module
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, Final, Literal, Unpack

from search import PreparedTask
from serendipity.facade import one_plan, ties
from serendipity.facade.call import Given, Request, Solver, checked_call, options_from
from serendipity.facade.logs import record, recorded
from serendipity.facade.prepared import HELD
from serendipity.facade.results import named_plan, to_result
from serendipity.model import Deadline, Options, PlanOptions, Result, Task, UsageError, Visible
from serendipity.model.answers.answer import Answer
from serendipity.model.arguments import FUNCTION, expect_or_none
from serendipity.model.keywords import listing
from serendipity.model.numbers import Number
from serendipity.model.options import OF_SCENARIOS
from serendipity.model.resources.collection import no_collection
from serendipity.model.task.gate import needs_time, require_metered
from serendipity.model.task.plans import PlanEntry, checked_entries

if TYPE_CHECKING:
    from serendipity.facade.memory import SessionMemory
    from serendipity.facade.scenarios import Unsure
    from serendipity.recognition import GoalsGiven, LibraryGiven, Noise, ObservedGiven


_UNSURE: Final = ("goals", "observed", "beta", "plans", "noise")
"""Arguments of those who don't know what the human will do."""
OF_GOALS: Final = {"observed": (), "beta": 1, "noise": None}
"""Those that say something of goals only, and what they are by default."""


class AnytimeOptions(PlanOptions, total=False):
    """The keyword arguments of each of a session's calls of ``plan_anytime``."""

    visible: Visible | None
    deadline: Deadline | None
    classical: str | None


class SessionOptions(AnytimeOptions, total=False):
    """The keyword arguments of each of a session's calls of ``plan``: those of :func:`serendipity.plan`."""

    goals: "GoalsGiven | None"
    observed: "ObservedGiven"
    beta: Number
    plans: "LibraryGiven | None"
    noise: "Noise | str | None"
    on_improvement: Callable[[Result], None] | None


@listing
def plan(
    task: Task,
    *,
    human: Literal["any"] | None = None,
    human_plan: Iterable[PlanEntry] | None = None,
    visible: Visible | None = None,
    cancelled: threading.Event | None = None,
    deadline: Deadline | None = None,
    goals: "GoalsGiven | None" = None,
    observed: "ObservedGiven" = (),
    beta: Number = 1,
    plans: "LibraryGiven | None" = None,
    noise: "Noise | str | None" = None,
    on_improvement: Callable[[Result], None] | None = None,
    classical: str | None = None,
    **options: Unpack[PlanOptions],
) -> Result:
    """The best plan in which robots help the human, with a proof that none is better.

    Args:
        task: the task.
        human: ``"any"``: whoever of those with goals of their own can be helped best, while the others follow
            their own optimal plans (semantics 10.3); the result says who it is. None: the task's human.
        human_plan: names of the actions that the human is going to do, all or none of them with the
            epochs in which they begin; None predicts an optimal plan of theirs (semantics 1).
        visible: ``visible(agent, fact, state)`` says, by ids of the task, what a human of
            ``human_model="local"`` sees; None for what is where they are.
        cancelled: set from another thread, it ends the call like a time limit.
        deadline: one that other work shares, such as loading the task; it holds beside
            ``time_limit`` and ``memory_limit``, which are of this call alone.
        goals: goals that the human may have, instead of the task's, as :func:`recognise` takes
            them; each is a scenario with its posterior (semantics 8, 11).
        observed: what they have done from the initial state on, for the posterior.
        beta: of the posterior.
        plans: plans that the human may follow, with their probabilities, as :func:`learn` writes them
            (semantics 11).
        noise: of ``observed``, as :func:`recognise` takes it.
        on_improvement: called with the first answer that has a plan, and with each better one, while the
            call goes on; its time counts, too.  What it raises ends the call, and comes out of it.
        classical: a planner for a single agent that is asked beside the search, as a process: ``"symk"``, for
            individual mode, and composite mode without a horizon.  Where that settles the call,
            ``statistics["proved_by"]`` says so: that nothing is cheaper rests on its word.
        **options: fields of :class:`serendipity.model.Options`, ``mode="serendipity"``,
            ``discount=0.6``, ``time_limit=0.1`` (seconds) and so on.

    Raises:
        UsageError: an option is unknown or has no legal value.
        PlanError: ``human_plan`` can't be executed, or misses the goal.
        InputError: ``goals`` or ``observed`` are wrong; it says where.
    """
    asked: SessionOptions = {
        "visible": visible,
        "deadline": deadline,
        "goals": goals,
        "observed": observed,
        "beta": beta,
        "plans": plans,
        "noise": noise,
        "on_improvement": on_improvement,
        "classical": classical,
        **options,
    }
    if human is not None:
        if not isinstance(human, str) or human != "any":
            raise UsageError(f"human: expected 'any', got {human!r:.50}; another one has Task.with_human")
        if human_plan is not None or goals is not None or plans is not None:
            raise UsageError("human: 'any' goes without human_plan, goals and plans")
        from serendipity.facade.bystanders import best_for_anybody  # it asks this very function

        return best_for_anybody(task, cancelled, **asked).result
    with HELD.taken(task) as prepared:
        return planned(prepared, _given(task, human_plan), cancelled, **asked)


def _said(answer: Result) -> str:
    cost = "" if answer.cost is None else f", cost {answer.cost:g}"
    return f"{answer.mode}: {answer.status}{cost}"


@recorded("plan", _said)
def planned(
    prepared: PreparedTask,
    given: Given,
    cancelled: threading.Event | None,
    memory: "SessionMemory | None" = None,
    **asked: Unpack[SessionOptions],
) -> Result:
    """:func:`plan` for those who hold a prepared task, and may remember answers."""
    on_improvement = asked.pop("on_improvement", None)
    unsure: dict[str, Any] = {name: asked.pop(name) for name in _UNSURE if name in asked}
    expect_or_none(FUNCTION, on_improvement=on_improvement)
    with no_collection():  # beside a large task a collection takes longer than a short deadline
        _, answers = _begun(prepared, given, cancelled, memory, asked, unsure)
        if on_improvement is None:
            *_, (about, last) = answers
            return _with_strategies_recorded(_result(about, last))
    return _told(_results(answers), on_improvement)


@listing
def plan_anytime(
    task: Task,
    *,
    human_plan: Iterable[PlanEntry] | None = None,
    visible: Visible | None = None,
    cancelled: threading.Event | None = None,
    deadline: Deadline | None = None,
    classical: str | None = None,
    **options: Unpack[PlanOptions],
) -> Iterator[Result]:
    """Answers as they get better, or as more is known of them; the last is what :func:`plan` returns.

    From one to the next the objective never rises and the lower bound never falls, with one exception: an
    answer without a window has its cost as objective, so the first one with a window, which costs less,
    has an objective that may be larger by up to ``window_weight`` an epoch (semantics 3.1).  Under a time
    limit ``realised`` may be empty until the last one.

    Args and errors are those of :func:`plan`.
    """
    given = _given(task, human_plan)
    with HELD.taken(task) as prepared:
        asked: AnytimeOptions = {"visible": visible, "deadline": deadline, "classical": classical, **options}
        yield from planned_anytime(prepared, given, cancelled, **asked)


def planned_anytime(
    prepared: PreparedTask,
    given: Given,
    cancelled: threading.Event | None,
    memory: "SessionMemory | None" = None,
    **asked: Unpack[AnytimeOptions],
) -> Iterator[Result]:
    """:func:`plan_anytime` for those who hold a prepared task, and may remember answers."""
    with no_collection():
        call, answers = _begun(prepared, given, cancelled, memory, asked)
    said = "left"
    try:
        for result in _results(answers):
            said = _said(result)
            yield result
    finally:
        record("INFO", f"plan_anytime: {said}", call.limits.elapsed())


def _begun(
    prepared: PreparedTask,
    given: Given,
    cancelled: threading.Event | None,
    memory: "SessionMemory | None",
    asked: Mapping[str, Any],
    said: Mapping[str, Any] = MappingProxyType({}),
) -> tuple[Request, Iterator[tuple[Request, Answer]]]:
    """A call whose time has started, and its answers as they get better, each with what it is to."""
    options = {**asked}
    visible, deadline, classical = (options.pop(name, None) for name in ("visible", "deadline", "classical"))
    expect_or_none(FUNCTION, visible=visible)
    chosen = options_from(options)
    if memory is not None:
        chosen = chosen.but(head_start=max(0, chosen.head_start - memory.passed))
    solver = _solver(chosen) if classical is None else _with_classical(_solver(chosen), classical, chosen)
    read = _unsure(chosen, given, said)
    if needs_time(prepared.task, options=chosen):
        import_module("serendipity.facade.in_time")  # before time counts, and only for such calls
    call = checked_call(prepared, chosen, given, visible, cancelled, deadline)
    require_metered(call.task, chosen)
    unsure = None if read is None else read(call.task)
    if memory is not None:
        about = unsure if unsure is not None and any(unsure[:2]) else None
        plan = None if call.given is None else named_plan(call.task, call.given)
        call = call._replace(question=memory.question(chosen, visible, about, plan))
    if call.known is not None:
        return call, iter(((call, call.known),))
    if unsure is not None:
        from serendipity.facade import scenarios

        return call, scenarios.answers(call, unsure)
    in_time = needs_time(call.task, options=chosen, plan=call.given)
    if in_time and classical is not None:
        raise UsageError(f"classical: {in_time}, which it does not know")
    if in_time:
        from serendipity.facade.in_time import answers_in_time

        return call, ((call, answer) for answer in answers_in_time(call, solver))
    return call, ((call, answer) for answer in solver(call))


def _unsure(options: Options, given: Given, said: Mapping[str, Any]) -> "Callable[[Task], Unsure] | None":
    """Reads what is said of a human whose plan is not known; None where it is.

    What answers such calls is loaded here, before time counts, and only for them.
    """
    named = next((name for name in ("goals", "plans") if said.get(name) is not None), None)
    astray = [name for name, usual in OF_GOALS.items() if said.get(name, usual) not in (usual, [])]
    if astray and said.get("goals") is None:
        raise UsageError(f"{astray[0]}: goes with goals only")
    idle = [name for name, usual in OF_SCENARIOS.items() if getattr(options, name) != usual]
    if idle and named is None and options.ties != "watched":
        raise UsageError(f"{idle[0]}: goes with goals, plans or ties 'watched'")
    if named is None and (options.ties != "watched" or given is not None):
        return None
    if named is not None and given is not None:
        instead = "; give observed instead" if named == "goals" else ""
        raise UsageError(f"human_plan: with {named}, it is not known{instead}")
    if said.get("goals") is not None and said.get("plans") is not None:
        raise UsageError("plans: go without goals, each plan can name its own")
    if named is not None and options.mode != "serendipity":
        raise UsageError(f"{named}: are for mode 'serendipity' only, not for '{options.mode}'")
    from serendipity.facade.scenarios import read_unsure

    return partial(read_unsure, **said)


def _solver(options: Options) -> Solver:
    """The solver that answers a call in a mode; it loads what that needs, before time counts."""
    if options.mode != "assistance":
        return ties.answers if options.mode in ("serendipity", "communication") else one_plan.answers
    from search.modes.assistance import assist

    if options.time_limit is not None:  # what only large tasks need takes longer to load than a short limit
        import_module("search.modes.assistance.distances.perimeter")
    return lambda call: assist(call.prepared, call.options, call.deadline)


def _with_classical(solver: Solver, name: str, options: Options) -> Solver:
    from serendipity.facade import classical

    classical.check_classical(name, options)
    return partial(classical.answers, solver=solver, name=name)


def _results(answers: Iterator[tuple[Request, Answer]]) -> Iterator[Result]:
    result = None
    while True:
        with no_collection():  # only while it plans: what the caller does with an answer is the caller's
            following = next(answers, None)
            if following is None:
                break
            call, answer = following
            result = _result(call, answer, last=False)
        record("DEBUG", f"on the way: {_said(result)}", call.limits.elapsed())
        yield result
    if result is not None and not result.realised:
        with no_collection():
            result = _result(call, answer)
        if result.realised:
            yield result
    if result is not None:
        _with_strategies_recorded(result)


def _with_strategies_recorded(result: Result) -> Result:
    """The result, once the log has a line for each turn that was taken."""
    for row in result.statistics.get("strategies", ()):
        bound = "" if row["bound"] is None else f", bound {row['bound']:g}"
        settled = ", settled" if row["settled"] else ""
        record("INFO", f"turn {row['name']}: better {row['better']} times{bound}{settled}", row["seconds"])
    return result


def _told(results: Iterator[Result], on_improvement: Callable[[Result], None]) -> Result:
    """The last result; those on the way to it that are better, and not only closer to a proof, are told."""
    best: tuple[float | None, float | None] = (None, None)
    for result in results:
        reached = (result.objective, result.cost)
        if result.cost is not None and reached != best:
            best = reached
            on_improvement(result)
    return result


def _given(task: Task, names: Iterable[PlanEntry] | None) -> Given:
    return None if names is None else partial(task.plan_from_names, checked_entries(names, "human plan"))


def _result(call: Request, answer: Answer, *, last: bool = True) -> Result:
    question = call.question
    if question is not None:
        limit = call.deadline.reached() or call.limits.reached()
        answer = question.unless_worse(call.task, question.better(answer), limit)
    answer = one_plan.with_verdicts(call, answer, last=last)
    if question is not None:
        question.answered(call.task, answer)
    return to_result(call.task, call.options, answer, call.deadline.elapsed())
