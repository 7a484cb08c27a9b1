"""What is kept for states is forgotten when it is too much."""

from search.packed.state_cache import StateCache


def test_no_more_than_so_many_entries_are_held() -> None:
    cache: StateCache[list[int]] = StateCache(10)
    for state in range(100):
        cache.keep(state, [state] * 3, 3)
        assert cache[state] == [state] * 3
        assert sum(map(len, cache.values())) <= 10
    assert len(cache) == 1


def test_what_is_larger_than_all_that_may_be_held_is_held_alone() -> None:
    cache: StateCache[str] = StateCache(10)
    cache.keep(1, "little", 1)
    cache.keep(2, "much", 100)
    cache.keep(3, "little", 1)
    assert cache == {3: "little"}
