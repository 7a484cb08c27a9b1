"""Holds every reason in a log against its run: states, plans and, where help is denied, ``plan``."""

from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field, replace
from math import isclose
from typing import Any

import serendipity
from serendipity.model import Condition, Task
from serendipity.model.task.actions import apply, conflicting
from serendipity.model.task.execution import actions_named

Alone = Callable[[frozenset[int]], float | None]
"""What it costs the person to reach the goal alone from a state; None where they can't."""

_GIVE_UP = 3
"""Failures after which robots do not count on an action any more."""


def untrue(task: Task, log: Sequence[dict[str, Any]], alone: Alone, time_limit: float = 60) -> Iterator[str]:
    """What is said in a log and is not so, a line each.

    Args:
        task: what was executed.
        log: of one run, its header first.
        alone: asked for states of the run.
        time_limit: seconds for each question; what is not answered by then is not objected to.
    """
    header, *events = log
    seen = _Seen(task, header, alone, time_limit)
    for event in events:
        if "decision" in event:
            for complaint in seen.complaints(event):
                yield f"epoch {event['epoch']}: {event['decision']['reason']!r}: {complaint}"
        seen.take_in(event)


@dataclass
class _Seen:
    """What has happened in a run up to an epoch."""

    task: Task
    header: dict[str, Any]
    alone: Alone
    time_limit: float
    state: frozenset[int] = frozenset()
    gone: set[str] = field(default_factory=set)
    fails: Counter[tuple[str, ...]] = field(default_factory=Counter)
    running: list[dict[str, Any]] = field(default_factory=list)
    epochs: dict[int, dict[str, Any]] = field(default_factory=dict)
    changed: bool = False
    untouched: frozenset[int] = frozenset()
    epoch: int = 0
    decision: dict[str, Any] = field(default_factory=dict)
    why: dict[str, Any] = field(default_factory=dict)

    def __post_init__(self) -> None:
        self.state = self.untouched = self.task.init
        self.human = self.task.agents[self.task.human]

    def take_in(self, event: dict[str, Any]) -> None:
        """Go on by a line of the log."""
        if "drop" in event:
            self.gone |= set(event["drop"])
            self.running = [s for s in self.running if not set(s["agents"]) & self.gone]
        elif "change" in event:
            names = {name: i for i, name in enumerate(self.task.facts)}
            true = {names[name] for name, holds in event["change"].items() if holds}
            self.state = (self.state - {names[name] for name in event["change"]}) | true
            self.changed = True
            self.untouched = self.state
        else:
            after = self._after(self.state, event["steps"])
            assert after is not None, "what took place was possible"
            his = [step for step in event["steps"] if self.human in step["agents"]]
            joint = any(len(step["agents"]) > 1 for step in his)
            self.untouched = (None if joint else self._after(self.untouched, his)) or after
            self.state = after
            self.epochs[event["epoch"]] = event
            self.running = [s for s in event["unfinished"] if s["why"] == "running"]
            self.fails.update(_key(s) for s in event["unfinished"] if s["why"] == "failed")

    def complaints(self, event: dict[str, Any]) -> Iterator[str]:
        """What is wrong with the decision of an epoch."""
        decision = self.decision = event["decision"]
        why, verdict = decision["because"], decision["verdict"]
        if why is None:
            yield "has no reason"
            return
        self.epoch, self.why = event["epoch"], why
        asks = why["kind"] == "own-goals" and decision["cost"] > decision["alone"]
        acts = bool(decision["actions"] or decision["offers"] or asks)
        if acts != (verdict in ("helps", "works")):
            yield f"robots {'act' if acts else 'do nothing'}, the verdict is {verdict}"
        begun = why["kind"] != "done" and verdict in ("stopped", "aside") and self._begun()
        if (verdict == "stopped") != begun:
            yield f"help had {'' if begun else 'not '}begun, the verdict is {verdict}"
        yield from self._owes()
        check = getattr(self, f"_{why['kind'].replace('-', '_')}")
        yield from check()
        if why["cause"] is not None:
            yield from self._cause()

    # -- help

    def _pays(self) -> Iterator[str]:
        yield from self._plan()
        if self.task.robot_goal:  # then it has to beat what robots need for their own, too
            found = self._asked(self.task, mode="communication")
            if found is not None and not found.opportunity:
                yield "nothing pays"
        elif self.why["cost"] >= self.why["alone"] and not self.why["owed"]:
            yield "does not pay"
        exact = self.header["human_model"] != "local"  # what they believe may be dearer than what is so
        alone = self.alone(self.state)
        if exact and not self.decision["goals"] and (alone is None or not isclose(alone, self.why["alone"])):
            yield f"alone it costs {alone}"

    def _later(self) -> Iterator[str]:
        theirs = [s["epoch"] for s in self.decision["plan"] if s["agents"] != [self.human]]
        if self.why["epoch"] != self.epoch + min(theirs) - 1:
            yield f"their part comes in epoch {self.epoch + min(theirs) - 1}"
        if self.why["alone"] is None:
            yield from self._only_way()
        else:
            yield from self._pays()

    def _owed(self) -> Iterator[str]:
        yield from self._pays()
        his = [step["cost"] for step in self.decision["plan"] if self.human in step["agents"]]
        if sum(his) >= self.why["alone"]:
            yield "nothing is made up for"

    def _owes(self) -> Iterator[str]:
        """What the person pays more is said wherever nothing is done about it."""
        exact = self.header["human_model"] != "local"
        if (
            not exact
            or self.decision["goals"]
            or not (self.why["owed"] or self.decision["verdict"] in ("aside", "stopped"))
        ):
            return
        now, before = self.alone(self.state), self.alone(self.untouched)
        owed = 0 if now is None or before is None else max(now - before, 0)
        if not isclose(owed, self.why["owed"], abs_tol=1e-9):
            yield f"they pay {owed} more"

    def _done(self) -> Iterator[str]:
        yield from self._plan()
        if any(s["agents"] != [self.human] for s in self.decision["plan"]):
            yield "there is something left to do"
        if not self._helped():
            yield "nothing was done"

    def _only_way(self) -> Iterator[str]:
        yield from self._plan()
        if self.alone(self.state) is not None:
            yield "there is a plan alone"

    def _goes_on(self) -> Iterator[str]:
        if self.why["action"] not in [step["action"] for step in self.running]:
            yield "that was not begun"

    def _own_goals(self) -> Iterator[str]:
        if not self.task.robot_goal:
            yield "they have none"

    def _own_goals_lost(self, lost: bool = True) -> Iterator[str]:
        free = {"mode": "composite", "horizon": "inf"}  # of who has nothing to do
        asked = free if self.task.goal.holds(self.state) else {"human_model": self.header["human_model"]}
        found = self._asked(self.task, **asked)
        if found is not None and (found.plan is None) is not lost:
            yield f"they are {'within' if lost else 'out of'} reach"

    def _own_goals_spoil(self) -> Iterator[str]:
        yield from self._own_goals_lost(lost=False)

    def _unsure(self) -> Iterator[str]:
        if sum(share > 0 for share in self.decision["goals"].values()) < 2:
            yield "there is one goal"

    # -- no help

    def _no_help(self) -> Iterator[str]:
        for model in dict.fromkeys((self.header["human_model"], "omniscient")):
            if model != "local" and not self.decision["goals"]:
                found = self._asked(self.task, alone=True, human_model=model)
                if found is not None and found.opportunity:
                    yield f"{found.cost} instead of {found.cost + (found.saving or 0)} for somebody {model}"

    def _spoils(self) -> Iterator[str]:
        yield from self._would(self.header["human_model"])

    def _untold(self) -> Iterator[str]:
        yield from self._would("omniscient")

    def _would(self, model: str) -> Iterator[str]:
        if model == "local" or self.decision["goals"]:
            return
        found = self._asked(self.task, alone=True, human_model=model)
        if found is None:
            return
        cost, saving = found.cost or 0, found.saving or 0
        said = self.why["cost"]  # of the plan that was found in the time
        if not (
            cost <= said + 1e-9 and said < self.why["alone"] and isclose(cost + saving, self.why["alone"])
        ):
            yield f"it would cost {found.cost} and save {found.saving}"

    def _no_safe_help(self) -> Iterator[str]:
        return iter(())

    def _unfound(self) -> Iterator[str]:
        if self.decision["proved"]:
            yield "it is proved that there is nothing"

    def _late(self) -> Iterator[str]:
        if self.decision["plan"] is not None:
            yield "there is a plan"

    def _out_of_order(self) -> Iterator[str]:
        robots = {self.task.agents[i] for i in self.task.robots}
        if not set(self.why["robots"]) == robots == self.gone:
            yield f"out of order are {', '.join(sorted(self.gone))}"

    def _all_failed(self) -> Iterator[str]:
        left = [i for i in self._theirs() if not self.gone.intersection(self._names(i))]
        if not left or any(i not in self._failing() for i in left):
            yield "something has not"

    def _out_of_reach(self) -> Iterator[str]:
        found = self._together()
        if found is not None and found.plan is not None:
            yield "there is a plan"

    def _only_told(self) -> Iterator[str]:
        found = self._together()
        if found is not None and (found.cost is None or found.cost > self.why["cost"] + 1e-9):
            yield f"it would cost {found.cost}"
        if self.alone(self.state) is not None:
            yield "there is a plan alone"

    def _together(self) -> serendipity.Result | None:
        """What everybody could do, robots' own goals apart."""
        free = self.task.with_goal(self.task.goal, Condition())
        return self._asked(free, mode="composite", horizon="inf", failing=False)

    # -- what has come between

    def _cause(self) -> Iterator[str]:
        cause = self.why["cause"]
        event, kind = self.epochs.get(cause["epoch"]), cause["kind"]
        if event is None:
            yield f"epoch {cause['epoch']} is not over"
            return
        took_place = [step["action"] for step in event["steps"]]
        meant = [step["action"] for part in ("actions", "offers") for step in event["decision"][part]]
        if event["decision"]["verdict"] not in ("helps", "waits"):
            yield "there was no help to come between"
        if kind in ("missed", "slow") and (cause["what"] not in meant or cause["what"] in took_place):
            yield f"{cause['what']} was not meant to take place, or did"
        begun = [step["action"] for step in event["unfinished"] if step["why"] == "running"]
        if kind == "slow" and cause["what"] not in begun:
            yield f"{cause['what']} was not begun in epoch {cause['epoch']}, or was over with it"
        if kind == "elsewhere":
            expected = event["decision"]["expected"]
            if event["decision"]["plan"] is None:
                yield "nothing was expected of them"
            if event["human"] == (expected and expected["action"]) and not event["in_vain"]:
                yield "that is what they were expected to do"
        if kind == "out-of-order" and not set(cause["what"].split(", ")) <= self.gone:
            yield f"out of order are {', '.join(sorted(self.gone))}"
        if kind == "changed" and not self.changed:
            yield "nothing has"

    # -- what is known of the run

    def _begun(self) -> bool:
        """Whether robots have done something for help that was not all done before they gave it up."""
        begun = False
        for event in self.epochs.values():
            why, verdict = event["decision"]["because"], event["decision"]["verdict"]
            if why["kind"] == "done":
                begun = False
            elif verdict in ("helps", "waits"):
                begun |= any(step["agents"] != [self.human] for step in event["steps"])
        return begun

    def _helped(self) -> bool:
        return any(s["agents"] != [self.human] for event in self.epochs.values() for s in event["steps"])

    def _plan(self) -> Iterator[str]:
        """The plan leads to the goal from here, and costs what is said."""
        plan, state = self.decision["plan"], self.state
        for epoch in sorted({step["epoch"] for step in plan}):
            after = self._after(state, [step for step in plan if step["epoch"] == epoch])
            if after is None:
                yield f"its epoch {epoch} is not possible"
                return
            state = after
        if not self.decision["goals"] and not self.task.goal.holds(state):
            yield "the plan misses the goal"
        if not isclose(sum(step["cost"] for step in plan), self.why["cost"], abs_tol=1e-9):
            yield "the plan costs something else"

    def _after(self, state: frozenset[int], steps: Sequence[dict[str, Any]]) -> frozenset[int] | None:
        """The state after the steps of an epoch; None where they are not possible together."""
        chosen = []
        for step in steps:
            ids = actions_named(self.task, step["action"], step["agents"])
            action = next((a for a in (self.task.actions[i] for i in ids) if a.applicable(state)), None)
            if action is None or any(conflicting(action, other, strict=False) for other in chosen):
                return None
            chosen.append(action)
        return apply(state, *chosen)

    def _asked(
        self, task: Task, *, alone: bool = False, failing: bool = True, **options: Any
    ) -> serendipity.Result | None:
        """What planning says from here, with those who are at hand; None where it comes to no end."""
        out = self.gone | {agent for step in self.running for agent in step["agents"]}
        barred = {i for i in self._theirs() if out.intersection(self._names(i))}
        barred |= self._failing() if failing else set()
        kept = tuple(a for i, a in enumerate(self.task.actions) if i not in barred)
        smaller = replace(task, actions=kept).at(self.state)
        plan = self.decision["plan"] if alone else None
        his = None if plan is None else [s["action"] for s in plan if s["agents"] == [self.human]]
        found = serendipity.plan(
            smaller, discount=self.header["discount"], human_plan=his, time_limit=self.time_limit, **options
        )
        return found if found.status in ("optimal", "infeasible") else None

    def _theirs(self) -> list[int]:
        actions = enumerate(self.task.actions)
        return [i for i, action in actions if action.participants != (self.task.human,)]

    def _names(self, action: int) -> set[str]:
        return {self.task.agents[i] for i in self.task.actions[action].participants}

    def _failing(self) -> set[int]:
        orders = (key for key, count in self.fails.items() if count >= _GIVE_UP)
        return {i for *agents, action in orders for i in actions_named(self.task, action, agents)}


def _key(step: dict[str, Any]) -> tuple[str, ...]:
    return (*step["agents"], step["action"])
