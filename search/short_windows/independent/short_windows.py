"""Windows of one epoch, where longer ones can't be better: robots one by one, epoch by epoch.

Until the window the human follows ``pi_H``, and after it they go on alone; so all that robots can do for them
is what they leave behind.  For each epoch this is what each of them can have brought about on its own, put
together in every way, and what the human pays from there on their own, exactly.  Where robots need one
another, each may help itself to what others can have provided by then, for nothing: then it is a lower bound.
"""

from collections.abc import Iterator
from contextlib import suppress
from typing import Final

from search.call.context import SearchContext
from search.classical.circles import TooManyError, disabled
from search.packed.cost_vector import FAR, INFINITE_KEY
from search.packed.operators import Operator
from search.packed.packed_task import PackedTask
from search.short_windows.independent.landmarks import Landmarks
from search.short_windows.independent.provision import by_others, provisions
from search.short_windows.independent.timeline import RobotLayers, TooManyStatesError
from search.short_windows.independent.window import ACTION, Window
from search.short_windows.question import ShortWindowQuestion, lost_values
from serendipity.model.resources.deadline import Deadline

_WORTH: Final = 4
"""What a window promises is tried out at once if it is one part in so many of what can be hoped for."""

_TRIALS: Final = 20
"""Of what costs least in an epoch so many are tried out, until one can be done."""


class ShortWindows:
    """Plans with a window of one epoch, by the epoch of the window."""

    def __init__(self, question: ShortWindowQuestion) -> None:
        context, packed = question.context, question.context.packed
        self._question = question
        self._best = question.best
        self._steps = question.steps()
        self._lost = lost_values(packed)
        self._landmarks = Landmarks(packed, self._amount, context.deadline)
        provided = provisions(packed, self._steps, context.deadline)
        self._timelines = [
            RobotLayers(context, robot, self._steps, by_others(provided, robot), self._amount)
            for robot in sorted({op.agents for op in packed.others})
        ]
        self._windows: list[Window] = []
        self._ahead = 0

    @property
    def bound(self) -> int:
        """No plan with a window of one epoch has a smaller key, but the incumbent."""
        return min([self._ahead, *(window.bound for window in self._windows)])

    def answers(self) -> Iterator[None]:
        """Yield whenever the incumbent has become better; in the end the bound is as good as it gets.

        All windows are looked at before any of them is gone through: a good incumbent saves most of that.

        Raises:
            LimitReachedError: the deadline came, or there are too many states; what is known by then is kept.
        """
        best = self._best
        with suppress(TooManyStatesError):
            for window in self._each():
                hoped = best.key - window.bound
                if hoped * _WORTH < best.key - self._ahead or not window.is_open(best.key):
                    continue
                if self._tries(window, window.look(best.key)):
                    yield
        for window in sorted(self._windows, key=lambda window: window.bound):
            trials = 0
            while trials < _TRIALS and window.is_open(best.key):
                place = window.look(best.key)
                if self._tries(window, place):
                    yield
                elif place is not None:
                    trials += 1

    def _each(self) -> Iterator[Window]:
        """Windows of one epoch, the earliest first."""
        question, best, context = self._question, self._best, self._question.context
        base, spent = context.packed.init, context.keys.epoch_weight
        for epoch, step in enumerate(self._steps, 1):
            self._ahead = spent
            if spent >= best.key:
                return
            start = spent + context.keys.of_start(epoch, question.horizon)
            window = Window(context, self._timelines, self._landmarks, self._lost, base, start, best.key)
            self._windows.append(window)
            yield window
            spent += context.weights.team(step)
            if epoch < len(self._steps) and spent < best.key:
                self._ahead = spent
                for timeline in self._timelines:
                    timeline.follow(context.weights.amount_from(best.key - spent, FAR))
            base = base & step.keep | step.put
        self._ahead = INFINITE_KEY

    def _tries(self, window: Window, place: int | None) -> bool:
        """Whether robots can leave something behind together, and it is the best so far."""
        if place is None:
            return False
        better = self._question.suggestions().on_time(window.ways(place))
        return sum(1 for _ in self._question.accept(better)) > 0

    def _amount(self, op: Operator) -> int:
        return self._question.context.weights.scaled_cost(op) * ACTION + 1


def short_windows(question: ShortWindowQuestion) -> ShortWindows | None:
    """Plans with a window of one epoch, robots one by one; None where they can't be looked at so."""
    context, packed = question.context, question.context.packed
    if not packed.others or not are_apart(packed, context.deadline, strict=context.options.strict):
        return None
    return ShortWindows(question) if _fit_words(question, context) else None


def are_apart(packed: PackedTask, deadline: Deadline, *, strict: bool) -> bool:
    """Whether every action has one participant, and robots leave the human what they need in the same epoch.

    Where a robot may take away what an action of the human's only asks for, while that is being done,
    what the human pays after a window is no bound on what they pay in it.

    Args:
        strict: strict interference, which forbids the latter.
    """
    if packed.joint or any(op.agents & op.agents - 1 for op in packed.others):
        return False
    try:
        return strict or not any(True for _ in disabled(packed, packed.others, packed.own, deadline))
    except TooManyError:
        return False


def _fit_words(question: ShortWindowQuestion, context: SearchContext) -> bool:
    """Whether what robots pay up to a window, the human's landmarks, and what is of interest fit words."""
    price, packed = context.weights.scaled_cost, context.packed
    robots = (max(map(price, packed.others)) + 1) * (len(question.plan) + 1) * len(context.task.robots)
    human = sum(map(price, packed.own)) + len(packed.own)
    return max(robots, human) * ACTION < FAR > context.weights.amount_from(question.best.key, FAR)
