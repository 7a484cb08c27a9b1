"""Small tasks with one robot, in which silent assistance has something to decide."""

from hypothesis import strategies as st

from serendipity.model import Task
from serendipity_testing.builders import task as build

_COSTS = st.sampled_from(["1", "1", "1", "2", "0", "0.5", "3"])


@st.composite
def _effects(draw: st.DrawFn, facts: list[str], most_needs: int) -> str:
    needs = draw(st.lists(st.sampled_from(facts), max_size=most_needs, unique=True))
    sets = draw(st.lists(st.sampled_from(facts), min_size=1, max_size=2, unique=True))
    pre = " ".join(draw(st.sampled_from(["", "", "!"])) + fact for fact in needs)
    effects = " ".join(draw(st.sampled_from(["", "", "!"])) + fact for fact in sets)
    return f"{pre} -> {effects} @ {draw(_COSTS)}"


@st.composite
def strips_games(draw: st.DrawFn) -> Task:
    """Random actions over 3-4 facts."""
    facts = [f"f{i}" for i in range(draw(st.integers(3, 4)))]
    actions = {f"a{k} h": draw(_effects(facts, 2)) for k in range(draw(st.integers(2, 5)))}
    actions |= {f"b{k} r": draw(_effects(facts, 1)) for k in range(draw(st.integers(1, 3)))}
    init = draw(st.lists(st.sampled_from(facts), max_size=2, unique=True))
    goal = draw(st.lists(st.sampled_from(facts), min_size=1, max_size=2, unique=True))
    return build(init=" ".join(init), goal=" ".join(goal), actions=actions)


@st.composite
def walking_games(draw: st.DrawFn) -> Task:
    """The prime walks a small graph with equally good ways; the supporter carries them or blocks places."""
    places = [f"p{i}" for i in range(draw(st.integers(4, 6)))]
    goal = places[-1]
    edges = draw(
        st.lists(st.tuples(st.sampled_from(places), st.sampled_from(places)), min_size=4, max_size=9)
    )
    closable = draw(st.sampled_from(["", *places]))
    actions = {}
    for a, b in edges:
        if a != b:
            free = f" !closed{b}" if b == closable else ""
            actions[f"walk h {a} {b}"] = f"{a}{free} -> {b} !{a} @ {draw(st.sampled_from(['1', '1', '2']))}"
    for k in range(draw(st.integers(1, 2))):
        a, b = draw(st.sampled_from(places)), draw(st.sampled_from(places))
        if a != b:
            once = f" !used{k}" if draw(st.booleans()) else ""
            spent = f" used{k}" if once else ""
            actions[f"carry{k} r"] = f"{a}{once} -> {b} !{a}{spent} @ {draw(_COSTS)}"
    if closable:
        actions["close r"] = f" -> closed{closable} @ {draw(_COSTS)}"
        if draw(st.booleans()):
            actions["open r"] = f" -> !closed{closable} @ {draw(_COSTS)}"
    return build(init=places[0], goal=goal, actions=actions)


def games() -> st.SearchStrategy[Task]:
    """Tasks with one human ``h`` and one robot ``r``, at most some 50 states."""
    return st.one_of(strips_games(), walking_games())
