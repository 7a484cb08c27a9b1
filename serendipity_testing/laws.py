"""Laws that the answers of every exact planner obey (semantics 1 to 3), whatever it is.

A law asks a planner several calls that belong together, and says what does not fit:

    for fault in LAWS["renaming"](call, ask):
        print(fault)

``ask`` gives a planner's answer to a :class:`Call` whose human plan and horizon are filled in: anything with
``cost`` and ``objective`` (None without a plan), as brute force's ``best`` and :func:`serendipity.plan` do.
A law that says nothing about a call asks nothing, or has nothing to say.
"""

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import replace
from fractions import Fraction
from itertools import pairwise
from typing import Any, Final

from serendipity.model import INFINITE, Options
from serendipity_testing.call import Answered, Call
from serendipity_testing.oracle import Alone, Moment
from serendipity_testing.rewriting import doubled, renamed, with_idle_robot, with_split_action

Ask = Callable[[Call], Answered]
"""A planner."""

Amount = Fraction | float | None

Law = Callable[[Call, Ask], Iterator[str]]
"""A relation between answers: gives a line for everything that is not so."""


def discount(call: Call, ask: Ask) -> Iterator[str]:
    """The cheaper robots are, the less (or as much) is the objective."""
    if _plain(call):
        yield from _falling(call, ask, "discount", ("0", "1/3", "2/3", "1"))


def horizon(call: Call, ask: Ask) -> Iterator[str]:
    """More epochs never make the objective greater."""
    last = call.options.horizon
    if _plain(call) and isinstance(last, int):
        longer = [last, last + 1, *([INFINITE] if call.options.mode == "composite" else [])]
        yield from _falling(call, ask, "horizon", longer)


def window_weight(call: Call, ask: Ask) -> Iterator[str]:
    """The dearer an epoch of the window is, the dearer (or as dear) are plan and objective."""
    if not (_plain(call) and call.options.mode == "serendipity"):
        return
    weights = ("0", "1/4", "1", "1000")
    calls = [_but(call, window_weight=weight) for weight in weights]
    answers = [ask(each) for each in calls]
    ranks = [_rank(each, answer) for each, answer in zip(calls, answers, strict=True)]
    costs = [_float(answer.cost) for answer in answers]
    yield from _ordered("objective", "window_weight", weights, ranks)
    yield from _ordered("cost", "window_weight", weights, costs)


def modes(call: Call, ask: Ask) -> Iterator[str]:
    """Composite costs no more than serendipity, which is no dearer with K = 0, and never than being alone."""
    last = call.options.horizon
    if not (_plain(call) and call.human_plan and isinstance(last, int)) or call.task.robot_goal:
        return
    loose = call.options.but(mode="serendipity", max_cost=None, max_window=None, keep_prefix=False)
    alone = loose.but(mode="individual", horizon=None)
    chain: dict[str, Options] = {
        "composite": loose.but(mode="composite"),
        "serendipity with K = 0": loose.but(window_weight=0),
        "serendipity": loose,
        "individual": alone,
    }
    costs = {name: _float(ask(replace(call, options=options)).cost) for name, options in chain.items()}
    yield from _ordered("cost", "mode", tuple(costs), list(costs.values()))


def free_windows(call: Call, ask: Ask) -> Iterator[str]:
    """With K = 0 serendipity costs what composite costs: the window [1, T + 1) fits every plan."""
    last = call.options.horizon
    if not (_plain(call) and call.human_plan and isinstance(last, int)) or call.task.robot_goal:
        return
    if call.options.preservation == "state":
        return
    free = call.options.but(max_cost=None, max_window=None, keep_prefix=False, window_weight=0)
    yield from _same(
        ("composite", ask(replace(call, options=free.but(mode="composite"))).cost),
        ("serendipity with K = 0", ask(replace(call, options=free.but(mode="serendipity"))).cost),
    )


def free_words(call: Call, ask: Ask) -> Iterator[str]:
    """Communication that costs nothing, and keeps no prefix, is composite planning with the same T."""
    if call.options.mode in ("communication", "composite") and call.options.horizon != INFINITE:
        free = call.options.but(communication_weight=0, keep_prefix=False)
        yield from _same(
            ("composite", ask(replace(call, options=free.but(mode="composite"))).cost),
            ("communication", ask(replace(call, options=free.but(mode="communication"))).cost),
        )


def renaming(call: Call, ask: Ask) -> Iterator[str]:
    """Names and numbers of facts, actions and agents carry no meaning."""
    yield from _unchanged("with other names", call, renamed(call), ask)


def idle_robot(call: Call, ask: Ask) -> Iterator[str]:
    """Another robot, which can do nothing that matters, changes nothing."""
    yield from _unchanged("with another robot", call, with_idle_robot(call), ask)


def scale(call: Call, ask: Ask) -> Iterator[str]:
    """In another currency, where everything costs twice as much, so does the answer."""
    one, other = ask(call).objective, ask(doubled(call)).objective
    yield from _same(
        ("the objective, doubled", None if one is None else 2 * one), ("where all is doubled", other)
    )


def split_cost(call: Call, ask: Ask) -> Iterator[str]:
    """An action in two steps that share its cost costs the same, where epochs don't count."""
    endless = call.options.mode == "composite" and call.options.horizon == INFINITE
    if call.options.mode == "individual" or (endless and call.options.max_cost is None):
        parted = with_split_action(call)
        if parted is not None:
            yield from _unchanged("with an action in two steps", call, parted, ask)


JOINT: Final = ("discount", "renaming", "idle robot", "scale", "split cost")
"""Laws that have something to say about the best joint plan without a horizon."""

ASKED_IN: Final[Mapping[str, frozenset[str]]] = {
    "window weight": frozenset({"serendipity"}),
    "modes": frozenset({"composite", "serendipity", "individual"}),
    "free windows": frozenset({"composite", "serendipity"}),
    "free words": frozenset({"composite", "communication"}),
}
"""Laws that ask in certain modes, with these."""

LAWS: Final[Mapping[str, Law]] = {
    "discount": discount,
    "horizon": horizon,
    "window weight": window_weight,
    "modes": modes,
    "free windows": free_windows,
    "free words": free_words,
    "renaming": renaming,
    "idle robot": idle_robot,
    "scale": scale,
    "split cost": split_cost,
}
"""By name."""


def _plain(call: Call) -> bool:
    """Whether doing nothing is one of the plans that are compared: then the objective moves one way only."""
    if call.task.robot_goal and call.options.windowed:
        return False
    worth = Alone(call.task).worth(Moment(call.task.init))
    return call.human_plan is None or (worth is not None and call.task.cost_of(call.human_plan) == worth[0])


def _but(call: Call, **options: Any) -> Call:
    return replace(call, options=call.options.but(**options))


def _rank(call: Call, answer: Answered) -> float | None:
    """The objective, as if doing nothing had a window of one epoch (semantics 3.1)."""
    if answer.objective is None or answer.window is not None or not call.options.windowed:
        return _float(answer.objective)
    return float(answer.objective) + float(call.options.window_weight)


def _falling(call: Call, ask: Ask, option: str, values: Sequence[object]) -> Iterator[str]:
    calls = [_but(call, **{option: value}) for value in values]
    ranks = [_rank(each, ask(each)) for each in calls]
    yield from _ordered("objective", option, values[::-1], ranks[::-1])


def _ordered(
    figure: str, option: str, values: Sequence[object], figures: Sequence[float | None]
) -> Iterator[str]:
    """A figure that never falls; without a plan it is infinite."""
    for (one, less), (other, more) in pairwise(zip(values, figures, strict=True)):
        if _above(less, more):
            yield (
                f"{figure} {_written(less)} with {option} {one}, but {_written(more)} with {option} {other}"
            )


def _unchanged(how: str, call: Call, changed: Call, ask: Ask) -> Iterator[str]:
    one, other = ask(call), ask(changed)
    yield from _same(("the objective", one.objective), (how, other.objective))
    yield from _same(("the cost", one.cost), (how, other.cost))


def _same(one: tuple[str, Amount], other: tuple[str, Amount]) -> Iterator[str]:
    if _above(one[1], other[1]) or _above(other[1], one[1]):
        yield f"{one[0]} is {_written(one[1])}, but {other[0]} it is {_written(other[1])}"


def _above(one: Amount, other: Amount) -> bool:
    """Whether a figure exceeds another by more than rounding; None is infinite."""
    if one is None or other is None:
        return one is None and other is not None
    return float(one) > float(other) + 1e-9 * max(1.0, abs(float(other)))


def _float(amount: Amount) -> float | None:
    return None if amount is None else float(amount)


def _written(amount: Amount) -> str:
    return "infeasible" if amount is None else f"{float(amount):g}"
