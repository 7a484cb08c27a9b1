"""The posterior over the human's goals (semantics 8, after Ramirez and Geffner 2010), and what it is made of.

Files of goals: a JSON list of ``{"name": ..., "goal": [literals], "prior": ...}``, or a goal a line,
``prior: literal, literal`` (without ``prior:`` it is 1).  Files of actions are those of ``--human-plan``
(see :mod:`serendipity.pddl.parsing.lists`).
"""

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import asdict, dataclass, replace
from fractions import Fraction
from os import PathLike
from typing import Any

from search import PreparedTask
from search.modes.goals import Explainer, Likelihood, Prices, Reading
from serendipity.model import Condition, Deadline, InputError, Options, Task, UsageError, exact
from serendipity.model.answers.recognition import Errors, GoalPosterior, Recognition
from serendipity.model.arguments import LIST, TASK_IN_TIME, Kind, expect, expect_or_none
from serendipity.model.numbers import Number, as_written
from serendipity.model.rates import Rates
from serendipity.model.resources.collection import no_collection
from serendipity.model.resources.limits import limits_from
from serendipity.model.task.names import no_fact
from serendipity.model.task.task import canonical_name, several
from serendipity.model.task.whole_actions import in_whole_actions
from serendipity.pddl.parsing.files import read_text
from serendipity.pddl.parsing.lists import FileItem, actions_in, json_items, lines_of, starts_json
from serendipity.recognition.in_time import explained_in_time

GoalsGiven = str | PathLike[str] | Iterable[Mapping[str, Any]]
"""A file of goals, or its JSON form: ``[{"name": ..., "goal": [literals], "prior": ...}]``."""

ObservedGiven = str | PathLike[str] | Iterable[str]
"""A file of actions, or their names."""


@dataclass(frozen=True, slots=True)
class Noise(Rates):
    """How far what was seen can be trusted; each is a probability (semantics 8).

    Attributes:
        miss: that an action that was done is not seen; 0 if that is not known, and gaps weigh nothing.
        wrong: that something that was seen was not done.

    Raises:
        UsageError: one of them is no probability.
    """

    miss: float = 0.0
    wrong: float = 0.0

    def prices(self, beta: float) -> Prices:
        """What plans and errors weigh."""
        wrong = -math.log(self.wrong) if self.wrong else math.inf
        return Prices(beta, wrong, -math.log(self.miss) if self.miss else 0.0)


@dataclass(frozen=True, slots=True)
class CandidateGoal:
    """A goal that the human may have.

    Attributes:
        name: for people.
        literals: its facts, those that have to be false with ``!`` in front.
        goal: the same over the task's fact ids.
        prior: its probability before anything was observed; priors add up to 1.
    """

    name: str
    literals: tuple[str, ...]
    goal: Condition
    prior: Fraction


def candidate_goals(task: Task, given: GoalsGiven) -> tuple[CandidateGoal, ...]:
    """The candidates that a caller names, their priors scaled so that they add up to 1.

    Raises:
        InputError: no goal at all, an unknown fact, a prior that is negative or no number, a name
            twice, or priors that add up to 0; with file and line where there is a file.
    """
    file = given if isinstance(given, str | PathLike) else None
    entries = _entries(given)
    if not entries:
        raise InputError("goals: expected at least one goal, got none", file)
    ids = {fact: i for i, fact in enumerate(task.facts)}
    found = [_candidate(entry, i, ids, file) for i, entry in enumerate(entries, start=1)]
    names: set[str] = set()
    for entry, candidate in zip(entries, found, strict=True):
        if candidate.name in names:
            raise InputError(f"goals: there are two goals named '{candidate.name}'", file, entry.line)
        names.add(candidate.name)
    total = sum((candidate.prior for candidate in found), Fraction(0))
    if not total:
        raise InputError("goals: expected priors with a sum above 0, got only zeros", file)
    return tuple(replace(candidate, prior=candidate.prior / total) for candidate in found)


def observed_actions(task: Task, given: ObservedGiven) -> tuple[str, ...]:
    """The names of the observed actions, in order.

    Raises:
        InputError: one that the human does not have, or can't do alone; with file and line where
            there is a file.
    """
    file = given if isinstance(given, str | PathLike) else None
    names = []
    for step, (name, line) in enumerate(named_actions(given, "observed"), start=1):
        if not name or (name not in task.named and task.waits(name)):
            continue
        where = f"observed action '{name}'" if file is not None else f"observed action {step}, '{name}'"
        if name not in task.named:
            raise InputError(f"{where}: there is no such action in the task", file, line)
        if all(task.actions[i].participants != (task.human,) for i in task.named[name]):
            human = task.agents[task.human]
            raise InputError(f"{where}: expected an action that {human} can do alone", file, line)
        names.append(name)
    return tuple(names)


def named_actions(given: ObservedGiven, what: str) -> list[tuple[str, int | None]]:
    """The names of the actions that a caller lists, each with its line where they are a file's.

    Raises:
        InputError: a file can't be read, or a line of it is not one action.
        UsageError: it is no list of names; the error begins with ``what``.
    """
    if isinstance(given, str | PathLike):
        return [(canonical_name(name), line) for name, line in actions_in(read_text(given), given)]
    return [(canonical_name(name), None) for name in several(given, what)]


def _entries(given: GoalsGiven) -> Sequence[FileItem]:
    """The goals that a caller lists, in the form of JSON objects."""
    if not isinstance(given, str | PathLike):
        expect(Kind("a file, or a list of goals", LIST.fits), goals=given)
        return [FileItem(item, None) for item in given]
    text = read_text(given)
    if starts_json(text):
        return json_items(text, given)
    return [FileItem(_goal_line(bare, given, number), number) for number, bare in lines_of(text)]


def _goal_line(bare: str, file: object, number: int) -> dict[str, Any]:
    prior, colon, literals = bare.rpartition(":")
    facts = [text.strip() for text in literals.split(",")]
    if not all(facts):
        raise InputError(f"expected a goal as 'prior: fact, fact', got '{bare}'", file, number)
    return {"goal": facts, "prior": prior.strip() if colon else "1"}


def _candidate(entry: FileItem, number: int, ids: Mapping[str, int], file: object) -> CandidateGoal:
    def wrong(message: str) -> InputError:
        return InputError(f"goal {number}: {message}", file, entry.line)

    item = entry.value
    if not isinstance(item, Mapping):
        raise wrong(f"expected an object with name, goal and prior, got {item!r}")
    unknown = sorted(str(key) for key in item.keys() - {"name", "goal", "prior"})
    if unknown:
        raise wrong(f"unknown field '{unknown[0]}': expected name, goal and prior")
    try:
        literals, goal = literals_of(item.get("goal"), ids)
    except InputError as error:
        raise wrong(error.message) from None
    name = item.get("name", ", ".join(literals))
    if not isinstance(name, str):
        raise wrong(f"name: expected a text, got {name!r}")
    try:
        prior = exact(item.get("prior", 1), "prior")
    except UsageError as error:
        raise wrong(str(error)) from None
    if prior < 0:
        raise wrong(f"prior: expected a number of at least 0, got {item['prior']}")
    return CandidateGoal(name, literals, goal, prior)


def literals_of(given: Any, ids: Mapping[str, int]) -> tuple[tuple[str, ...], Condition]:
    """The literals of a goal as they are shown, and what they ask for.

    Args:
        given: the list of them that a file or a caller has.
        ids: of the facts, by name.

    Raises:
        InputError: it is no list of texts, or there is no such fact.
    """
    if not isinstance(given, list | tuple) or not all(isinstance(text, str) for text in given):
        raise InputError(f"goal: expected a list of facts, got {given!r}")
    signed = [_literal(text) for text in given]
    for fact, _ in signed:
        if fact not in ids:
            raise InputError(no_fact(fact, ids))
    goal = Condition(
        tuple(sorted({ids[fact] for fact, wanted in signed if wanted})),
        tuple(sorted({ids[fact] for fact, wanted in signed if not wanted})),
    )
    return tuple(_shown(*pair) for pair in signed), goal


def _literal(text: str) -> tuple[str, bool]:
    """The fact of ``fact``, ``(fact)``, ``!fact`` or ``(not (fact))``, and whether it is to be true."""
    bare = _without_brackets(canonical_name(text))
    if bare.startswith("!"):
        return _without_brackets(bare[1:].strip()), False
    if bare.startswith(("not ", "not(")):
        return _without_brackets(bare[3:].strip()), False
    return bare, True


def _without_brackets(text: str) -> str:
    while text.startswith("(") and text.endswith(")"):
        text = text[1:-1].strip()
    return text


def _shown(fact: str, wanted: bool) -> str:
    return fact if wanted else f"!{fact}"


def recognise(
    task: Task,
    goals: GoalsGiven,
    observed: ObservedGiven = (),
    beta: Number = 1,
    *,
    noise: Noise | str | None = None,
    time_limit: float | None = None,
    memory_limit: float | None = None,
    deadline: Deadline | None = None,
) -> Recognition:
    """How probable each candidate goal is, given what the human has done from ``I`` on.

    ``P(O|G) = 1 / (1 + exp(-beta (cost(G, not O) - cost(G, O))))``.  Where only one of the costs
    is finite it is exactly 0 or 1.  Observations are actions of theirs in their order, from the
    task's initial state on; they may have done more between them.  Where actions take time it is what
    they began.

    Args:
        task: the task; its own goal plays no part.
        goals: a file, or a list of ``{"name": ..., "goal": [literals], "prior": ...}``; literals
            are ``"fact"``, ``"!fact"`` or ``"(not (fact))"``.
        observed: a file with an action a line, or a list of names.
        beta: at least 0; 0 learns only from what is impossible.
        noise: how often actions are missed and observations are wrong; also ``"miss=0.1,wrong=0.05"``.
        time_limit: seconds, or None.
        memory_limit: what the process may have in memory, in MiB, or None.
        deadline: one that other work shares; it holds beside both limits.

    Raises:
        InputError: a file or an entry in it is wrong; it says where, and what was expected.
        UsageError: ``beta`` or a limit is not a number of at least 0, or there is noise beside a script.
        LimitReachedError: a limit came first.  A posterior takes the costs of all goals, so
            there is none then.
    """
    limits = limits_from(time_limit, memory_limit, deadline)
    expect(TASK_IN_TIME, task=task)
    task = in_whole_actions(task) if task.needs_time and not task.script else task
    candidates = candidate_goals(task, goals)
    conditions = [candidate.goal for candidate in candidates]
    names = observed_actions(task, observed)
    noisy, strict = noise_from(noise), strictness(beta)
    if task.script:
        refuse_noise(noisy)
        with no_collection():
            found = explained_in_time(task, conditions, names, Options(), limits)
        return posterior(task, candidates, names, found, strict)
    explainer = Explainer(PreparedTask(task), conditions)
    with no_collection():  # beside a large task a collection takes longer than a short deadline
        found = explainer.explain(names, limits)
        read = explainer.readings(names, noisy.prices(strict), limits) if noisy else None
    return posterior(task, candidates, names, found, strict, noisy, read)


def noise_from(given: Noise | str | None) -> Noise | None:
    """The noise that a caller names; None where there is none.

    Raises:
        UsageError: it is neither noise nor its text.
    """
    noise = Noise.parse(given) if isinstance(given, str) else given
    expect_or_none(Kind("Noise, or a text", lambda value: isinstance(value, Noise)), noise=noise)
    return noise if noise and (noise.miss or noise.wrong) else None


def refuse_noise(noise: Noise | None) -> None:
    """Return if nothing may have been missed or seen wrongly.

    Raises:
        UsageError: it may.
    """
    if noise:
        raise UsageError("noise: where a script or durations count, observations are taken as they are")


def strictness(beta: Number) -> float:
    """``beta`` as a float.

    Raises:
        UsageError: it is not a number of at least 0.
    """
    value = exact(beta, "beta")
    if value < 0:
        raise UsageError(f"beta: expected a number of at least 0, got {float(value):g}")
    return float(value)


def posterior(
    task: Task,
    candidates: Sequence[CandidateGoal],
    observed: tuple[str, ...],
    found: Sequence[Likelihood],
    beta: float,
    noise: Noise | None = None,
    readings: Sequence[Reading | None] | None = None,
) -> Recognition:
    """Bayes' rule over the candidates; their priors, if none explains the observations.

    Args:
        task: the task.
        candidates: goals with priors.
        observed: names of the observed actions, in order.
        found: ``cost(G, O)`` and ``cost(G, not O)`` of each candidate, in the same order.
        beta: how strictly the human is taken to minimise cost, per unit of cost.
        noise: of the observations, if there is any.
        readings: with noise, each candidate's likeliest one.
    """
    read = readings or [None] * len(found)
    logs = [
        _log_likelihood(explanation, beta) if noise is None else _log_of(one, explanation, noise.prices(beta))
        for explanation, one in zip(found, read, strict=True)
    ]
    known = [log for log, candidate in zip(logs, candidates, strict=True) if candidate.prior]
    most = max(known)
    explained = most > -math.inf
    # Relative to the best one, so that likelihoods that are equal leave the ratio of the priors exact.
    factors = [math.exp(min(log - most, 0)) if explained else 1.0 for log in logs]
    shares = [
        candidate.prior * as_written(factor) for candidate, factor in zip(candidates, factors, strict=True)
    ]
    total = sum(shares)
    return Recognition(
        human=task.agents[task.human],
        observed=observed,
        beta=beta,
        explained=explained,
        goals=tuple(
            GoalPosterior(
                name=candidate.name,
                goal=candidate.literals,
                prior=candidate.prior,
                likelihood=_likelihood(explanation, log),
                posterior=float(share / total),
                weight=share / total,
                with_observed=explanation.with_observed,
                without_observed=explanation.without_observed,
                plan=_names(task, explanation if one is None else one),
                errors=None if one is None else Errors(one.cost, one.wrong, one.missed),
            )
            for candidate, explanation, one, log, share in zip(
                candidates, found, read, logs, shares, strict=True
            )
        ),
        noise=None if noise is None else asdict(noise),
    )


def _names(task: Task, known: Likelihood | Reading) -> tuple[str, ...] | None:
    """The actions of the plan that is considered, if there is one."""
    return None if known.plan is None else tuple(task.actions[i].name for i in known.plan)


def _log_likelihood(explanation: Likelihood, beta: float) -> float:
    """``log P(O|G)``: logarithms, because dear detours would be 0 as they are."""
    if explanation.with_observed is None:
        return -math.inf
    if explanation.without_observed is None:
        return 0.0
    gain = beta * float(explanation.without_observed - explanation.with_observed)
    return -math.log1p(math.exp(-gain)) if gain >= 0 else gain - math.log1p(math.exp(gain))


def _log_of(reading: Reading | None, explanation: Likelihood, prices: Prices) -> float:
    """The same of noisy observations."""
    if reading is None:
        return -math.inf
    costs = (explanation.with_observed, explanation.without_observed)
    weights = [-prices.cost * float(cost) for cost in costs if cost is not None]
    best = max(weights)
    errors = (reading.wrong, prices.wrong), (reading.missed, prices.missed)
    said = -prices.cost * float(reading.cost) - sum(count * price for count, price in errors if count)
    return said - best - math.log(sum(math.exp(weight - best) for weight in weights))


def _likelihood(explanation: Likelihood, log: float) -> float | None:
    if explanation.with_observed is None and explanation.without_observed is None:
        return None
    return math.exp(log)
