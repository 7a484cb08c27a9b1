"""What requests have to look like; what their values mean is checked by those who plan."""

import json
from typing import Any, Final, NamedTuple

from pydantic import BaseModel, ConfigDict, Field, StrictBool, model_validator

from serendipity.model import Options
from serendipity.model.keywords import CHOICES

_DOMAIN: Final = "text of a PDDL domain"
_PROBLEM: Final = "text of a PDDL problem"


def _options_schema() -> dict[str, Any]:
    described = {
        name: {"default": default} | ({"enum": list(CHOICES[name])} if name in CHOICES else {})
        for name, default in Options().to_dict().items()
    }
    return {"type": "object", "properties": described, "additionalProperties": False}


class RequestPart(BaseModel):
    """A part of a request; what it does not know is an error, and so is what is no text or no number."""

    model_config = ConfigDict(extra="forbid")

    @model_validator(mode="before")
    @classmethod
    def _only_json(cls, given: object) -> object:
        try:
            if isinstance(given, dict):
                json.dumps(given, ensure_ascii=False, allow_nan=False).encode()
        except UnicodeEncodeError:
            raise ValueError("expected text, got half of a surrogate pair") from None
        except ValueError:
            raise ValueError("expected finite numbers, got NaN, Infinity or one that is too large") from None
        except RecursionError:
            raise ValueError("it is nested too deeply") from None
        return given


class FilePair(RequestPart):
    """The files of an agent."""

    domain: str = Field(description=_DOMAIN)
    problem: str = Field(description=_PROBLEM)


class GivenTask(RequestPart):
    """A task, named in exactly one way: ``example``, ``domain`` and ``problem``, or ``agents``."""

    example: str | None = Field(None, description="name of a shipped task", examples=["room2"])
    domain: str | None = Field(None, description=_DOMAIN)
    problem: str | None = Field(None, description=_PROBLEM)
    agents: dict[str, FilePair] | None = Field(None, description="a pair of files for each agent, by name")
    team: FilePair | None = Field(None, description="the pair with the joint actions")
    human: str | None = Field(None, description="the agent who is helped")
    robots: list[str] | None = Field(None, description="those who help")


_OPTIONS: Final[Any] = Field(
    default_factory=dict,
    description="options of `serendipity plan`",
    json_schema_extra=_options_schema(),
    examples=[{"discount": 0.6}],
)


GivenPlan = list[str | tuple[int, str]]
"""Names of actions, or the epochs in which they begin, from 1, with their names."""


class AnytimeRequest(RequestPart):
    """A planning call whose answers get better."""

    task: GivenTask
    options: dict[str, Any] = _OPTIONS
    human_plan: GivenPlan | None = Field(None, description="what the human will do; None predicts it")


class PlanRequest(AnytimeRequest):
    """A planning call."""

    goals: list[dict[str, Any]] | None = Field(
        None, description="goals that the human may have", examples=[[{"name": "a", "goal": ["at h x"]}]]
    )
    observed: list[str] | None = Field(None, description="what the human has done, for `goals`")
    beta: float | str | None = Field(None, description="of the posterior, for `goals`")
    noise: str | None = Field(None, description="of `observed`: `miss=P,wrong=Q`")
    plans: list[dict[str, Any]] | dict[str, Any] | None = Field(
        None, description="plans that the human may follow, or the library that `serendipity learn` writes"
    )


class SessionSnapshot(RequestPart):
    """All of a session: what it was begun with, and where it stands."""

    task: GivenTask
    options: dict[str, Any] = _OPTIONS
    human_plan: GivenPlan | None = None
    state: dict[str, Any] | None = Field(description="as `Session.snapshot` writes it; null at the beginning")


class SessionRequest(RequestPart):
    """A session to be begun; its options are defaults of its calls. Or a snapshot of one to go on with."""

    task: GivenTask | None = None
    options: dict[str, Any] = _OPTIONS
    human_plan: GivenPlan | None = Field(None, description="what the human will do; None predicts it")
    snapshot: SessionSnapshot | None = Field(None, description="what another server's `/snapshot` said")

    @model_validator(mode="after")
    def _begun_one_way(self) -> "SessionRequest":
        if (self.task is None) == (self.snapshot is None):
            raise ValueError("expected a task or a snapshot")
        if self.snapshot is not None and (self.options or self.human_plan is not None):
            raise ValueError("snapshot: goes without options and human_plan, it has its own")
        return self

    def parts(self) -> tuple[dict[str, Any], dict[str, Any] | None]:
        """What it is begun with, and where it stands."""
        begun = (self.snapshot or self).model_dump(exclude={"snapshot"})
        return begun, begun.pop("state", None)


class VerifyRequest(RequestPart):
    """A result to be checked."""

    task: GivenTask
    result: dict[str, Any] = Field(description="what `/plan` answered")
    solver: str | None = Field(None, examples=["highs"])
    encoding: str | None = Field(None, examples=["automata"])
    method: str | None = Field(None, examples=["auto"])


class ExplainRequest(AnytimeRequest):
    """An answer to be explained, or options of one that is planned first."""

    result: dict[str, Any] | None = Field(None, description="what `plan` answered; without it, it is planned")


class CheckTaskRequest(RequestPart):
    """A task to be looked at."""

    task: GivenTask


class Call(NamedTuple):
    """A call that stands for itself, over HTTP or as a tool: what it asks for, and what it answers."""

    arguments: type[RequestPart]
    schema: str
    about: str


CALLS: Final = {
    "plan": Call(
        PlanRequest,
        "schema `serendipity.result/1`",
        "The best plan in which robots help the human, what it costs and saves, and whether that is proved.",
    ),
    "verify": Call(
        VerifyRequest,
        "schema `serendipity.certificate/1`",
        "Check a result of `plan` claim by claim, independently of the search.",
    ),
    "explain": Call(
        ExplainRequest,
        "schema `serendipity.explanation/1`, or `serendipity.policy-explanation/1`",
        "Why this help, why then, and from which discount on; or what stands in the way of any.",
    ),
    "check_task": Call(
        CheckTaskRequest,
        "schema `serendipity.task-report/1`",
        "How large a task is, and what is wrong with it, or probably not meant. Nothing is planned.",
    ),
}
"""By the job that workers do."""


class SessionPlanRequest(RequestPart):
    """A planning call from where a session stands."""

    options: dict[str, Any] = _OPTIONS


class ExecuteRequest(RequestPart):
    """What was done in an epoch."""

    actions: list[str]


class ChangeRequest(RequestPart):
    """Facts as they were seen."""

    facts: dict[str, StrictBool]


class GoalRequest(RequestPart):
    """Another goal of the human's."""

    goal: list[str]


class GoingOn(BaseModel):
    """An action that has begun and not ended."""

    action: str
    agents: list[str]
    epochs: int = Field(description="that it still takes")


class SessionTime(BaseModel):
    """How far a session in time has come."""

    passed: int = Field(description="epochs that are over")
    going: list[GoingOn] = Field(description="what has begun and goes on")


class SessionState(BaseModel):
    """Where a session stands."""

    id: str
    facts: list[str] = Field(description="the true ones")
    goal: list[str]
    human_plan: GivenPlan | None = Field(description="what the human is going to do, where it is known")
    time: SessionTime | None = Field(None, description="where actions take time, or there is a script")


class SessionMoved(SessionState):
    """Where a session stands after a call that began or moved it."""

    snapshot: SessionSnapshot | None = Field(None, description="all of it, with `?snapshot=true`")


class Refusal(BaseModel):
    """What is wrong, in the line that the command line says."""

    error: str
