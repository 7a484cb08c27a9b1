"""The kernel on the human's own problem: admissible bounds, costs as by brute force, plans that are plans."""

from collections.abc import Callable
from contextlib import suppress
from ctypes import CDLL
from functools import partial
from random import Random

import pytest
from hypothesis import given
from hypothesis import strategies as st

from search.classical import planner as planner_module
from search.classical.planner import ClassicalPlanner
from search.human.whole_actions import alone_planner
from search.kernel.build import compile_kernel, compiler
from search.kernel.library import BINARY, SOURCE, library, load
from search.packed.cost_vector import INFINITE_KEY, own_weights
from search.packed.operators import applicable
from search.packed.packed_task import PackedTask
from serendipity import Task, plan
from serendipity.model import Deadline, LimitReachedError
from serendipity_testing.generator.families import family_task
from serendipity_testing.strategies import family_tasks, tasks
from tests.search.classical.exact_costs import exact
from tests.search.small_tasks import CORRIDOR, packed_of

pytestmark = pytest.mark.skipif(library() is None, reason="there is no kernel here")


def planner_of(packed: PackedTask) -> ClassicalPlanner:
    return alone_planner(packed, packed.goal, Deadline()).planner


def assert_leads_to_goal(packed: PackedTask, state: int, numbers: list[int]) -> int:
    """Replay operators; what they weigh."""
    weights, total = own_weights(packed), 0
    for number in numbers:
        op = packed.own[number]
        assert applicable(op, state)
        state, total = state & op.keep | op.put, total + weights[op.cost]
    assert packed.goal.holds(state)
    return total


@given(tasks())
def test_a_new_planner_finds_the_optimum(task: Task) -> None:
    packed = packed_of(task)
    planner, cost = planner_of(packed), exact(packed)[packed.init]
    assert planner.cheapest(packed.init, Deadline()) == cost
    found = planner.cheapest_plan(packed.init, Deadline())
    assert (found is None) == (cost == INFINITE_KEY)
    if found is not None:
        assert assert_leads_to_goal(packed, packed.init, found) == cost


@given(tasks(), st.integers(0, 2**32))
def test_what_was_learnt_changes_no_answer(task: Task, seed: int) -> None:
    packed = packed_of(task)
    planner, costs, random = planner_of(packed), exact(packed), Random(seed)
    weights = sorted({*costs.values()} - {INFINITE_KEY}) or [1]
    for state, cost in costs.items():
        assert planner.bound(state, Deadline()) <= cost
    for _ in range(3 * len(costs)):
        state, cost = random.choice([*costs.items()])
        limit = random.choice(
            [INFINITE_KEY, INFINITE_KEY, random.choice(weights), random.choice(weights) + 1]
        )
        found = planner.cheapest(state, Deadline(), limit)
        assert found == cost if cost < limit else found >= limit
        some = random.choice([*costs])
        assert planner.bound(some, Deadline()) <= costs[some]


class Impatient(Deadline):
    """Comes whenever it is looked at."""

    def check(self) -> None:
        """See :class:`Deadline`."""
        raise LimitReachedError("time-limit")


def interrupted(packed: PackedTask, limit: int, asked: Callable[[], list[int]]) -> int:
    """The cheapest amount in as many parts as there may be; bounds of states are asked for in between."""
    planner, found = planner_of(packed), None
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(planner_module, "SLICE", 1e-6)
        with suppress(LimitReachedError):
            found = planner.cheapest(packed.init, Impatient(), limit)
        while found is None:
            assert planner.is_open
            for state in asked():
                planner.bound(state, Deadline())
            planner.first_plan(packed.init, Deadline())
            with suppress(LimitReachedError):
                found = planner.go_on(Impatient())
    assert not planner.is_open
    best = planner.best_so_far(packed.init)
    if found < min(limit, INFINITE_KEY):
        assert best is not None and assert_leads_to_goal(packed, packed.init, best) == found
    return found


@given(tasks(), st.integers(0, 2**32))
def test_an_interrupted_search_goes_on(task: Task, seed: int) -> None:
    packed = packed_of(task)
    costs, random = exact(packed), Random(seed)
    cost = costs[packed.init]
    limit = random.choice([INFINITE_KEY, cost, min(cost + 1, INFINITE_KEY)])
    found = interrupted(packed, limit, lambda: random.sample([*costs], min(10, len(costs))))
    assert found == cost if cost < limit else found >= limit


@pytest.mark.long
def test_bounds_of_states_that_wait_lose_none() -> None:
    for seed in range(40):
        packed = packed_of(family_task("blocks", seed, 5))
        cost, random = planner_of(packed).cheapest(packed.init, Deadline()), Random(seed)
        near = sorted({walked(packed, random) for _ in range(300)})
        assert interrupted(packed, INFINITE_KEY, partial(random.sample, near, min(20, len(near)))) == cost


def walked(packed: PackedTask, random: Random) -> int:
    """A state that the human may come to alone in a few steps."""
    state = packed.init
    for _ in range(random.randint(1, 12)):
        if able := [op for op in packed.own if applicable(op, state)]:
            op = random.choice(able)
            state = state & op.keep | op.put
    return state


@given(tasks())
def test_a_first_plan_is_a_plan(task: Task) -> None:
    packed = packed_of(task)
    planner, costs = planner_of(packed), exact(packed)
    for state, cost in costs.items():
        found = planner.first_plan(state, Deadline())
        assert (found is None) == (cost == INFINITE_KEY)
        if found is not None:
            assert assert_leads_to_goal(packed, state, found) >= cost


class Refusing(Deadline):
    """Has so many bytes."""

    def __init__(self, size: float) -> None:
        super().__init__()
        self.left_over = size

    def require(self, size: float) -> None:
        """See :class:`Deadline`."""
        if size > self.left_over:
            raise LimitReachedError("memory-limit")
        self.left_over -= size


def test_memory_is_asked_for_and_what_was_allocated_is_kept(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(planner_module, "ROOM", 0)  # before anything is allocated
    packed = packed_of(CORRIDOR)
    planner, cost = planner_of(packed), exact(packed)[packed.init]
    for ask in (planner.cheapest, planner.first_plan, planner.bound):
        with pytest.raises(LimitReachedError):
            ask(packed.init, Refusing(1000))
    found = planner.first_plan(packed.init, Refusing(1e8))
    assert found is not None
    assert assert_leads_to_goal(packed, packed.init, found) >= cost
    assert planner.first_plan(packed.init, Refusing(0)) == found
    assert planner.cheapest(packed.init, Refusing(1e8)) == cost
    assert planner.bound(packed.init, Refusing(0)) == cost


@pytest.fixture(scope="module")
def forgetful(tmp_path_factory: pytest.TempPathFactory) -> CDLL:
    """A kernel that has room for few landmarks only."""
    command, binary = compiler(), tmp_path_factory.mktemp("kernel") / BINARY.name
    if command is None:
        pytest.skip("there is no compiler here")
    compile_kernel([*command, *LITTLE], binary)
    return load(binary, SOURCE)


LITTLE = ("-DLONGEST=256", "-DMOST_LANDMARKS=2048", "-DMOST_SETS=65536")


@pytest.mark.long
@pytest.mark.parametrize(("seed", "blocks"), [(4, 8), (2, 9), (4, 10)])
def test_landmarks_that_were_forgotten_are_not_used(forgetful: CDLL, seed: int, blocks: int) -> None:
    packed = packed_of(family_task("blocks", seed, blocks))
    planner = planner_of(packed)
    assert ClassicalPlanner(forgetful, planner.problem, Deadline()).cheapest(
        packed.init, Deadline()
    ) == planner.cheapest(packed.init, Deadline())


@pytest.mark.parametrize("many", [0, 1])
@given(task=tasks() | family_tasks())
def test_answers_are_those_of_python(many: int, task: Task) -> None:
    def ask() -> list[object]:
        fresh = Task(**{name: getattr(task, name) for name in FIELDS})
        alone = plan(fresh, mode="individual")
        team = plan(fresh, mode="composite", horizon="inf")
        return [alone.status, alone.cost, alone.human_plan, team.status, team.cost, team.saving]

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("search.human.individual_planner._MANY", many)
        compiled = ask()
        patch.setenv("SERENDIPITY_KERNEL", "off")
        assert ask() == compiled


FIELDS = ("name", "agents", "human", "facts", "init", "goal", "actions", "robot_goal", "disjunctions")
