"""Lifted tasks of several agents as one agent's: optima are those of composite and individual mode."""

from fractions import Fraction
from pathlib import Path

import pytest

import serendipity
from serendipity import InputError, load_agents, load_pddl
from serendipity.classical import fast_downward
from serendipity.pddl.classical import lifted_files
from serendipity.pddl.parsing.files import read_unit
from serendipity.pddl.parsing.lifted import Unit
from serendipity.pddl.work import Work
from serendipity.scenarios.examples import DATA, EXAMPLES
from tests.pddl.texts import domain, pair, problem

SHIPPED = ("parcels", "flights")
RIDES = """(:action ride :agent ?who - agent :parameters (?from ?to - thing)
  :precondition (and (a ?from) (way ?from ?to))
  :effect (and (a ?to) (not (a ?from))
               (increase (total-cost) (far ?who ?from ?to)) (increase (total-cost) 0.5)))
(:action wave :agent ?who - agent :parameters (?where - thing)
  :precondition (and (a ?where) (exists (?other - thing) (and (b ?other) (not (= ?other ?where)))))
  :effect (and (p) (forall (?any - thing) (when (b ?any) (not (b ?any))))))"""


def rides(folder: Path) -> tuple[Path, Path]:
    """Costs that depend on who acts and where to, some of them unknown, and quantifiers."""
    values = " ".join(
        f"(= (far {who} {a} {b}) {far})"
        for who, far in (("h", 3), ("r", 2), ("other", 0))
        for a, b in (("o1", "o2"), ("o2", "o3"))
    )
    predicates = "(p) (a ?x - thing) (b ?x - thing) (way ?x ?y - thing)"
    return pair(
        folder,
        domain(RIDES, predicates=predicates, functions="(far ?w - agent ?x ?y - thing)"),
        problem(
            f"(a o1) (b o1) (way o1 o2) (way o2 o3) {values}",
            "(and (p) (a o3) (not (b o1)))",
            "h r other - agent o1 o2 o3 - thing",
            "(:metric minimize (total-cost))",
        ),
    )


def shares(agents: tuple[str, ...], discount: str) -> dict[str, Fraction]:
    human, *robots = agents
    return {human: Fraction(1), **dict.fromkeys(robots, 1 - Fraction(discount))}


def unit(files: tuple[Path, Path]) -> Unit:
    return read_unit(None, *files, Work())


def optimum(folder: Path, files: tuple[Path, Path], agents: tuple[str, ...], discount: str) -> float | None:
    """Of what is written, read again as the task of one agent."""
    written = lifted_files(unit(files), shares(agents, discount))
    task = load_agents({"everybody": pair(folder, written.domain, written.problem, "one")}, human="everybody")
    assert all(action.cost.denominator == 1 for action in task.actions)
    cost = serendipity.plan(task, mode="individual").cost
    return None if cost is None else cost / written.scale


def example_files(name: str) -> tuple[tuple[Path, Path], tuple[str, ...]]:
    shipped = EXAMPLES[name]
    return (DATA / shipped.domain, DATA / shipped.problem), (shipped.human, *shipped.robots)


@pytest.mark.parametrize("discount", ["0", "0.9", "1"])
@pytest.mark.parametrize("name", SHIPPED)
def test_the_team_pays_what_one_agent_pays(name: str, discount: str, tmp_path: Path) -> None:
    files, agents = example_files(name)
    team = serendipity.plan(
        serendipity.example(name), mode="composite", horizon="inf", discount=discount, interference="strict"
    )
    assert optimum(tmp_path, files, agents, discount) == pytest.approx(team.cost)


@pytest.mark.parametrize("name", SHIPPED)
def test_without_robots_it_is_the_human_alone(name: str, tmp_path: Path) -> None:
    files, (human, *_) = example_files(name)
    alone = serendipity.plan(serendipity.example(name), mode="individual")
    assert optimum(tmp_path, files, (human,), "0") == alone.cost


@pytest.mark.parametrize(("agents", "discount"), [(("h",), "0"), (("h", "r"), "0"), (("h", "r"), "0.9")])
def test_costs_depend_on_who_acts(agents: tuple[str, ...], discount: str, tmp_path: Path) -> None:
    files = rides(tmp_path)
    task = load_pddl(*files, human="h", robots=["r"])
    mode = {"mode": "individual"} if len(agents) == 1 else {"mode": "composite", "horizon": "inf"}
    expected = serendipity.plan(task, discount=discount, **mode)
    assert expected.status == "optimal"
    assert optimum(tmp_path, files, agents, discount) == pytest.approx(expected.cost)


@pytest.mark.parametrize(
    ("action", "message"),
    [
        ("(:action go :parameters (?who - agent) :effect (p))", "expected an ':agent'"),
        (
            "(:action go :agent ?who - agent :parameters (?x - (either thing agent)) :effect (p))",
            "know no type 'either'",
        ),
    ],
)
def test_what_other_planners_do_not_know_is_refused(action: str, message: str, tmp_path: Path) -> None:
    files = pair(tmp_path, domain(action), problem())
    with pytest.raises(InputError, match=message):
        lifted_files(unit(files), shares(("h", "r"), "0"))


@pytest.mark.skipif(fast_downward.absent() is not None, reason=fast_downward.absent() or "")
@pytest.mark.parametrize("search", [fast_downward.LMCUT, fast_downward.IPDB])
@pytest.mark.parametrize("name", SHIPPED)
def test_fast_downward_proves_the_same(name: str, search: fast_downward.Search) -> None:
    files, agents = example_files(name)
    task = serendipity.example(name)
    found = fast_downward.run(lifted_files(unit(files), shares(agents, "0.9")), search, 20)
    team = serendipity.plan(task, mode="composite", horizon="inf", discount="0.9")
    assert (found.status, found.cost) == ("optimal", Fraction(str(team.cost)))
    alone = fast_downward.run(lifted_files(unit(files), shares(agents[:1], "0")), search, 20)
    assert (alone.status, alone.cost) == ("optimal", team.human_cost)
    assert alone.expanded > 0 and alone.seconds > 0 and alone.memory is not None
