"""What a ball of states says of distances is what is found state by state."""

from hypothesis import given
from hypothesis import strategies as st

from search.modes.assistance.distances.closure import Arc, Closure
from search.modes.assistance.distances.perimeter import ball_around
from search.packed.cost_vector import ACTIONS_BITS, INFINITE_KEY
from search.packed.packed_task import PackedGoal
from serendipity.model.resources.deadline import Deadline

FIELDS = [0b11, 0b100, 0b1000, 0b110000]
VALUES = [[0, 1, 2, 3], [0, 4], [0, 8], [0, 16, 32]]


@st.composite
def systems(draw: st.DrawFn) -> tuple[list[Arc], PackedGoal]:
    """Arcs over four fields, some of which change together; no step is free."""

    def condition() -> PackedGoal:
        chosen = draw(st.lists(st.integers(0, 3), max_size=2, unique=True))
        need = sum(draw(st.sampled_from(VALUES[i])) for i in chosen)
        barred = [i for i in range(4) if i not in chosen and draw(st.integers(0, 5)) == 0]
        forbidden = tuple((FIELDS[i], draw(st.sampled_from(VALUES[i]))) for i in barred)
        return PackedGoal(sum(FIELDS[i] for i in chosen), need, forbidden)

    def arc() -> Arc:
        changed = draw(st.lists(st.integers(0, 3), min_size=1, max_size=2, unique=True))
        put = sum(draw(st.sampled_from(VALUES[i])) for i in changed)
        keep = 0b111111 & ~sum(FIELDS[i] for i in changed)
        cost = draw(st.sampled_from([0, 1, 1, 2]))
        return Arc(condition(), keep, put, (cost << ACTIONS_BITS) + draw(st.integers(1, 2)))

    return [arc() for _ in range(draw(st.integers(1, 8)))], condition()


@given(system=systems(), start=st.tuples(*map(st.sampled_from, VALUES)).map(sum), limit=st.integers(0, 6))
def test_ball_knows_the_distance_of_every_state_in_reach(
    system: tuple[list[Arc], PackedGoal], start: int, limit: int
) -> None:
    arcs, goal = system
    known = Closure(arcs, goal, dict(zip(FIELDS, VALUES, strict=True)), 1000, Deadline())
    ball = ball_around(arcs, goal, dict(zip(FIELDS, VALUES, strict=True)), start, Deadline())
    pending, seen = [start], {start}
    while pending:
        state = pending.pop()
        distance = known.key(state)
        rough = ball.key(state, limit << ACTIONS_BITS)
        assert (
            rough == distance
            if distance < limit << ACTIONS_BITS
            else limit << ACTIONS_BITS <= rough <= distance
        )
        assert ball.key(state, INFINITE_KEY) == distance
        for arc in arcs:
            after = state & arc.keep | arc.put
            if arc.condition.holds(state) and after not in seen:
                seen.add(after)
                pending.append(after)
