"""What a local human sees by default: what is where they are (semantics 6)."""

import serendipity
from serendipity.model import Task, surroundings
from serendipity_testing.builders import task


def _named(built: Task, *names: str) -> frozenset[int]:
    return frozenset(built.facts.index(name) for name in names)


def _visible(built: Task, state: frozenset[int]) -> set[str]:
    see = surroundings(built).visible
    return {name for fact, name in enumerate(built.facts) if see(built.human, fact, state)}


def test_in_a_pddl_task_he_sees_his_room_and_all_about_who_and_what_is_there() -> None:
    building = serendipity.example("room2")
    state = _named(building, "at commx hall4", "at robot hall4", "has robot mk2", "at mk1 room2")
    seen = _visible(building, state)
    assert {"at commx hall4", "at mk1 hall4", "at mk2 hall4", "loc_has_medkit hall4"} <= seen
    assert {"has robot mk2", "has_medkit robot", "at robot room3"} <= seen
    assert "at mk1 room2" not in seen
    assert "loc_has_medkit room2" not in seen


def test_elsewhere_he_does_not_see_the_robot() -> None:
    building = serendipity.example("room2")
    seen = _visible(building, _named(building, "at commx hall4", "at robot room3", "at mk2 room3"))
    assert "has robot mk2" not in seen
    assert "at mk2 room3" not in seen


def test_names_of_ground_files_are_taken_apart() -> None:
    built = task(
        init="at_h_a at_r_a at_k_b",
        goal="at_h_b",
        actions={
            "go h a b": "at_h_a -> at_h_b !at_h_a",
            "go h b a": "at_h_b -> at_h_a !at_h_b",
            "go r a b": "at_r_a -> at_r_b !at_r_a",
            "go r b a": "at_r_b -> at_r_a !at_r_b",
            "take r k": "at_r_b at_k_b -> has_r_k !at_k_b",
            "drop r k": "at_r_b has_r_k -> at_k_b !has_r_k",
        },
    )
    together = _visible(built, _named(built, "at_h_a", "at_r_a", "at_k_b"))
    assert together == {"at_h_a", "at_h_b", "at_r_a", "at_r_b", "has_r_k"}
    apart = _visible(built, _named(built, "at_h_a", "at_r_b", "at_k_b"))
    assert apart == {"at_h_a", "at_h_b", "at_r_a"}


def test_where_there_are_no_places_everything_is_visible() -> None:
    built = task(init="p", goal="q", actions={"do h": "p -> q !p", "undo r": "q -> p !q"})
    assert _visible(built, built.init) == {"p", "q"}
