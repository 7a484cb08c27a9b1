"""Explanations in words: for each topic some sentences, each of a fact found by planning."""

from collections.abc import Iterator
from fractions import Fraction
from itertools import groupby
from typing import Final

from serendipity.explanation.ask import Threshold
from serendipity.explanation.explanation import RULES, WHY, Explanation, Miss, Moment
from serendipity.explanation.person_wording import contrasted, moved, turned
from serendipity.explanation.telling_time import begin, end
from serendipity.explanation.waiting import Wait
from serendipity.model import Result, Window
from serendipity.model.errors import limit_words
from serendipity.model.numbers import as_written, plain

_MISSING: Final = {
    "moment": "why the window starts when it does",
    "discount": "from which discount on help pays",
    "window_weight": "up to which window weight a longer interruption would help",
    "announcement": "what a word in advance would gain",
    "head_start": "what help is worth without the head start",
    "person": "what the human makes of it",
    "contrast": "what hinges on each action of robots'",
    "miss": "what would help if a rule were relaxed",
}
"""What would have been told of what is left out."""

_SIGHT: Final = {"observant": "sees everything", "local": "sees what is near"}

Sentence = tuple[str, str]
"""A topic and a sentence."""


def sentences(found: Explanation) -> Iterator[Sentence]:
    """Topic by topic: the help, its moment, its price, the announcement, what misses."""
    answer = found.answer
    if answer.human_plan is None:
        yield "help", f"{answer.human} can't reach the goal alone, so there is no plan to make cheaper."
        if answer.cost is not None:
            yield "help", f"Together they can: for {plain(answer.cost)}."
        return
    yield from (("help", text) for text in (_help(found) if answer.opportunity else _no_help(answer)))
    if answer.saving_alone:
        yield "help", f"{answer.human} could save {plain(answer.saving_alone)} without any robot."
    for topic, part in (
        ("person", turned(found)),
        ("without", contrasted(found)),
        ("waiting", _waiting(found)),
        ("moment", moved(found)),
        ("moment", _moments(found)),
        ("discount", _discount(found)),
        ("announcement", _announcement(found)),
        ("miss", _misses(found)),
    ):
        for text in part:
            yield topic, text
    if found.limit is None:
        return
    missing = "; ".join(_MISSING[topic] for topic in found.left_out)
    rest = f" Left out: {missing}." if missing else ""
    yield "limit", f"This is not all: {limit_words(found.limit)}.{rest}"


def _help(found: Explanation) -> Iterator[str]:
    answer, gone, parts = found.answer, found.removal, found.parts
    assert gone is not None
    assert parts is not None
    if gone.removed:
        single = gone.first == gone.last
        steps = f"step {gone.first} disappears" if single else f"steps {gone.first} to {gone.last} disappear"
        yield f"Of the plan of {answer.human}, {steps}: {'; '.join(gone.removed)}."
    if gone.replacement:
        yield f"Instead: {'; '.join(gone.replacement)}."
    elif gone.removed:
        yield "Nothing has to take their place."
    theirs = [step for step in answer.plan or () if answer.human not in step.agents]
    if theirs:
        deeds = (f"{step.action} ({begin(found.epoch, step.epoch)})" for step in theirs)
        yield f"Robots do: {'; '.join(deeds)}."
    yield (
        f"{answer.human} pays {plain(parts.human)} instead of {plain(answer.human_cost or 0)}; "
        f"the robots' work costs {plain(parts.discounted(answer.options))}; "
        f"{f'what is left changed costs {plain(parts.left)}; ' if parts.left else ''}"
        f"together {plain(answer.cost or 0)}, {plain(answer.saving or 0)} less."
    )
    if answer.status == "feasible":
        yield "It is the best plan found so far, and not proved to be the best there is."
    untold = answer.mode == "serendipity" and answer.options.human_model == "omniscient"
    if untold and answer.realised.get("observant") is False:
        yield (
            f"But {answer.human} is not told, and would not do all of this going by what is to be seen "
            "(`simulate` plays what happens)."
        )


def _no_help(answer: Result) -> Iterator[str]:
    if answer.status == "feasible":
        yield "No help was found so far; that there is none is not proved."
    elif answer.human_plan == ():
        yield f"The goal of {answer.human} holds already, so there is nothing to help with."
    elif answer.options.human_model != "omniscient":
        who, sees = answer.human, _SIGHT[answer.options.human_model]
        yield (
            f"No help: nothing that robots could do beside {who}, who {sees} and is not told, "
            f"costs less than the {plain(answer.human_cost or 0)} that {who} pays alone."
        )
    else:
        yield (
            f"No help: nothing that follows the rules of mode {answer.mode} costs less than the "
            f"{plain(answer.human_cost or 0)} that {answer.human} pays alone."
        )


def _waiting(found: Explanation) -> Iterator[str]:
    for wait in found.waits:
        begins = f"'{wait.action}' begins in {begin(found.epoch, wait.epoch)}, and no sooner"
        yield f"{' and '.join(wait.agents)}: {begins}: {_until(found, wait)}."
    if found.at_once is not None:
        now, then = found.answer.saving, found.at_once.saving if found.at_once.opportunity else 0
        instead = "as much" if now == then else f"{plain(then)} instead of {plain(now)}"
        yield f"Without the head start help would save {instead}."


def _until(found: Explanation, wait: Wait) -> str:
    until = end(found.epoch, wait.until or 0)
    if wait.why == "fact":
        fact = (wait.cause or "").removeprefix("!")
        return f"{fact} becomes {'true' if fact == wait.cause else 'false'} at {until}"
    if wait.why == "bystander":
        return f"'{wait.cause}' is over at {until}"
    return f"the head start is over at {until}" if wait.why == "head-start" else "the plan has it so"


def _moments(found: Explanation) -> Iterator[str]:
    for _, group in groupby(found.moments, key=lambda moment: (moment.why, moment.cost, moment.saving)):
        several = list(group)
        first, last = several[0], several[-1]
        starts = f"epoch {first.start}" if len(several) == 1 else f"epochs {first.start} to {last.start}"
        yield f"Starting in {starts}: {_why(found, last)}."


def _why(found: Explanation, moment: Moment) -> str:
    words = WHY[moment.why]
    saved = plain(moment.saving or 0)
    if moment.why == "saves-less":
        return f"it {words}: {plain(moment.cost or 0)} for the team"
    if moment.why == "not-in-time":
        assert moment.instead is not None
        needed = f"the window would have to be {_window(moment.instead)}"
        return f"{words}; to save {saved} from epoch {moment.start} on, {needed}"
    if moment.why == "costs-more":
        return f"help {words}: {found.answer.human} would save {saved}, the team nothing"
    return f"it {words}" if moment.why == "as-good" else words


def _discount(found: Explanation) -> Iterator[str]:
    threshold = found.discount
    if threshold is None:
        return
    if threshold.value is None:
        yield "At no discount does help pay, not even if robots are free."
    elif threshold.value == 0 and threshold.included:
        yield "Help pays at every discount, even if robots cost as much as the human."
    else:
        value = exact(threshold.value)
        where = f"from a discount of {value} on" if threshold.included else f"above a discount of {value}"
        yield f"Help pays {where} ({_confirmed(threshold)})."


def _confirmed(threshold: Threshold) -> str:
    calls = (
        f"at {plain(c.value)} {plain(c.cost or 0) if c.opportunity else 'none'}" for c in threshold.confirmed
    )
    return "planned: " + ", ".join(calls)


def _announcement(found: Explanation) -> Iterator[str]:
    told, answer = found.announcement, found.answer
    if told is None or told.cost is None or answer.cost is None:
        return
    gain = as_written(answer.cost) - as_written(told.cost)
    if gain > 0:
        yield (
            f"One sentence in advance would gain {plain(gain)}: {plain(told.cost)} instead of "
            f"{plain(answer.cost)}."
        )
    else:
        yield f"Telling {answer.human} in advance would gain nothing: also then it is {plain(told.cost)}."


def _misses(found: Explanation) -> Iterator[str]:
    if found.misses:
        first, *others = found.misses
        yield from _cheapest_miss(found, first)
        for miss in others:
            same = "The same cost is" if miss.cost == first.cost else f"A cost of {plain(miss.cost)} is"
            yield f"{same} found by {RULES[miss.rule]}."
    weight = found.window_weight
    if weight is not None and weight.value is not None:
        yield (
            f"A longer interruption would help at a window weight up to {exact(weight.value)}, "
            f"against the {plain(found.answer.options.window_weight)} in force ({_confirmed(weight)})."
        )
    looked = "miss" not in found.left_out
    if looked and not found.misses and not found.answer.opportunity and found.discount is not None:
        yield "No rule stands in the way: within these epochs and at this discount no plan is cheaper."


def _cheapest_miss(found: Explanation, miss: Miss) -> Iterator[str]:
    yield f"The cheapest plan that misses costs {plain(miss.cost)}, {plain(miss.saving)} less."
    gone = miss.removal
    if gone.removed or gone.replacement:
        removed, instead = ("; ".join(names) or "nothing" for names in (gone.removed, gone.replacement))
        yield f"In it, {found.answer.human} leaves out {removed}, and does instead: {instead}."
    if miss.window is not None and len(miss.window) > 1:
        start = miss.window.start
        yield (
            f"It breaks the rule of the prefix, or needs {len(miss.window)} epochs of interruption: "
            f"{found.answer.human} would have to leave the plan in epoch {start}, and robots are busy until "
            f"epoch {miss.window.end - 1} (window {_window(miss.window)})."
        )
    yield f"It is found by {RULES[miss.rule]}."
    if miss.departs is not None:
        yield f"But beside {found.answer.human} it would not come to that: {miss.departs}."


def _window(window: Window) -> str:
    return f"[{window.start}, {window.end})"


def exact(value: Fraction) -> str:
    """A rational, exact: as a decimal where it has a short one."""
    shown = plain(value)
    return shown if Fraction(shown) == value else f"{value} (about {float(value):.4g})"
