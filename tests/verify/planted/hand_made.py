"""Calls that random ones seldom hit: each turns on one rule or one bound."""

from collections.abc import Iterator

from serendipity_testing.builders import task as build
from serendipity_testing.cases import case_1, case_4
from serendipity_testing.generator.calls import PlanCall


def hand_made() -> Iterator[PlanCall]:
    """All of them, with tasks made afresh."""
    yield from _epochs()
    yield from _conditions()
    yield from _horizons()
    yield from _suffixes()
    yield from _goals()
    yield from _limits()
    yield from _provisions()
    yield from _walks()


def _epochs() -> Iterator[PlanCall]:
    """What two actions of one epoch do to each other."""
    both_delete = {"use h": "p -> a !p", "other h": "-> b @ 3", "take r": "p -> b !p"}
    circle = {"use h": "p q -> a !q", "other h": "-> b @ 3", "take r": "p q -> b !p"}
    negated = {"use h": "!x -> a y", "other h": "-> b @ 3", "take r": "!y -> b x"}
    for actions in (both_delete, circle, negated):
        for options in (
            {"mode": "composite"},
            {"mode": "composite", "horizon": "inf"},
            {"mode": "composite", "interference": "strict"},
            {"mode": "serendipity", "window_weight": "0"},
        ):
            yield PlanCall(build(init="p q", goal="a b", actions=actions), options)
    pursued = build(init="p q", goal="a b", robot_goal="b", actions=circle)
    yield PlanCall(pursued, {"mode": "composite", "horizon": "inf"})
    at_once = {"do h": "-> a b @ 9", "help r": "-> a", "lift h r": "-> b"}
    yield PlanCall(build(goal="a b", actions=at_once), {"mode": "composite", "horizon": "inf"})
    two_robots = {"go h": "-> g @ 5", "end h": "x y -> g", "one r": "-> x", "two s": "-> y"}
    for options in ({"horizon": "2"}, {"horizon": "2", "mode": "composite"}):
        yield PlanCall(build(agents="h r s", goal="g", actions=two_robots), options)


def _conditions() -> Iterator[PlanCall]:
    """Negative literals on a value of a variable."""
    walks = {"walk h": "at0 -> at1 !at0", "back h": "at1 -> at0 !at1"}
    press = {"press r": "!at0 -> d", "do h": "-> d @ 5"}
    yield PlanCall(build(init="at0", goal="at0 d", actions={**walks, **press}), {"mode": "composite"})
    yield PlanCall(build(init="at0", goal="!at0", actions=walks), {"mode": "composite"})
    spoilt = {
        "one h": "!a -> a",
        "two h": "p a -> c",
        "three h": "c -> d",
        "four h": "d -> b @ 5",
        "spoil r": "!a -> b !p @ 0",
    }
    yield PlanCall(build(init="p", goal="d b", actions=spoilt), {})
    variants = {"step h": "!x -> a | x -> b", "end h": "-> g @ 5", "help r": "b -> g", "also r": "a -> g"}
    yield PlanCall(build(init="x", goal="g", actions=variants), {}, ("step h", "end h"))


def _horizons() -> Iterator[PlanCall]:
    """The cheaper way is longer than the horizon."""
    actions = {"do h": "-> g @ 5", "open r": "-> o", "first h": "o -> m", "then h": "m -> g"}
    for mode in ("serendipity", "communication", "composite"):
        for horizon in ("2", "3"):
            yield PlanCall(build(goal="g", actions=actions), {"mode": mode, "horizon": horizon})
    two_ways = {
        "do h": "-> g @ 5",
        "open r": "-> o",
        "first h": "o -> m",
        "then h": "m -> g",
        "direct h": "o -> g @ 3",
    }
    yield PlanCall(build(goal="g", actions=two_ways), {"horizon": "2"})
    shared = {
        "one h": "-> a @ 5",
        "two h": "a -> b",
        "three h": "b -> c",
        "bring r": "-> x",
        "put r": "x -> a",
        "never r": "z -> b",
    }
    yield PlanCall(build(goal="c", actions=shared), {"suffix": "subplan", "window_weight": "0"})


def _suffixes() -> Iterator[PlanCall]:
    actions = {"one h": "a -> b @ 2", "two h": "b -> c @ 2", "three h": "c -> d @ 2", "skip r": "-> c"}
    for options in ({"preservation": "state"}, {"suffix": "subplan"}, {}):
        yield PlanCall(build(init="a", goal="d", actions=actions), options)
    new = {"do h": "-> g @ 9", "open r": "-> o", "quick h": "o -> g @ 2"}
    told = {"mode": "communication", "communication_weight": "1", "keep_prefix": "true", "horizon": "2"}
    yield PlanCall(build(goal="g", actions=new), told)
    # Alone, a human who replans takes the first of two ways into the middle.
    ways = {"far h": "-> m @ 9", "end h": "m -> g", "a h": "-> n", "b h": "-> n", "c h": "n -> g @ 8"}
    ways |= {"open r": "-> o", "quick h": "n o -> g"}
    yield PlanCall(build(goal="g", actions=ways), {"human_model": "observant"}, ("far h", "end h"))


def _goals() -> Iterator[PlanCall]:
    """Robots that want something themselves."""
    actions = {"do h": "-> p @ 5", "then h": "q -> p", "help r": "-> q", "wish r": "-> w"}
    for options in (
        {"horizon": "2", "window_weight": "0"},
        {"horizon": "3", "window_weight": "0"},
        {"horizon": "3", "mode": "communication"},
        {"horizon": "inf", "mode": "composite"},
    ):
        yield PlanCall(build(goal="p", robot_goal="w", actions=actions), options)
    steps = {"one h": "-> a @ 3", "two h": "a -> p", "help r": "-> a", "wish r": "-> w"}
    yield PlanCall(
        build(goal="p", robot_goal="w", actions=steps),
        {"horizon": "3", "suffix": "subplan", "window_weight": "0"},
    )


def _limits() -> Iterator[PlanCall]:
    yield PlanCall(case_1(), {"discount": "0.6", "max_cost": "9.6"})
    yield PlanCall(case_4(), {"discount": "0.9", "max_cost": "6", "mode": "communication"})
    yield PlanCall(case_4(), {"discount": "0.9", "max_cost": "6"})
    prepared = {"own h": "-> g @ 10", "prepare h": "-> p @ 2", "make r": "-> p @ 3", "end r": "p -> g"}
    announced = {"mode": "communication", "communication_weight": "1", "horizon": "2", "max_cost": "3"}
    yield PlanCall(build(goal="g", actions=prepared), announced)
    # The longer window has the higher objective, but only its plan is within max_cost.
    twice = {
        "one h": "a -> b !a @ 3",
        "two h": "b -> c !b @ 3",
        "carry h r": "a -> b !a",
        "pull h r": "b -> c !b",
    }
    yield PlanCall(build(init="a", goal="c", actions=twice), {"max_cost": "3", "window_weight": "3"})
    yield PlanCall(build(init="a", goal="c", actions=twice), {"mode": "communication", "keep_prefix": "true"})
    aside = {
        "go h": "a -> b !a",
        "do h": "b -> done @ 6",
        "aside h": "a -> s !a",
        "quit h": "s open -> done",
        "open r": "-> open",
    }
    options = {"mode": "communication", "keep_prefix": "true", "suffix": "subplan", "discount": "0.5"}
    yield PlanCall(build(init="a", goal="done", actions=aside), options)
    # Dear and short against cheap and long: the limit on the window keeps the first.
    either = {
        "do h": "-> g @ 9",
        "wait h": "-> k",
        "end h": "x -> g",
        "fast r": "-> x @ 6",
        "slow r": "-> y",
        "slower r": "y -> x",
    }
    for longest in ("1", "2", "3"):
        options = {"horizon": "4", "max_window": longest, "window_weight": "1"}
        yield PlanCall(build(goal="g", actions=either), options)
    # To x there is a cheap way that leaves pi_H at once, and a dear one whose window starts later:
    # the limit on the window leaves time for the two joint actions after the dear one only.
    late = {
        "one h": "a -> b !a",
        "two h": "b -> g @ 20",
        "cheap h": "a -> c !a",
        "on h": "c -> x !c",
        "dear h": "b -> x !b @ 3",
        "pull h r": "x -> y !x",
        "push h r": "y -> g",
    }
    options = {"horizon": "4", "max_window": "3", "window_weight": "0"}
    yield PlanCall(build(init="a", goal="g", actions=late), options)


def _provisions() -> Iterator[PlanCall]:
    """What robots pass on to each other, and what the human sets going."""
    relay = {"do h": "-> g @ 9", "use h": "k2 -> g", "carry s": "k0 -> k1 !k0", "bring r": "k1 -> k2 !k1"}
    for horizon in ("3", "4"):
        yield PlanCall(
            build(agents="h r s", init="k0", goal="g", actions=relay),
            {"horizon": horizon, "window_weight": "0"},
        )
    walking = {
        "do h": "-> g @ 9",
        "use h": "k2 -> g",
        "go s": "s0 -> s1 !s0",
        "walk r": "r0 -> r1 !r0",
        "carry s": "k0 s1 -> k1 !k0",
        "bring r": "k1 r1 -> k2 !k1",
    }
    yield PlanCall(
        build(agents="h r s", init="k0 s0 r0", goal="g", actions=walking),
        {"horizon": "5", "window_weight": "0"},
    )
    yield PlanCall(
        build(agents="h r s", init="k0 s0 r0", goal="g", actions=walking),
        {"horizon": "5", "mode": "communication"},
    )
    flipped = {
        "one h": "v0 b -> v1 a !v0 !b",
        "do h": "a -> g @ 5",
        "use h": "v2 a -> g",
        "turn r": "v1 -> v2 !v1",
    }
    for horizon in ("2", "3", "4"):
        yield PlanCall(build(init="v0 b", goal="g", actions=flipped), {"horizon": horizon})
    # What the second joint action needs is too dear for the robot, and comes with the first.
    twice = {"do h": "a -> g @ 9", "lift h r": "a -> b f !a", "use h r": "b f -> g", "fetch r": "-> f @ 50"}
    for mode in ("serendipity", "communication"):
        options = {"mode": mode, "horizon": "2", "window_weight": "0"}
        yield PlanCall(build(init="a", goal="g", actions=twice), options)


def _walks() -> Iterator[PlanCall]:
    """Robots that are busy can't walk: what is dear now leaves time for what is cheap later."""
    actions = {
        "one h": "h0 -> h1 !h0",
        "two h": "h1 -> h2 m !h1",
        "three h": "h2 -> h3 !h2",
        "long h": "h3 -> g @ 20",
        "jump h": "h3 y -> g",
        "go01 r": "r0 -> r1 !r0",
        "go12 r": "r1 -> r2 !r1",
        "near r": "r0 m -> x !m",
        "far r": "r2 x -> y !x",
        "go01 s": "s0 -> s1 !s0",
        "fetch s": "s0 m -> x !m @ 3",
        "help s": "s1 x -> y !x @ 12",
    }
    for horizon in ("5", "6"):
        task = build(agents="h r s", init="h0 r0 s0", goal="g", actions=actions)
        yield PlanCall(task, {"horizon": horizon})
    # A step of the human's plan, of no use, that wants the robot to be where it is.
    looks = {
        "one h": "h0 -> h1 !h0",
        "look h": "r0 -> z",
        "two h": "h1 -> h2 !h1",
        "long h": "h2 -> g @ 20",
        "jump h": "h2 y -> g",
        "go01 r": "r0 -> r1 !r0",
        "go12 r": "r1 -> r2 !r1",
        "far r": "r2 -> y",
        "go01 s": "s0 -> s1 !s0",
        "help s": "s1 -> y @ 12",
    }
    task = build(agents="h r s", init="h0 r0 s0", goal="g", actions=looks)
    yield PlanCall(task, {}, ("one h", "look h", "two h", "long h"))
