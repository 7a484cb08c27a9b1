"""What ``study.toml`` may say: texts, questions, conditions and scenarios of a study's own."""

from typing import Annotated, Any, Final, Literal, Self

from pydantic import BaseModel, ConfigDict, Field, model_validator

from serendipity_live.play.language import Language
from serendipity_live.play.round import CONDITIONS

Lines = Annotated[list[Annotated[str, Field(min_length=1)]], Field(min_length=1)]

MOST_LETTERS: Final = 2_000
"""Of an answer that is a text."""

_CONSENT: Final = [
    "You will move a person through a world, in a few rounds of some minutes each. A robot may be about.",
    "What you do and what you are shown is recorded with its time, together with your answers to a few "
    "questions, and with what browser and screen you use: under a number, without your name. It stays with "
    "those who run the study.",
    "Taking part is voluntary. You can stop at any time, without giving a reason: press “Withdraw”, or close "
    "the page. If you want your record to be deleted, tell those who run the study your number.",
]
_INSTRUCTIONS: Final = [
    "Your goal stands above the map. A round is over when it is reached.",
    "Time goes on in steps, which are called epochs: in each you do one thing, and so may the robot, at the "
    "same time. To go somewhere, click on a marked place; everything else that you can do stands in the list "
    "beside the map. You can also wait.",
    "The number beside each choice is what it costs you. Please reach your goal at as low a cost as you can.",
    "There is a robot. It may help you, or keep to itself; if it speaks, it stands above the list. What you "
    "can do together with it comes first in the list, and you are free to take it or leave it.",
]
_SCALES: Final = (
    "I understood what the robot was doing.",
    "The robot helped me.",
    "The robot got in my way.",
    "I would work with this robot again.",
)


class _Part(BaseModel):
    model_config = ConfigDict(extra="forbid", strict=True)


class Item(_Part):
    """An item of a questionnaire: a scale from 1 on, a choice, or a text; with ``expect`` a check."""

    text: str = Field(min_length=1)
    kind: Literal["scale", "choice", "text"] = "scale"
    points: int = Field(default=7, ge=2, le=11)
    ends: list[str] = Field(default=["not at all", "very much"], min_length=2, max_length=2)
    choices: list[str] = []
    required: bool = True
    expect: int | str | None = None

    @model_validator(mode="after")
    def _chosen_from(self) -> Self:
        if (self.kind == "choice") != bool(self.choices):
            raise ValueError("choices: go with kind = 'choice', and only with that")
        if self.expect is not None and (wrong := self.fault(self.expect)):
            raise ValueError(f"expect: {wrong}")
        return self

    def right(self, answer: object) -> bool | None:
        """Whether an answer is what is expected of those who read and attend; None if anything is."""
        return None if self.expect is None else answer == self.expect

    def fault(self, answer: object) -> str | None:
        """What is wrong with an answer; None where nothing is."""
        if answer in (None, "") and not self.required:
            return None
        if self.kind == "scale":
            good = type(answer) is int and 1 <= answer <= self.points
            return None if good else f"expected a whole number from 1 to {self.points}"
        if self.kind == "choice":
            return None if answer in self.choices else f"expected one of {', '.join(self.choices)}"
        good = isinstance(answer, str) and 0 < len(answer) <= MOST_LETTERS
        return None if good else f"expected a text of at most {MOST_LETTERS} characters"


class OwnScenario(_Part):
    """A scenario of the study's own: an example, or a task as ``play`` takes it."""

    name: str = Field(min_length=1)
    example: str | None = None
    files: list[str] = []
    human: str | None = None
    robots: list[str] = []


class StudyFile(_Part):
    """What the file may hold; everything has a default."""

    language: str = "en"
    consent: Lines = _CONSENT
    instructions: Lines = _INSTRUCTIONS
    comprehension: list[Item] = []
    tries: int = Field(default=3, ge=1, le=100)
    questions: list[Item] = [
        *(Item(text=text) for text in _SCALES),
        Item(text="Anything else?", kind="text", required=False),
    ]
    closing: list[Item] = []
    conditions: Lines = list(CONDITIONS)
    practice: bool = True
    completion_code: str | None = None
    completion_link: str | None = Field(default=None, pattern=r"^https?://[^\s/]\S*$")
    lost_after_minutes: float = Field(default=60.0, gt=0)
    most_epochs: int = Field(default=60, ge=1, le=1000)
    scenarios: list[OwnScenario] = []

    def said_in(self, language: Language) -> "StudyFile":
        """The same in a language, as far as the file has no words of its own."""
        theirs: dict[str, Any] = {"consent": language.consent, "instructions": language.instructions}
        scales = [Item(text=text, ends=language.ends) for text in language.scales]
        theirs["questions"] = [*scales, Item(text=language.comment or "-", kind="text", required=False)]
        known = self.model_fields_set if language.scales else theirs.keys()
        return self.model_copy(update={name: words for name, words in theirs.items() if name not in known})

    @model_validator(mode="after")
    def _known(self) -> Self:
        if len(set(self.conditions)) < len(self.conditions) or not set(self.conditions) <= CONDITIONS.keys():
            raise ValueError(f"conditions: expected some of {', '.join(CONDITIONS)}, each once")
        if any(item.expect is None for item in self.comprehension):
            raise ValueError("comprehension: expected that each question says what to expect")
        names = [scenario.name for scenario in self.scenarios]
        if len(set(names)) < len(names):
            raise ValueError("scenarios: two have the same name")
        return self
