"""What an engine is asked for: who is who, what the human does, and options."""

from collections.abc import Iterable
from dataclasses import dataclass, replace
from typing import Any, Final

from unified_planning.model import AbstractProblem, Problem
from unified_planning.model.multi_agent import MultiAgentProblem
from unified_planning.plans import Plan

from serendipity.facade.call import options_from
from serendipity.model import INFINITE, Options, UsageError

_HELP: Final = ("serendipity", "communication", "assistance")
_OWN: Final = ("human", "robots", "human_plan", "predict_with")


@dataclass(frozen=True, slots=True)
class EngineCall:
    """Parameters of the engine.

    Attributes:
        options: of the planning call.
        human: who is the human; None if nobody said.
        robots: who are the robots; None if nobody said.
        human_plan: what the human is going to do, or None.
        predict_with: the engine that predicts it, or None.
        given: the parameters as they were given.
    """

    options: Options
    human: Any = None
    robots: Any = None
    human_plan: Plan | Iterable[str] | None = None
    predict_with: str | None = None
    given: tuple[tuple[str, Any], ...] = ()

    def but(self, changes: dict[str, Any]) -> "EngineCall":
        """The same with other parameters."""
        return call_of({**dict(self.given), **changes})

    @property
    def inexact(self) -> str | None:
        """The parameter for which an optimal plan need not be one of the problem; None if there is none."""
        options = self.options
        if options.mode != "composite":
            return f"mode '{options.mode}'"
        if options.horizon != INFINITE:
            return f"horizon {options.horizon}"
        if options.discount:
            return f"discount {options.discount}"
        return None if options.max_cost is None else f"max_cost {options.max_cost}"

    @property
    def exact(self) -> bool:
        """Whether an optimal plan is one of the problem."""
        return self.inexact is None

    @property
    def modeless(self) -> bool:
        """Whether nobody has asked for the best answer in a mode: any plan of the problem will do."""
        return self.exact and "mode" not in dict(self.given)

    def who(self, problem: AbstractProblem) -> tuple[Any, Any]:
        """Human and robots: where it makes no difference to the answer, anybody is the human.

        Raises:
            UsageError: it is help that is asked for, and nobody said for whom.
        """
        mode = self.options.mode
        if self.human is None and self.robots is None and isinstance(problem, Problem) and mode in _HELP:
            raise UsageError(f"human: mode '{mode}' is help for somebody: expected an object")
        if self.human is None and self.exact and isinstance(problem, MultiAgentProblem) and problem.agents:
            return problem.agents[0].name, None
        return self.human, self.robots


def call_of(parameters: dict[str, Any]) -> EngineCall:
    """Parameters of the engine, checked.

    Raises:
        UsageError: one is unknown or has no legal value.
    """
    own = {name: parameters[name] for name in _OWN if name in parameters}
    others: dict[str, Any] = {"mode": "composite", "interference": "strict"}
    others.update({name: value for name, value in parameters.items() if name not in own})
    if others["mode"] == "composite":
        others.setdefault("horizon", INFINITE)
    if own.get("human_plan") is not None and own.get("predict_with") is not None:
        raise UsageError("predict_with: the human's plan is given")
    try:
        options = options_from(others)
    except UsageError as error:
        message = str(error)
        if message.startswith("unknown option"):
            message = f"{message}, {', '.join(_OWN)}"
        raise UsageError(message) from None
    return replace(EngineCall(options, **own), given=tuple(parameters.items()))
