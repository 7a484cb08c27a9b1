"""What a study is, once and for all: kept in its folder, so that it goes on the same after a pause."""

import hashlib
import json
import secrets
from collections.abc import Mapping
from dataclasses import dataclass, replace
from fractions import Fraction
from pathlib import Path
from typing import Any, Final

import serendipity
from serendipity.model import InputError, SerendipityError, UsageError
from serendipity.model.schemas import schema_fault
from serendipity.writing.together import write_together
from serendipity_live.play.labels import labels_for, read_settings
from serendipity_live.play.language import Language
from serendipity_live.play.language import language as language_of
from serendipity_live.play.records import made
from serendipity_live.play.round import RoundSetting
from serendipity_live.study.drawing import (
    Rehearsal,
    draw,
    fault,
    numbered,
    practice,
    rehearse,
    report,
    to_dict,
)
from serendipity_live.study.texts import OwnScenario, StudyFile

_SCHEMA: Final = "serendipity.study/1"
_TEXTS: Final = "study.toml"
_KEPT: Final = "study.json"
_USUAL: Final = {"rounds": 4, "discount": "3/5", "view": "observant", "deadline": 2.0}


@dataclass(frozen=True, slots=True)
class Design:
    """A study before anybody takes part.

    Who has its secret may see and save everything; each record has the mark, a hash of all the rest.
    """

    texts: StudyFile
    scenarios: Mapping[str, RoundSetting]
    practice: RoundSetting | None
    seed: int
    secret: str
    code: str
    mark: str
    report: str
    language: Language

    def setting(self, scenario: str, condition: str) -> RoundSetting:
        """A round of somebody's."""
        return replace(self.scenarios[scenario], condition=condition)

    def instructions(self) -> list[str]:
        """What there is to know before the first round."""
        rounds = [*self.scenarios.values(), *([] if self.practice is None else [self.practice])]
        about = dict.fromkeys(text for setting in rounds for text in setting.labels.about)
        first = self.language("First comes a round for practice, in which the robot stands still.")
        return [*about, *self.texts.instructions, *([] if self.practice is None else [first])]


def open_design(
    folder: Path, labels: Path | None = None, language: str | None = None, **given: Any
) -> Design:
    """The study of a folder: as it was begun, or a new one, with scenarios that are drawn and rehearsed.

    Args:
        folder: made where it is missing.
        language: of the page, where the folder's file does not say it; None: as begun, or English.
        **given: ``rounds``, ``seed``, ``discount``, ``view``, ``deadline``; None: as begun, or as usual.
    """
    made(folder, "--study")
    file = folder / _TEXTS
    texts = read_settings(file, StudyFile) if file.exists() else StudyFile.model_validate({})
    kept = _read(folder / _KEPT)
    texts = texts.model_copy(update={"language": _language(folder, texts, kept, language)})
    spoken = language_of(texts.language, folder)
    texts = texts.said_in(spoken)
    if texts.scenarios and given.get("rounds") not in (None, len(texts.scenarios)):
        raise UsageError(f"--rounds: {file} has {len(texts.scenarios)} scenarios of its own")
    if kept is None:
        kept = _begin(folder, texts, labels, given) | {"language": spoken.model_dump()}
        _write(folder / _KEPT, kept)
    for name, value in given.items():
        if value is not None and value != kept["settings"][name]:
            begun = kept["settings"][name]
            raise UsageError(f"--{name}: the study in {folder} was begun with {begun}; take another folder")
    begun_in = Language.model_validate(kept.get("language", {}))
    if StudyFile.model_validate(kept["texts"]).model_dump() != texts.model_dump() or begun_in != spoken:
        raise InputError(f"is not what the study was begun with ({_KEPT}): take another folder", file)
    return _design(folder, texts, labels, kept, spoken)


def _language(folder: Path, texts: StudyFile, kept: Mapping[str, Any] | None, asked: str | None) -> str:
    """What language the page has: the folder's file says it, or the command line, or how it was begun."""
    if "language" in texts.model_fields_set:
        if asked not in (None, texts.language):
            raise UsageError(f"--language: {folder / _TEXTS} says {texts.language}")
        return texts.language
    begun = texts.language if kept is None else str(kept["texts"].get("language", texts.language))
    if kept is not None and asked not in (None, begun):
        raise UsageError(f"--language: the study in {folder} was begun with {begun}; take another folder")
    return asked or begun


def _begin(folder: Path, texts: StudyFile, labels: Path | None, given: Mapping[str, Any]) -> dict[str, Any]:
    settings = {**_USUAL, **{name: value for name, value in given.items() if value is not None}}
    if texts.scenarios:
        settings["rounds"] = len(texts.scenarios)
    settings.setdefault("seed", secrets.randbelow(10**9))
    how, played = _how(texts, settings), {}
    for own in texts.scenarios:
        setting = _own(own, folder, labels, how)
        played[own.name] = _shown(setting, texts.conditions)
    if not texts.scenarios:
        drawn = draw(settings["rounds"], settings["seed"], texts.conditions, **how)
        played = {setting.name: rehearsal for setting, rehearsal in drawn}
    return {
        "schema": _SCHEMA,
        "version": serendipity.__version__,
        "settings": settings,
        "texts": texts.model_dump(),
        "scenarios": {name: to_dict(rehearsal) for name, rehearsal in played.items()},
        "practice": practice(settings["seed"]) if texts.practice and not texts.scenarios else None,
        "report": report(played, texts.conditions),
        "completion_code": texts.completion_code or secrets.token_hex(4).upper(),
        "secret": secrets.token_urlsafe(16),
    }


def _shown(setting: RoundSetting, conditions: list[str]) -> Rehearsal:
    played = rehearse(setting, conditions)
    wrong = fault(played, conditions)
    if wrong is not None:
        raise UsageError(f"scenario {setting.name}: {wrong} when somebody plays it who plays well")
    return played


def _how(texts: StudyFile, settings: Mapping[str, Any]) -> dict[str, Any]:
    return {
        "discount": Fraction(settings["discount"]),
        "view": settings["view"],
        "deadline": settings["deadline"],
        "most_epochs": texts.most_epochs,
    }


def _own(own: OwnScenario, folder: Path, labels: Path | None, how: Mapping[str, Any]) -> RoundSetting:
    where = f"scenario {own.name}"
    try:
        if (own.example is None) == (not own.files):
            raise UsageError("expected an example, or files")
        if own.example is not None:
            task = serendipity.example(own.example)
        else:
            task = _loaded([folder / file for file in own.files], own)
        return RoundSetting(own.name, task, labels=labels_for(task, labels), **how)
    except SerendipityError as error:
        raise InputError(f"{where}: {error}", folder / _TEXTS) from None


def _loaded(files: list[Path], own: OwnScenario) -> serendipity.Task:
    if len(files) == 1:
        return serendipity.load(files[0], human=own.human)
    if len(files) == 2 and own.human is not None:
        return serendipity.load_pddl(files[0], files[1], own.human, own.robots)
    raise UsageError("files: expected a folder, or a domain and a problem with their human")


def _design(
    folder: Path, texts: StudyFile, labels: Path | None, kept: Mapping[str, Any], spoken: Language
) -> Design:
    how = _how(texts, kept["settings"])
    own = {scenario.name: scenario for scenario in texts.scenarios}
    scenarios = {
        name: _own(own[name], folder, labels, how)
        if name in own
        else numbered(int(name.rpartition("-")[2]), **how)
        for name in kept["scenarios"]
    }
    scenarios = {name: _said_in(setting, spoken, labels) for name, setting in scenarios.items()}
    trial = None if kept["practice"] is None else numbered(kept["practice"], **how)
    if trial is not None:
        trial = replace(_said_in(trial, spoken, labels), name="practice", condition="none")
    same = {key: value for key, value in kept.items() if key != "secret"}
    mark = hashlib.sha256(json.dumps(same, sort_keys=True).encode()).hexdigest()[:16]
    return Design(
        texts,
        scenarios,
        trial,
        kept["settings"]["seed"],
        kept["secret"],
        kept["completion_code"],
        mark,
        kept["report"],
        spoken,
    )


def _said_in(setting: RoundSetting, spoken: Language, labels: Path | None) -> RoundSetting:
    """A round in a language; its labels are the language's, where these fit and no others are given."""
    theirs = spoken.labels
    fits = labels is None and theirs is not None and theirs.complete(setting.task)
    return replace(setting, say=spoken, labels=theirs if fits and theirs is not None else setting.labels)


def _read(file: Path) -> dict[str, Any] | None:
    if not file.exists():
        return None
    try:
        kept = json.loads(file.read_bytes())
    except (ValueError, RecursionError):
        raise InputError("expected JSON, as a study has written it", file) from None
    if fault := schema_fault(kept.get("schema") if isinstance(kept, dict) else None, _SCHEMA):
        raise InputError(fault, file)
    assert isinstance(kept, dict)
    return kept


def _write(file: Path, kept: Mapping[str, Any]) -> None:
    try:
        write_together({file: (json.dumps(kept, ensure_ascii=False, indent=1) + "\n").encode()})
        file.chmod(0o600)  # the secret is in it
    except OSError as error:
        raise UsageError(f"--study: {file} can't be written: {(error.strerror or '').lower()}") from None
