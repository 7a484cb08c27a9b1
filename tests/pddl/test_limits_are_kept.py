"""Loading ends where a limit comes, whatever is being done, and estimates what it would make first."""

import time
from pathlib import Path

import pytest

import serendipity
from serendipity import LimitReachedError, Task, pddl
from serendipity.model import Deadline
from serendipity.model.resources.deadline import MIB
from serendipity.model.resources.memory import resident
from serendipity.pddl import forget_parsed
from serendipity.pddl.grounding.instantiate import Instantiator
from serendipity_testing.countdown import Countdown
from tests.endings import endings
from tests.pddl.texts import OFFICE, YARD, action, domain, names, one, pair, problem

PLACES = " ".join(f"w{i}" for i in range(9))
TOOLS = " ".join(f"t{i}" for i in range(62))
OBJECTS = f"h r - agent {PLACES} - place {TOOLS} - tool"
TWELVE = [f"?x{i}" for i in range(12)]
MENDED = "(p) (mended ?w - place) (have ?t - tool)"


def shop(folder: Path, condition: str, effect: str = "(p)", goal: str = "(p)") -> Task:
    """A task with nine places and 62 tools."""
    act = action("mend", condition, effect, "?who - agent ?w - place")
    make = action("make", "(and)", "(mended ?w) (have ?t)", "?who - agent ?w - place ?t - tool")
    text = domain(act, make, predicates=MENDED, types="place tool agent")
    return one(folder, text, problem("", goal, OBJECTS))


def quantified(quantifier: str, kind: str, body: str) -> str:
    return f"({quantifier} ({' '.join(TWELVE)} - {kind}) {body})"


ALL_OF_THEM = f"(or {' '.join(f'(mended {x})' for x in TWELVE)})"


@pytest.mark.parametrize("quantifier", ["forall", "exists"])
def test_variables_that_nothing_mentions_are_no_work(tmp_path: Path, quantifier: str) -> None:
    body = quantified(quantifier, "place", "(mended ?x0)")
    task = shop(tmp_path, body, quantified("forall", "tool", "(have ?x3)"), body)
    assert len({*names(task, "mend")}) == 18
    assert {len(a.add) for a in task.actions if a.name.startswith("mend")} == {62}


def test_a_conjunction_is_quantified_part_by_part(tmp_path: Path) -> None:
    body = f"(and {' '.join(f'(mended {x})' for x in TWELVE)})"
    task = shop(tmp_path, quantified("forall", "place", body), goal=quantified("forall", "place", body))
    assert len(task.goal.positive) == 9


def test_a_variable_without_any_object_counts(tmp_path: Path) -> None:
    text = domain(
        action("all", "(forall (?x - void) (q))", "(p)"),
        action("some", "(exists (?x - void) (and))", "(p)"),
        action("give", "(r)", "(p) (forall (?x - void) (q))"),
        types="thing agent void",
    )
    task = one(tmp_path, text, problem("(r)"))
    assert names(task) == ["all h", "all r", "give h", "give r"]
    assert {len(a.add) for a in task.actions} == {1}


EVERYWHERE = quantified("forall", "place", ALL_OF_THEM)
SOMEWHERE = quantified("exists", "place", ALL_OF_THEM.replace("or", "and"))
ALL_HAD = f"(and {' '.join(f'(have {x})' for x in TWELVE)})"


@pytest.mark.parametrize(
    ("condition", "effect", "goal", "said"),
    [
        ("(and)", "(p)", EVERYWHERE, "problem.pddl:5: goal comes to 3,389,154,437,772"),
        (EVERYWHERE, "(p)", "(p)", "domain.pddl:5: action 'mend' comes to 3,389,154,437,773"),
        (f"(or (p) {SOMEWHERE})", "(p)", "(p)", "domain.pddl:5: action 'mend' comes to 3,389,154,437,774"),
        ("(and)", quantified("forall", "tool", f"(when {ALL_HAD} (p))"), "(p)", "'mend' comes to 10^22"),
    ],
)
def test_quantifiers_that_stand_for_too_much(
    tmp_path: Path, condition: str, effect: str, goal: str, said: str
) -> None:
    with pytest.raises(LimitReachedError) as caught:
        shop(tmp_path, condition, effect, goal)
    assert caught.value.reason == "memory-limit"
    assert said in str(caught.value)
    assert str(caught.value).endswith("literals without quantifiers")


def test_too_many_ground_actions(tmp_path: Path) -> None:
    parameters = " ".join(f"?x{i} - thing" for i in range(60))
    text = domain(action("go", "(q)", "(p)", f"?who - agent {parameters}"))
    with pytest.raises(LimitReachedError, match=r":5: action 'go' comes to 10\^18 ground actions") as caught:
        one(tmp_path, text, problem(init="(q)"))
    assert caught.value.reason == "memory-limit"


def large(folder: Path, places: int) -> tuple[Path, Path]:
    """Files with twice as many ground actions as there are fourfold choices of a place."""
    parameters = "?who - agent ?a ?b ?c ?d - thing"
    text = domain(
        action("see", "(q)", "(s ?a ?b ?c ?d) (not (s ?b ?a ?c ?d))", parameters),
        predicates="(p) (q) (s ?a ?b ?c ?d)",
    )
    objects = f"h r - agent {' '.join(f'o{i}' for i in range(places))} - thing"
    return pair(folder, text, problem("(q)", "(s o1 o2 o3 o4)", objects))


def test_ground_actions_are_estimated_against_the_memory_limit(tmp_path: Path) -> None:
    files = large(tmp_path, 38)
    start = time.perf_counter()
    with pytest.raises(LimitReachedError, match="action 'see' comes to 4,170,272 ground actions"):
        serendipity.load_pddl(*files, human="h", robots=["r"], memory_limit=(resident() or 0) / MIB + 900)
    assert time.perf_counter() - start < 1


@pytest.mark.parametrize("limit", [0.0, 0.05, 0.4])
def test_a_time_limit_is_kept(tmp_path: Path, limit: float) -> None:
    files = large(tmp_path, 38)
    start = time.perf_counter()
    with pytest.raises(LimitReachedError, match="the time limit came first, reading the task") as caught:
        serendipity.load_pddl(*files, human="h", robots=["r"], time_limit=limit)
    assert caught.value.reason == "time-limit"
    assert time.perf_counter() - start < limit + 0.25  # much slower machines included


def test_memory_that_is_used_up_is_one_line(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def exhausted(*_: object) -> None:
        raise MemoryError

    monkeypatch.setattr(Instantiator, "ground", exhausted)
    with pytest.raises(LimitReachedError, match="memory is used up, reading the task") as caught:
        serendipity.load_pddl(*OFFICE, human="ann", robots=["bot"])
    assert caught.value.reason == "memory-limit"


def test_the_deadline_may_come_anywhere() -> None:
    def load(deadline: Deadline) -> Task:
        forget_parsed()
        return pddl.read_folder(YARD, deadline=deadline)

    *early, last = endings(load, sparser=0)
    assert last == pddl.read_folder(YARD)
    assert all(isinstance(error, LimitReachedError) and error.reason == "time-limit" for error in early)
    assert {str(error).split("(")[1].split()[0] for error in early} >= {
        "reading",
        "grounding,",
        "finding",
        "sorting",
    }


def test_preparing_is_under_the_limit_too(tmp_path: Path) -> None:
    files = large(tmp_path, 7)
    assert len(serendipity.load_pddl(*files, human="h", robots=["r"]).actions) == 2 * 7**4
    limits = Countdown(10**9)

    def stop(doing: str) -> None:
        if doing.startswith("preparing"):
            limits.left_over[0] = 0

    with pytest.raises(LimitReachedError, match=r"reading the task \(preparing 4,802 ground actions\)"):
        serendipity.load_pddl(*files, human="h", robots=["r"], deadline=limits, on_progress=stop)


def test_progress_tells_what_is_done_and_how_many_actions_there_are(tmp_path: Path) -> None:
    told: list[str] = []
    serendipity.load_pddl(*large(tmp_path, 9), human="h", robots=["r"], on_progress=told.append)
    assert told[0].startswith("reading ")
    counts = [int(doing.split()[1].replace(",", "")) for doing in told if doing.startswith("grounding,")]
    assert len(counts) > 2
    assert counts == sorted({*counts})
    assert told[-1] == "preparing 13,122 ground actions"
