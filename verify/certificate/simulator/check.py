"""Claims about a human who replans, certified by playing the plan once more (semantics 6)."""

from collections.abc import Iterable, Iterator
from fractions import Fraction
from time import perf_counter

from serendipity.model import Claim, PlanError, Result, Step, Task
from verify.base import wording
from verify.base.execution import meant_by, price, unchosen
from verify.base.optimal_plans import OptimalPlans
from verify.base.undecided import UNDECIDED, why
from verify.certificate.simulator.run import PlayedOut, play
from verify.rules.replay import replay_human

_MODELS = ("observant", "local")


def realised_claim(task: Task, result: Result, plans: OptimalPlans | None = None) -> Claim | None:
    """The ``realised`` claim of a result, or None where it makes none.

    It stands for every verdict that the result carries and, where it was planned under a
    human model, for the plan being what robots and human do then.

    Args:
        result: a result whose plan can be replayed.
        plans: what is known of the human alone, from other questions.
    """
    if result.plan is None or result.cost is None:
        return None
    if not result.realised and result.options.human_model == "omniscient":
        return None
    started = perf_counter()
    try:
        fault = next(_TraceExamination(task, result, plans or OptimalPlans(task)).faults(), None)
    except UNDECIDED as error:
        return Claim("realised", "undecided", why(error), seconds=perf_counter() - started)
    except PlanError as error:
        fault = str(error)
    seconds = perf_counter() - started
    if fault is not None:
        return Claim("realised", "refuted", fault, seconds=seconds)
    models = ", ".join(result.realised) or result.options.human_model
    return Claim("realised", "proved", wording.PLAYED_AGAIN.format(models), seconds=seconds)


class _TraceExamination:
    def __init__(self, task: Task, result: Result, plans: OptimalPlans) -> None:
        self.task = task
        self.result = result
        self.plans = plans
        names = result.human_plan
        self.human_plan = () if names is None else replay_human(task, names, plans.deadline)
        self.steps = [Step(step.epoch, _action(task, step.action, step.agents)) for step in result.plan or ()]

    def faults(self) -> Iterator[str]:
        """What is wrong, one line each."""
        for model, said in self.result.realised.items():
            if model not in _MODELS:
                yield f"there is no human model '{model}'"
            elif self._play(model).realised(self._promised()) is not said:
                yield f"{model}: the result says {str(said).lower()}, playing it says otherwise"
        model = self.result.options.human_model
        if model in _MODELS and (self.result.opportunity or self.task.robot_goal):
            yield from self._reaction(self._play(model))
        elif model in _MODELS:  # then they are left alone
            yield from self._differences(Step(t, i) for t, i in enumerate(self.human_plan, start=1))

    def _reaction(self, played: PlayedOut) -> Iterator[str]:
        """An answer under a human model is what happens under it."""
        if not played.realised(self._promised()):
            yield "the plan does not work out with the human that it was made for"
        yield from self._differences(played.steps)
        if played.blocked is not None and self.result.options.no_block is not False:
            yield f"epoch {played.blocked}: robots leave the human without a plan"

    def _differences(self, steps: Iterable[Step]) -> Iterator[str]:
        names = {(step.epoch, self.task.actions[step.action].name) for step in steps}
        said = {(step.epoch, step.action) for step in self.result.plan or ()}
        going_on = {self.task.actions[i].name for i in unchosen(self.task)}
        for epoch, name in sorted(one for one in names ^ said if one[1] not in going_on):
            says = "does not say" if (epoch, name) in names else "says wrongly"
            yield f"epoch {epoch}: the plan {says} '{name}'"

    def _play(self, model: str) -> PlayedOut:
        return play(
            self.task,
            self.result.options,
            self.human_plan,
            self.steps,
            human_model=model,
            horizon=self.result.horizon,
            plans=self.plans,
        )

    def _promised(self) -> Fraction:
        """The plan's exact cost; the result's own figure is rounded."""
        actions = (self.task.actions[step.action] for step in self.steps)
        discount = self.result.options.discount
        return sum((price(self.task, action, discount) for action in actions), Fraction(0))


def _action(task: Task, name: str, agents: tuple[str, ...]) -> int:
    """One of the actions of that name and those agents; which one does not matter."""
    meant = meant_by(task, name, agents)
    if not meant:
        raise PlanError(f"there is no action '{name}' of {', '.join(sorted(agents))}")
    return meant[0]
