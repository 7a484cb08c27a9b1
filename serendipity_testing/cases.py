"""The hand-checkable tasks of semantics 9, by number; more than one test feeds on them."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import partial

from serendipity.model import Task
from serendipity_testing.builders import task
from serendipity_testing.builders import usar as full_usar

usar = partial(full_usar, delivered=False, triage_everywhere=False)
"""Without the facts that no plan of these tasks needs: brute force has to cope with them."""


def case_1() -> Task:
    """Handed over in c, on the human's way (window [5, 6))."""
    return usar(
        "a0-a1-a2-a3-c-d-g d-s c-r r-r2",
        human="a0",
        robots={"rob": "r"},
        kits={"k1": "s", "k2": "r2"},
        triage="g",
    )


def case_2() -> Task:
    """K trades the window's length for cost."""
    return usar("a-b-c-g c-s s-u", human="a", robots={"rob": "s"}, kits={"k": "u"}, triage="g")


def case_3() -> Task:
    """Two kits at the same distance; the human's plan is given: ``CASE_3_PLAN``."""
    return usar("a-s a-b-c-g c-r", human="a", robots={"rob": "r"}, kits={"k1": "s", "k2": "r"}, triage="g")


CASE_3_PLAN = (
    "move h a s",
    "pick_up_medkit h k1 s",
    "move h s a",
    "move h a b",
    "move h b c",
    "move h c g",
    "conduct_triage h g",
)


def case_4() -> Task:
    """Two optimal plans of 8; only one can be helped."""
    return usar("a-b-c-d-g b-s c-r", human="a", robots={"rob": "r"}, kits={"k1": "s", "k2": "r"}, triage="g")


def case_5() -> Task:
    """Silent assistance: carrying pays before the human has chosen their way."""
    return task(
        agents="p s",
        human="p",
        init="pa",
        goal="pd",
        actions={
            "walk p a b": "pa -> pb !pa",
            "walk p a c": "pa -> pc !pa",
            "walk p b a": "pb -> pa !pb",
            "walk p c a": "pc -> pa !pc",
            "walk p b d": "pb -> pd !pb",
            "walk p c d": "pc -> pd !pc",
            "carry s b d": "pb -> pd !pb",
        },
    )


def case_6() -> Task:
    """Silent assistance: blocking the human costs nothing."""
    return task(
        agents="p s",
        human="p",
        init="pa freex freeg",
        goal="pg",
        actions={
            "walk p a x": "pa freex -> px !pa",
            "walk p x g": "px freeg -> pg !px",
            "close s x": "freex -> closedx !freex",
            "carry s a g": "closedx pa -> pg !pa",
        },
    )


def case_7(*, first_kit: str = "a") -> Task:
    """Everybody in one room with two kits: which actions share an epoch."""
    return usar("a-b", human="a", robots={"rob": "a"}, kits={"k1": first_kit, "k2": "a"}, triage="a")


def case_8() -> Task:
    """The human has no plan alone: the robot holds the only kit."""
    return usar("a-b", human="a", robots={"rob": "a"}, kits={"k": "@rob"}, triage="a")


def case_9() -> Task:
    """A joint action that sets only the human's own fact."""
    return task(goal="p", actions={"do h": "-> p @ 3", "do_together h r": "-> p @ 1"})


def case_10() -> Task:
    """A joint action of two robots."""
    return task(
        agents="h r1 r2",
        goal="p",
        actions={"lift r1 r2": "-> q @ 4", "do1 h": "-> p @ 5", "do2 h": "q -> p @ 1"},
    )


@dataclass(frozen=True, slots=True)
class Worked:
    """One figure of semantics 9: a call and its answer."""

    task: Callable[[], Task]
    options: Mapping[str, object]
    cost: str | None
    window: tuple[int, int] | None = None
    opportunity: bool = True
    human_plan: tuple[str, ...] | None = None

    def __str__(self) -> str:
        chosen = ",".join(f"{name}={value}" for name, value in self.options.items())
        return f"{self.task.__name__}[{chosen}]"


def _none(
    case: Callable[[], Task], cost: str, human_plan: tuple[str, ...] | None = None, **options: object
) -> Worked:
    return Worked(case, options, cost, opportunity=False, human_plan=human_plan)


def _help(
    case: Callable[[], Task],
    cost: str,
    window: tuple[int, int] | None,
    human_plan: tuple[str, ...] | None = None,
    **options: object,
) -> Worked:
    return Worked(case, options, cost, window, human_plan=human_plan)


WORKED: tuple[Worked, ...] = (
    _none(case_1, "10", discount="0"),
    _none(case_1, "10", discount="0.5"),
    _help(case_1, "9.6", (5, 6), discount="0.6"),
    _help(case_1, "8.4", (5, 6), discount="0.9"),
    _help(case_1, "9.6", None, discount="0.6", mode="communication"),
    _help(case_1, "8.4", None, discount="0.9", mode="communication"),
    _help(case_2, "8.5", (4, 5), discount="0.5"),
    _help(case_2, "7", (3, 6), discount="0.5", window_weight="0"),
    _help(case_2, "7", (3, 6), discount="0.5", window_weight="0.75"),
    _help(case_2, "8.5", (4, 5), discount="0.5", window_weight="0.8"),
    _help(case_2, "7", None, discount="0.5", mode="composite"),
    _none(case_3, "7", CASE_3_PLAN, discount="0.9"),
    _help(case_3, "5.2", (1, 4), CASE_3_PLAN, discount="0.9", window_weight="0"),
    _help(case_3, "5.2", None, CASE_3_PLAN, discount="0.9", mode="communication"),
    _help(case_4, "6.2", (3, 4), discount="0.9"),
    _help(case_4, "6.2", (3, 4), discount="0.9", ties="optimistic"),
    _none(case_4, "8", discount="0.9", ties="robust"),
    Worked(case_8, {"mode": "individual"}, None, opportunity=False),
    Worked(case_8, {"mode": "serendipity"}, None, opportunity=False),
    _none(case_8, "2", mode="communication", horizon=2),
    _none(case_8, "2", mode="composite"),
    Worked(case_8, {"mode": "composite", "horizon": 1}, None, opportunity=False),
    _help(case_9, "1", (1, 2), discount="0"),
    _help(case_9, "1", (1, 2), discount="0.9"),
    _none(case_10, "5", discount="0.5"),
    _help(case_10, "3", (1, 2), discount="0.5", horizon=2),
    _none(case_10, "5", discount="0", horizon=2),
)
"""Cases 1-4 and 8-10; ``cost`` None means infeasible."""
