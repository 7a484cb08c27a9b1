"""What people who replan make of help, in words."""

from collections.abc import Iterator
from typing import TYPE_CHECKING

from serendipity.explanation.person import ChangeOfMind, Contrast
from serendipity.explanation.telling_time import begin
from serendipity.model.numbers import plain

if TYPE_CHECKING:
    from serendipity.explanation.explanation import Explanation


def turned(found: "Explanation") -> Iterator[str]:
    """When and why they turn to something else."""
    joined = None
    for turn in () if found.reaction is None else found.reaction.turns:
        when, who = begin(found.epoch, turn.epoch), found.answer.human
        woken = turn.epoch == found.answer.options.head_start + 1 > 1
        after = f"after '{joined}', " if joined is not None and turn.because == (joined,) else ""
        seen = "" if after else _seen(turn)
        yield f"In {when}, {after}{who} {'gets up, ' if woken else ''}{seen}{_turn(turn, who)}."
        joined = turn.action if turn.why == "joins" else None


def contrasted(found: "Explanation") -> Iterator[str]:
    """What would happen without robots, or without one of their actions."""
    reaction = found.reaction
    if reaction is None:
        return
    if reaction.alone is not None:
        yield f"Without any robot, {_consequence(found, reaction.alone)}."
    for one in _contrasts(found, "without"):
        yield f"Without {_actions(found, one)}, {_consequence(found, one)}."


def moved(found: "Explanation") -> Iterator[str]:
    """What may begin no sooner, and no later."""
    for change, rest in (("sooner", "before"), ("later", "after")):
        for one in _contrasts(found, change):
            begun = f"Were {_actions(found, one)}, with all that robots do {rest} it, an epoch {change}"
            yield f"{begun}, {_consequence(found, one)}."
    if _contrasts(found, "without") and not _contrasts(found, "later"):
        yield "Nothing hinges on the very epoch: all that robots do could as well come an epoch later."


def _contrasts(found: "Explanation", change: str) -> list[Contrast]:
    return [one for one in (found.reaction.contrasts if found.reaction else ()) if one.change == change]


def _turn(turn: ChangeOfMind, who: str) -> str:
    if turn.why == "joins":
        alone = (
            "alone there would be no way" if turn.best is None else f"alone it would be {plain(turn.best)}"
        )
        return f"joins in '{turn.action}': with it {who} has {plain(turn.joined)} to pay from here, {alone}"
    if turn.why == "tries":
        return f"tries '{turn.action}' in vain"
    if turn.why == "waits":
        return "has no way from here, and waits"
    if turn.kept is None:
        return f"replans: the plan works no more, the best from here costs {plain(turn.best)}{_gone(turn)}"
    return f"replans: {plain(turn.best)} from here instead of {plain(turn.kept)}{_gone(turn)}"


def _seen(turn: ChangeOfMind) -> str:
    facts, deeds = ", ".join(turn.saw), "; ".join(f"'{name}'" for name in turn.because)
    if facts and deeds:
        return f"finds {facts} (after {deeds}), and "
    if facts:
        return f"finds {facts}, and "
    return f"sees {deeds}, and " if deeds else ""


def _gone(turn: ChangeOfMind) -> str:
    left, instead = "; ".join(turn.removed), "; ".join(turn.replacement)
    if left and instead:
        return f"; left out: {left}; instead: {instead}"
    return f"; left out: {left}" if left else f"; besides: {instead}" if instead else ""


def _actions(found: "Explanation", one: Contrast) -> str:
    named = zip(one.actions, one.epochs, strict=True)
    words = "; ".join(f"'{name}' ({begin(found.epoch, epoch)})" for name, epoch in named)
    return f"any one of {words}" if len(one.actions) > 1 else words


def _consequence(found: "Explanation", one: Contrast) -> str:
    answer = found.answer
    if not one.costs:
        return f"the goal would not be reached by the end of epoch {answer.horizon}"
    least, most = plain(one.costs[0]), plain(one.costs[-1])
    costs = f"{least} to {most}" if least != most else least
    told = plain(answer.cost or 0)
    compared = "as much" if costs == told else f"{costs} instead of {told}"
    return f"{_would(answer.human, one)}it would cost {compared}"


def _would(who: str, one: Contrast) -> str:
    more, less = "; ".join(one.replacement), "; ".join(one.removed)
    if one.as_planned:
        return f"{who} would keep to the former plan, and "
    if more:
        return f"{who} would do {more}{f' instead of {less}' if less else ''}, and "
    return f"{who} would leave out {less}, and " if less else ""
