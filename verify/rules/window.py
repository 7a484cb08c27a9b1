"""Rules on windows, prefix and suffix (semantics 3.1, 3.3, 3.4)."""

from collections.abc import Iterable
from itertools import takewhile

from serendipity.model import Window
from verify.base.due import turns
from verify.base.execution import facts_of_his, states_of_pi_h
from verify.rules.case import CheckedResult, RuleFault


def window_presence(case: CheckedResult) -> RuleFault | None:
    """Only windowed modes have windows; an opportunity there needs one, no opportunity has none."""
    result = case.result
    if not result.options.windowed:
        return None if result.window is None else RuleFault(f"mode {result.mode} has no windows")
    if result.opportunity and result.window is None and result.plan is not None:
        return RuleFault("an opportunity without a window")
    if not result.opportunity and result.window is not None:
        return RuleFault("a window without an opportunity")
    return None


def idle_answer(case: CheckedResult) -> RuleFault | None:
    """Without an opportunity the human executes ``pi_H``; robots idle, or pursue ``G_R`` without the human.

    Modes without windows answer with their optimum, whether it is an opportunity or not.
    """
    result = case.result
    if result.opportunity or result.plan is None or not result.options.windowed:
        return None
    words, steps = "robots idle where there is no opportunity", () if case.robots_goal else case.steps()
    found = case.first(steps, lambda i: not case.own(i), words)
    return found or _follows(case, last=max((*case.replay.sets, len(case.pi_h))))


def window_range(case: CheckedResult, window: Window) -> RuleFault | None:
    """``1 <= xi1 <= |pi_H|`` and ``xi1 < xi2 <= T + 1``."""
    if window.start > len(case.pi_h):
        return RuleFault(f"the window starts at {window.start}, after pi_H with its {len(case.pi_h)} actions")
    if case.epochs is not None and window.end > case.epochs + 1:
        return RuleFault(f"the window ends at {window.end}, later than T + 1 = {case.epochs + 1}")
    return None


def window_length(case: CheckedResult, window: Window) -> RuleFault | None:
    """No window is longer than ``max_window``."""
    most = case.result.options.max_window
    if most is None or len(window) <= most:
        return None
    return RuleFault(f"the window has {len(window)} epochs, max_window is {most}")


def prefix(case: CheckedResult, window: Window) -> RuleFault | None:
    """Before ``xi1`` the human follows ``pi_H`` (Def. 3.0), or does its actions (second 7b)."""
    if not case.result.options.keep_prefix:
        return _follows(case, last=window.start - 1)
    words = "before the window the human does actions of pi_H only"
    return case.first(_between(case, 1, window.start), lambda i: case.own(i) and not case.planned(i), words)


def joint_in_prefix(case: CheckedResult, window: Window) -> RuleFault | None:
    """Before ``xi1`` there is no joint action with the human."""
    words = f"a joint action with the human before xi1 = {window.start}"
    return case.first(_between(case, 1, window.start), lambda i: case.his(i) and not case.own(i), words)


def robot_in_suffix(case: CheckedResult, window: Window) -> RuleFault | None:
    """From ``xi2`` on no robot takes part in any action (eq. 8)."""
    words = f"a robot acts although the window ended at {window.end}"
    return case.first(_between(case, window.end, None), lambda i: not case.own(i), words)


def suffix_replan(case: CheckedResult, window: Window) -> RuleFault | None:
    """Def. 2.0a: the human goes on with an optimal plan of their own, and waits only after its end."""
    options = case.result.options
    if options.suffix != "replan" or options.preservation != "kernel":
        return None
    rest = list(_between(case, window.end, None))
    for expected, (epoch, i) in enumerate(() if case.task.of_bystanders else rest, start=window.end):
        if epoch != expected:
            return RuleFault(f"the human waits in epoch {expected} before all is done", epoch, case.name(i))
    optimum = case.alone.optimum(case.replay.state_after(window.end - 1))
    done = (sum(case.task.actions[i].cost for _, i in rest), _ended(case, rest, window) - window.end + 1)
    if optimum is None or done <= optimum:
        return None
    return RuleFault(
        f"from epoch {window.end} the human spends {float(done[0]):g} in {done[1]} actions; "
        f"alone it takes {float(optimum[0]):g} in {optimum[1]}",
        window.end,
    )


def _ended(case: CheckedResult, rest: list[tuple[int, int]], window: Window) -> int:
    """The epoch with which the human's part is over: their last action's, or that which brings the goal."""
    before = window.end - 1
    last = rest[-1][0] if rest else before
    later = (t for t in sorted({before, *case.replay.states}) if t >= last)
    return next((t for t in later if case.task.goal.holds(case.replay.state_after(t))), last)


def suffix_subplan(case: CheckedResult, window: Window) -> RuleFault | None:
    """Def. 2.0, eq. 9: the suffix is a subsequence of ``pi_H``."""
    options, rest = case.result.options, _between(case, window.end, None)
    if options.suffix != "subplan" or options.preservation != "kernel":
        return None
    planned, begun = iter(case.pi_h), {i for _, i in case.task.due} | case.waiting
    # looking for an action consumes the iterator: order and repetition count
    return case.first(rest, lambda i: i not in begun and i not in planned, "not a subsequence of pi_H")


def preserved_state(case: CheckedResult, window: Window) -> RuleFault | None:
    """Def. 3.1 read literally: the state entails ``delta(I, pi_H[1..j])``, then ``pi_H[j+1..]``."""
    if case.result.options.preservation != "state":
        return None
    task, end, deadline = case.task, window.end, case.alone.deadline
    rest = tuple(i for _, i in _between(case, end, None))
    begun = {i for _, i in task.due}
    going_on = len(list(takewhile(begun.__contains__, rest)))
    end += going_on
    done = _acts(case, rest[going_on:])  # in whichever variant
    ends = [k for k in turns(task, case.pi_h, window.start) if _acts(case, case.pi_h[k:]) == done]
    if not ends:
        return RuleFault(f"from epoch {end} the human does not do an end of pi_H", end)
    mentioned = facts_of_his(task, deadline)
    expected = states_of_pi_h(task, case.pi_h[: ends[0]], deadline)[-1] & mentioned
    missing = expected - case.replay.state_after(end - 1)
    if not missing:
        return None
    fact = task.facts[min(missing)]
    return RuleFault(f"the state before epoch {end} lacks '{fact}', true after pi_H[1..{ends[0]}]", end)


def _acts(case: CheckedResult, plan: Iterable[int]) -> list[str]:
    return [case.name(i) for i in plan if i not in case.waiting]


def _follows(case: CheckedResult, *, last: int) -> RuleFault | None:
    """Whether the human executes exactly ``pi_H[t]`` in each epoch up to ``last``."""
    does = case.human_does()
    for epoch in case.alone.deadline.each(range(1, last + 1)):
        planned = case.pi_h[epoch - 1] if epoch <= len(case.pi_h) else None
        planned = None if planned in case.waiting else planned
        done = does.get(epoch)
        if done is not None and not case.own(done):
            continue  # the rule on joint actions names it
        if done != planned:
            expected = "nothing" if planned is None else f"'{case.name(planned)}'"
            did = "noop" if done is None else case.name(done)
            return RuleFault(f"the human should do {expected}", epoch, did)
    return None


def _between(case: CheckedResult, start: int, end: int | None) -> Iterable[tuple[int, int]]:
    """(epoch, action) from ``start`` on, before ``end``."""
    return ((t, i) for t, i in case.steps() if t >= start and (end is None or t < end))
