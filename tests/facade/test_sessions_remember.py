"""A session answers what a fresh call on the same state answers, and keeps the human's plan.

Its answers are never worse than what is left of the last one, whenever a limit comes.
"""

from collections.abc import Iterator
from dataclasses import replace
from random import Random

import pytest

import serendipity
from serendipity import PlanError, PlanStep, Result, SerendipityError, Session, Task, UsageError
from serendipity.model import Deadline, LimitReachedError
from serendipity.model.keywords import Ties
from serendipity_testing.builders import task
from serendipity_testing.cases import case_1, usar
from serendipity_testing.generator import PlanCall, random_call
from tests.endings import endings
from tests.facade.test_sessions_in_time import fresh, same

_FIGURES = ("status", "cost", "objective", "opportunity", "saving", "saving_alone", "lower_bound", "horizon")


def _interrupted(session: Session, **options: object) -> Result:
    """The answer to a call that is cancelled as soon as it has said anything."""
    answers = session.plan_anytime(**options)
    answer = next(answers)
    session.cancel()
    return [answer, *answers][-1]


def _now(answer: Result) -> list[PlanStep]:
    return [step for step in answer.plan or () if step.epoch == 1]


def _value(answer: Result) -> float:
    """What the answer comes to: a person whose plan is not optimal may yet find a better one alone."""
    return float("inf") if answer.cost is None else answer.cost - (answer.saving_alone or 0)


def _fresh(call: PlanCall, session: Session) -> Result | str:
    task = replace(call.task, init=session.task.init)
    if call.options.get("human_model") == "local":  # what they see hangs on the variables, which are kept
        task = call.task.at(session.task.init)
    try:
        return serendipity.plan(task, human_plan=session.human_plan, **call.keywords())
    except SerendipityError as error:
        return str(error)


def _executed(call: PlanCall, dice: Random) -> Iterator[tuple[Session, float]]:
    """A session epoch by epoch, most of them as planned, with what the rest of the last answer costs then."""
    try:
        session = Session(replace(call.task), human_plan=call.human_plan, **call.keywords())
        answer = session.plan()
        for _ in range(5):
            if not answer.plan or answer.cost is None:
                return
            now, as_planned = _now(answer), dice.random() < 0.8
            session.execute([step.action for step in now if as_planned or dice.random() < 0.5])
            yield session, answer.cost - sum(step.cost for step in now) if as_planned else float("inf")
            answer = session.plan()
    except SerendipityError:
        return


def _is_remembered(answer: Result, rest: float) -> bool:
    """Whether the rest of what was known is an answer to the new question, and known to be from the start.

    With several optimal plans of the human's each epoch is another question, and what a human who replans
    would do alone has to be known first.
    """
    over_plans = answer.options.ties != "fixed" and answer.mode in ("serendipity", "communication")
    return _value(answer) <= rest + 1e-9 and answer.options.human_model == "omniscient" and not over_plans


@pytest.mark.long
def test_over_random_calls_and_whole_executions() -> None:
    """In every mode, interrupted: no worse than the rest, no false bound; and in the end the optimum."""
    counted = 0
    for seed in range(140):
        call = random_call(seed)
        for session, rest in _executed(call, Random(seed)):
            fresh = _fresh(call, session)
            if isinstance(fresh, str):
                break
            early = _interrupted(session)
            assert serendipity.check(session.task, early).refuted is None, (seed, early)
            if _is_remembered(fresh, rest):
                counted += 1
                assert _value(early) <= rest + 1e-9, (seed, early, rest)
            if early.lower_bound is not None and fresh.objective is not None:
                assert early.lower_bound <= fresh.objective + 1e-9, (seed, early)
            answer = session.plan()
            found, expected = ([getattr(a, name) for name in _FIGURES] for a in (answer, fresh))
            assert found == expected, seed
    assert counted > 100


@pytest.mark.parametrize("mode", ["serendipity", "communication", "composite", "individual", "assistance"])
def test_an_equal_call_is_answered_at_once(mode: str) -> None:
    session = Session(serendipity.example("room2"), mode=mode, discount=0.9)
    answer = session.plan()
    again = session.plan(time_limit=0)
    assert answer.status == again.status == "optimal"
    assert (again.cost, again.plan, again.realised) == (answer.cost, answer.plan, answer.realised)
    assert again.statistics["expanded"] == 0


@pytest.mark.parametrize(
    ("example", "options"),
    [
        ("office", {}),
        ("office", {"human_model": "observant"}),
        ("office", {"ties": "expected"}),
        ("morning", {"human_model": "local"}),
        ("room2", {"head_start": 2}),
        ("room2", {"waiting_cost": 1}),
        ("room2", {"mode": "assistance"}),
        ("room2", {}),
    ],
)
def test_an_answer_that_is_told_again_says_the_same_of_humans_who_replan(
    example: str, options: dict[str, object]
) -> None:
    """Plans in time were played by rules without time, and those of assistance as composite ones."""
    task = serendipity.example(example)
    session = Session(task, discount="0.6", **options)  # type: ignore[arg-type]
    answer = session.plan()
    for again in (session.plan(), [*session.plan_anytime()][-1]):
        assert again.realised == answer.realised
        assert serendipity.check(task, again).refuted is None
    assert bool(answer.realised) == (not options and example == "room2")


@pytest.mark.parametrize("ties", ["fixed", "robust"])
def test_a_session_that_is_reminded_goes_on_as_the_other_one(ties: Ties) -> None:
    first = serendipity.plan(case_1())
    session = Session(case_1(), human_plan=first.human_plan, ties=ties, discount=0.9)
    answer = session.plan()
    other = Session.restore(case_1(), session.snapshot())
    assert _interrupted(other).plan == answer.plan


@pytest.mark.parametrize("options", [{"ties": "robust"}, {"goals": True}, {"human_model": "observant"}])
def test_so_it_is_over_ties_and_goals_and_with_people_who_replan(options: dict[str, object]) -> None:
    goals = [{"goal": [f"conducted_triage commx {room}"], "prior": 1} for room in ("room1", "room2")]
    asked = {**options, **({"goals": goals} if "goals" in options else {})}
    session = Session(serendipity.example("room2"), discount=0.6)
    answer = session.plan(**asked)
    again = session.plan(time_limit=0, **asked)
    assert (again.status, again.cost, again.ties) == (answer.status, answer.cost, answer.ties)
    assert session.plan(**{**asked, "discount": 0.5}).cost != answer.cost or "goals" in options


def test_what_is_proved_stays_proved_while_all_goes_as_planned() -> None:
    session = Session(serendipity.example("room2"), discount=0.6)
    answer = session.plan()
    for epoch in range(1, answer.window.start):
        session.execute([step.action for step in answer.plan or () if step.epoch == epoch])
        now = session.plan()
        assert (now.status, now.opportunity, now.statistics["expanded"]) == ("optimal", True, 0)
        assert now.window is not None and now.window.start == answer.window.start - epoch


def _begun() -> Session:
    """Help that is proved, an epoch after it was begun."""
    session = Session(case_1(), discount=0.9)
    answer = session.plan()
    session.execute([step.action for step in _now(answer)])
    return session


def test_goals_that_are_not_known_and_assistance_may_be_asked_about_in_between() -> None:
    session = Session(serendipity.example("room2"), discount=0.6)
    known = session.plan().human_plan
    goals = [{"goal": ["conducted_triage commx room1"], "prior": 1}]
    assert session.plan(goals=goals).cost == 12.6
    assert session.plan(mode="assistance").status == "optimal"
    assert session.human_plan == known


def test_what_is_other_than_planned_is_another_question() -> None:
    session = _begun()
    before = session.plan().cost
    session.change({"at k2 r2": False})
    assert serendipity.check(session.task, _interrupted(session)).refuted is None
    alone = session.plan()
    assert alone.cost > before and same(alone, fresh(session, discount=0.9))
    session.follow(None)
    assert session.plan().status == "optimal"
    session.set_goal(["at h s"])
    assert session.rest is None
    assert session.plan().cost == serendipity.plan(replace(session.task), discount=0.9).cost
    with pytest.raises(UsageError, match="there is no fact 'at h nowhere'"):
        session.set_goal(["at h nowhere"])
    with pytest.raises(UsageError, match="not applicable"):
        session.execute(["move h d g"])


def _shortcut(opening: str) -> Task:
    """A long way, and a short one that a robot may open."""
    walks = {f"walk{i} h": f"p{i} -> p{i + 1} !p{i}" for i in range(6)}
    return task(init="p0", goal="p6", actions={**walks, "jump h": "p1 open -> p6 !p1", "open r": opening})


def test_a_predicted_plan_gives_way_to_a_better_one_that_robots_have_made_possible() -> None:
    """The answer in the middle of help was the old plan, which cost 5 where 1 was promised."""
    session = Session(_shortcut("-> open"), discount=0.5)
    answer = session.plan()
    assert answer.opportunity and answer.cost == 2.5
    session.execute([step.action for step in _now(answer)])
    assert session.human_plan == ("jump h",)
    assert _interrupted(session).cost == session.plan().cost == 1


def test_so_it_does_where_nobody_has_planned_that() -> None:
    session = Session(_shortcut("far -> open"), discount=0.5)
    walks = session.plan().human_plan
    session.execute([walks[0]])
    session.change({"open": True})
    answer = session.plan()
    assert (answer.cost, answer.saving_alone) == (5, 4), "that is what was predicted"
    assert (session.plan().cost, session.human_plan) == (1, ("jump h",))
    given = Session(_shortcut("far -> open"), human_plan=walks, discount=0.5)
    given.change({"open": True})
    assert given.plan().cost == given.plan().cost == 6, "that is what they are going to do"


def test_the_rest_is_there_to_be_finished_though_the_new_question_has_no_answer() -> None:
    """Robots may spoil what the human would do alone, on the way to what they do together (semantics 3.1)."""
    task = usar("a0-a1-c-d-g c-s", human="a0", robots={"rob": "s"}, kits={"k": "s"}, triage="g")
    session = Session(task, discount=0.9)
    answer = session.plan()
    assert answer.opportunity and session.rest == answer.plan
    session.execute([step.action for step in _now(answer)])
    assert (session.plan().status, session.plan().reason) == ("infeasible", "no-human-plan")
    while session.rest:
        session.execute([step.action for step in session.rest if step.epoch == 1])
    assert session.task.goal.holds(session.task.init)


def _at_each_look(call: PlanCall, session: Session) -> Iterator[tuple[Session, Result]]:
    """Answers of sessions that know what this one does, if the first look is the last, or the second."""

    def asked(deadline: Deadline) -> tuple[Session, Result]:
        other = Session.restore(replace(session.task), session.snapshot(), **call.keywords())
        return other, other.plan(deadline=deadline)

    return map(_no_error, endings(asked))


def _no_error(ending: tuple[Session, Result] | LimitReachedError) -> tuple[Session, Result]:
    assert not isinstance(ending, LimitReachedError)
    return ending


@pytest.mark.long
def test_whenever_time_is_up_help_that_was_begun_is_answered_or_still_there() -> None:
    """A limit before it was known what the person gains alone gave way to idle robots, in 1 call of 4,000."""
    helped = unknown = 0
    for seed in range(240):
        call = random_call(seed)
        for session, rest in _executed(call, Random(seed)):
            left = session.rest
            if not left or all(step.agents == (call.task.agents[call.task.human],) for step in left):
                continue
            fresh = _fresh(call, session)
            if isinstance(fresh, str) or not _is_remembered(fresh, rest):
                continue
            for other, answer in _at_each_look(call, session):
                assert serendipity.check(session.task, answer).refuted is None, seed
                helped += answer.opportunity
                unknown += answer.status == "unknown"
                assert _value(answer) <= rest + 1e-9 or (answer.status, other.rest) == ("unknown", left), seed
    assert helped > 100 and unknown > 100


def test_his_plan_goes_on_behind_his_action_and_waiting_is_none() -> None:
    session = Session(case_1(), discount=0.6)
    predicted = session.plan().human_plan
    session.execute([predicted[0]])
    assert session.human_plan == predicted[1:]
    session.execute(["move h a1 a0"])
    assert session.human_plan is None
    given = Session(case_1(), human_plan=["noop", *predicted], discount=0.6)
    given.plan()
    given.execute([predicted[0]])
    assert given.human_plan == predicted[1:]


def test_a_given_plan_need_not_work_before_what_was_seen_is_told() -> None:
    predicted = Session(case_1(), discount=0.6).plan().human_plan
    assert predicted is not None
    elsewhere = case_1().at(case_1().init - {case_1().facts.index("at h a0")})
    session = Session(elsewhere, human_plan=predicted, discount=0.6)
    with pytest.raises(PlanError):
        session.plan()
    assert session.human_plan == predicted
    session.change({"at h a0": True})
    assert session.human_plan == predicted
    assert same(session.plan(), fresh(session, discount=0.6))
    session.change({"at h a0": False})
    assert session.human_plan is None


def test_options_and_facts_that_mean_nothing_are_refused_at_once() -> None:
    with pytest.raises(UsageError, match="discount: expected a number"):
        Session(case_1(), discount=7)
    with pytest.raises(UsageError, match="unknown option 'luck'"):
        Session(case_1(), luck=1)  # type: ignore[call-arg]
    session = Session(case_1())
    with pytest.raises(UsageError, match="at h a0: expected true or false, got 'no'"):
        session.change({"at h a0": "no"})  # type: ignore[dict-item]
    assert session.task == case_1()


def test_answers_on_the_way_know_only_options_of_their_own() -> None:
    told = list[Result]()
    session = Session(case_1(), on_improvement=told.append, discount=0.6)
    *_, answer = session.plan_anytime()
    assert answer.cost == Session(case_1(), discount=0.6).plan().cost
    assert not told, "they are yielded"
    with pytest.raises(UsageError, match=r"^on_improvement: goes with plan only, not with plan_anytime$"):
        next(session.plan_anytime(on_improvement=told.append))  # type: ignore[call-arg]
    goals = [{"goal": ["conducted_triage commx room1"], "prior": 1}]
    for name, value in (("goals", goals), ("plans", [{}]), ("beta", 2), ("noise", "miss=0.1")):
        unsure = Session(serendipity.example("room2"), **{name: value})  # type: ignore[arg-type]
        with pytest.raises(UsageError, match=rf"^{name}: goes with plan only, not with plan_anytime$"):
            next(unsure.plan_anytime())
    again = Session(serendipity.example("room2"), goals=goals, discount=0.6)
    assert [*again.plan_anytime(goals=None)][-1].status == "optimal"  # type: ignore[call-arg]


def test_waiting_may_be_said() -> None:
    session = Session(case_1(), discount=0.6)
    session.plan()
    session.execute(["noop"])
    assert session.task == case_1()


def test_a_predicted_plan_is_predicted_again_behind_another_head_start() -> None:
    office = serendipity.example("office")
    session = Session(office)
    for head_start in (0, 3, 1, 0):
        answer, new = session.plan(head_start=head_start), serendipity.plan(office, head_start=head_start)
        assert [getattr(answer, name) for name in _FIGURES] == [getattr(new, name) for name in _FIGURES]
