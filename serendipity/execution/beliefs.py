"""Which goal the person has, from one epoch to the next (semantics 8)."""

from collections.abc import Collection, Sequence
from dataclasses import replace
from fractions import Fraction
from typing import Final

from search import PreparedTask
from search.modes.goals import Explainer
from serendipity.model import Deadline, Task
from serendipity.model.errors import LIMITS
from serendipity.model.numbers import Number
from serendipity.recognition.recognise import CandidateGoal, Noise, noise_from, posterior, strictness

_LIKELY: Final = 0.2
"""A goal of that probability is not ruled out."""

_EXACT: Final = 0.7
"""The share of the time that exact likelihoods may take; bounds on them have to do otherwise."""


_TIME_TO_RECOGNISE: Final = 0.4
"""The share of the time that recognition may take; the posterior of an earlier epoch has to do otherwise."""


class Beliefs:
    """The posterior over candidate goals.

    Likelihoods are of the person alone, with robots idle.  So where robots have changed something that
    the person's own actions are about, or have done something with them, what was seen up to there is
    summed up: the posterior becomes the prior, and the present state the initial one.

    Args:
        candidates: goals, with their priors.
        beta: how strictly the person is taken to minimise cost.
        noise: of what is seen of them; where time is short there is none.
        explainer: makes what explains what was seen; None: the exact one.

    Attributes:
        explainer: what explains it.
        weights: how probable each is.

    Raises:
        UsageError: ``beta`` or ``noise`` is wrong.
    """

    def __init__(
        self,
        task: Task,
        candidates: Sequence[CandidateGoal],
        beta: Number,
        noise: Noise | str | None = None,
        explainer: type[Explainer] | None = None,
    ) -> None:
        self.candidates = candidates
        self._task = task
        goals = [candidate.goal for candidate in self.candidates]
        self.explainer = (explainer or Explainer)(PreparedTask(task), goals)
        self._beta, self._noise = strictness(beta), noise_from(noise)
        self._priors = [candidate.prior for candidate in self.candidates]
        self._observed: list[str] = []
        self._disturbed = False
        self._out: set[int] = set()
        self.weights = list(self._priors)
        own = (task.actions[i] for i in task.human_actions)
        self._concern = frozenset(f for a in own for f in (*a.pre, *a.neg, *a.add, *a.delete))

    def saw(self, own: int | None, executed: Sequence[int]) -> None:
        """Take in an epoch: what the person did alone, and everything that took place."""
        actions = self._task.actions
        if own is not None:
            self._observed.append(actions[own].name)
        others = (actions[i] for i in executed if i != own)
        if any(not self._concern.isdisjoint((*action.add, *action.delete)) for action in others):
            self._disturbed = True

    def rule_out(self, *others: Collection[int]) -> bool:
        """Say that the person has not done what they would have with some goals; whether that leaves any.

        If not, nothing is known any more.

        Args:
            others: indices of such goals; the next of these count where the ones before leave none.
        """
        for out in others:
            left = [Fraction(0) if i in out else weight for i, weight in enumerate(self.weights)]
            if found := any(left):
                break
        else:
            left, found = [candidate.prior for candidate in self.candidates], False
            self._out.clear()
        self.weights = [weight / sum(left) for weight in left]
        self._priors, self._observed, self._disturbed = list(self.weights), [], True
        return found

    def disturbed(self) -> None:
        """The world is other than what actions have made it."""
        self._disturbed = True

    def update(self, state: frozenset[int], deadline: Deadline) -> None:
        """Weigh what was seen.

        Args:
            state: ids of the facts that are true now.

        Raises:
            LimitReachedError: the deadline came first; the weights stay as they were.
        """
        if self._observed:
            share, noise, read = deadline.part(_EXACT), self._noise, None
            try:
                found = self.explainer.explain(self._observed, share, canonical=False)
                if noise is not None:
                    read = self.explainer.readings(self._observed, noise.prices(self._beta), share)
            except LIMITS:
                deadline.check()
                found, noise = self.explainer.from_here(self._observed, state, deadline), None
            priors = zip(self.candidates, self._priors, strict=True)
            weighed = [replace(candidate, prior=prior) for candidate, prior in priors]
            names = tuple(self._observed)
            recognition = posterior(self._task, weighed, names, found, self._beta, noise, read)
            self.weights = [goal.weight for goal in recognition.goals]
        self._rule_out()
        if self._disturbed:
            self._priors, self._observed = list(self.weights), []
            self.explainer = self.explainer.at(state)
            self._disturbed = False

    def weighed(self, state: frozenset[int], deadline: Deadline) -> dict[int, Fraction]:
        """The goals that the person may have, with their probabilities, the most probable first.

        Raises:
            LimitReachedError: the deadline came first.
        """
        try:
            self.update(state, deadline.part(_TIME_TO_RECOGNISE))
        except LIMITS:
            deadline.check()  # what was known before still tells something
        return {goal: self.weights[goal] for goal in sorted(self.possible(), key=lambda g: -self.weights[g])}

    def likely(self, goal: int | None = None) -> tuple[tuple[str, float], ...]:
        """The names of the most probable goals with their probabilities, or of one of them."""
        if goal is not None:
            return ((self.candidates[goal].name, float(self.weights[goal])),)
        return tuple(sorted(self.named().items(), key=lambda pair: -pair[1])[:3])

    def possible(self) -> list[int]:
        """Indices of the goals that can't be ruled out.

        Whoever acts optimally for a goal makes the likelihood of what they do at least a half, so its
        posterior stays at least half its prior.  One that was ruled out comes back if it is likely after all.
        """
        return [i for i in range(len(self.weights)) if i not in self._out]

    def _rule_out(self) -> None:
        for i, (weight, prior) in enumerate(zip(self.weights, self._priors, strict=True)):
            if weight < prior / 2 or not weight:
                self._out.add(i)
            if weight >= _LIKELY:
                self._out.discard(i)

    def named(self) -> dict[str, float]:
        """The posterior by the goals' names."""
        return {c.name: float(weight) for c, weight in zip(self.candidates, self.weights, strict=True)}
