"""The page's words in another language: a translation of each English text, and words for the building."""

import json
from collections.abc import Mapping
from importlib.resources import files
from pathlib import Path
from typing import Any, Final

from pydantic import BaseModel, ConfigDict

from serendipity.model import InputError
from serendipity_live.play.labels import DomainLabels, read_settings

_FOLDER: Final = files("serendipity_live.play").joinpath("languages")


class Language(BaseModel):
    """Words of a language, as a file has them; of English there is nothing to say.

    Attributes:
        texts: by the English text, in which ``{name}`` stands for what is put there.
        consent: paragraphs of a study.
        instructions: likewise.
        scales: what participants are asked after a round.
        comment: the last of these questions, for a text.
        ends: of scales.
        labels: of the building.
    """

    model_config = ConfigDict(extra="forbid", strict=True, frozen=True)

    texts: dict[str, str] = {}
    consent: list[str] = []
    instructions: list[str] = []
    scales: list[str] = []
    comment: str = ""
    ends: list[str] = []
    labels: DomainLabels | None = None

    def __call__(self, text: str, /, **values: Any) -> str:
        """An English text in this language, with values in it."""
        return self.texts.get(text, text).format(**values)


ENGLISH: Final = Language()


def language(name: str, folder: Path) -> Language:
    """A language that is shipped, by its code, or one that a file of a folder has."""
    if name == "en":
        return ENGLISH
    shipped = sorted(
        path.name.removesuffix(".toml") for path in _FOLDER.iterdir() if path.name.endswith(".toml")
    )
    if name in shipped:
        return read_settings(Path(str(_FOLDER.joinpath(f"{name}.toml"))), Language)
    if not (folder / name).is_file():
        known = ", ".join(["en", *shipped])
        raise InputError(f"language: expected one of {known}, or a file of the folder, got '{name:.50}'")
    return read_settings(folder / name, Language)


def script(texts: Mapping[str, str]) -> str:
    """What the page reads of it."""
    return f'"use strict";\nconst texts = {json.dumps(dict(texts), ensure_ascii=False)};\n'
