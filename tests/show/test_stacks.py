"""Where nobody goes anywhere, what stands on what is shown as towers, and agents above them."""

from itertools import permutations

import pytest

import serendipity
from serendipity.model import Task
from serendipity.pictures.map.places import find_places
from serendipity.pictures.scene.building import build_scene
from serendipity.testing.builders import task as build
from tests.show.drawn import Drawn, drawn_tokens

NAMES = [("ontable", "on", "clear", "holding"), ("grounded", "above", "free", "grips")]
GROUNDS = ["table", "grounded"]


def _task(words: tuple[str, str, str, str], blocks: str = "abcdef") -> Task:
    ground, on, clear, holding = words
    actions = {}
    for who in ("h", "r"):
        for x in blocks:
            held = f"empty_{who} -> {holding}_{who}_{x} !empty_{who} !{clear}_{x}"
            down = f"!{holding}_{who}_{x} empty_{who} {clear}_{x}"
            actions[f"lift {who} {x}"] = f"{clear}_{x} {ground}_{x} {held} !{ground}_{x}"
            actions[f"drop {who} {x}"] = f"{holding}_{who}_{x} -> {down} {ground}_{x}"
            for y in blocks:
                if x != y:
                    on_it = f"{on}_{x}_{y}"
                    actions[f"take {who} {x} {y}"] = f"{clear}_{x} {on_it} {held} !{on_it} {clear}_{y}"
                    put = f"{holding}_{who}_{x} {clear}_{y} -> {down} {on_it} !{clear}_{y}"
                    actions[f"put {who} {x} {y}"] = put
    init = f"{on}_a_b {on}_b_c {on}_d_e {clear}_a {clear}_d {clear}_f {ground}_c {ground}_e {ground}_f"
    return build(init=f"empty_h empty_r {init}", goal=f"{on}_c_d", actions=actions)


@pytest.mark.parametrize(("words", "table"), [*zip(NAMES, GROUNDS, strict=True)])
def test_who_is_on_whom_is_read_whatever_it_is_called(words: tuple[str, str, str, str], table: str) -> None:
    task = _task(words)
    places = find_places(task)
    assert places.names == (table,) and places.towers
    told = {
        (name, where.place, where.carrier, where.holder)
        for name, of in places.objects.items()
        for fact, where in of.items()
        if fact in task.init
    }
    assert told == {
        *(("a", None, "b", None), ("b", None, "c", None), ("d", None, "e", None)),
        *(("c", table, None, None), ("e", table, None, None), ("f", table, None, None)),
    }


def test_towers_stand_and_nothing_overlaps_or_is_cut() -> None:
    task = _task(NAMES[0])
    scene = build_scene(task, serendipity.plan(task, mode="composite", discount="0.9", horizon="inf"))
    for frame in scene.frames:
        sheet, tokens = drawn_tokens(scene, frame.epoch)
        things = {key: drawn for key, drawn in tokens.items() if not key.startswith("frame-")}
        assert len(things) == 8, "six blocks and two agents, and none is only counted"
        for drawn in tokens.values():
            assert sheet.encloses(drawn)
        for one, other in permutations(things.values(), 2):
            assert not one.overlaps(other)
    _, tokens = drawn_tokens(scene, 0)
    a, b, c, d, e, f = (_of(tokens, name) for name in "abcdef")
    assert a.bottom <= b.top and b.bottom <= c.top and d.bottom <= e.top
    assert c.bottom == e.bottom == f.bottom and a.left == b.left == c.left
    assert max(_of(tokens, agent).bottom for agent in "hr") < a.top


def _of(tokens: dict[str, Drawn], name: str) -> Drawn:
    return next(drawn for drawn in tokens.values() if drawn.title.split()[:1] == [name])
