"""A study in another language: everything that participants read, from one file."""

import json
import re
from importlib.resources import files
from pathlib import Path

import pytest

from serendipity.live.play.language import Language, language
from serendipity.live.study.design import open_design
from serendipity.model import InputError, UsageError
from tests.live.studies import PLAIN, join, opened, say

PAGE = files("serendipity.live.play").joinpath("page")
CODE = ("play.js", "study.js")
SAID = [
    files("serendipity.live").joinpath(*where)
    for where in (("play", "clock.py"), ("play", "labels.py"), ("play", "round.py"), ("study", "design.py"))
]
GERMAN = language("de", Path())


def said_by_code() -> set[str]:
    """The texts that are said in the language of the page."""
    script = "".join(PAGE.joinpath(name).read_text(encoding="utf-8") for name in CODE)
    found = set(re.findall(r"\bt\(\"([^\"]*)\"", script))
    python = "".join(file.read_text(encoding="utf-8") for file in SAID)
    return found | set(re.findall(r"(?:_say|language)\(\s*\"([^\"]+)\"", python))


def on_page() -> set[str]:
    html = PAGE.joinpath("play.html").read_text(encoding="utf-8").partition("<body>")[2]
    found = {text.strip() for text in re.findall(r">([^<]+)<", html)}
    return {text for text in found if re.search(r"[a-z]{2}", text)} - {"Serendipity"}


def test_every_text_has_its_translation_and_none_is_left_over() -> None:
    assert GERMAN.texts.keys() == said_by_code() | on_page()


def test_what_is_put_into_a_text_is_put_into_its_translation() -> None:
    for text, translated in GERMAN.texts.items():
        assert sorted(re.findall(r"{\w+}", text)) == sorted(re.findall(r"{\w+}", translated))


@pytest.mark.long
def test_a_study_speaks_german(tmp_path: Path) -> None:
    (tmp_path / "study.toml").write_text(
        'language = "de"\nconsent = ["Ja?"]\nconditions = ["none", "announced"]\n'
    )
    study = opened(tmp_path, rounds=1, seed=1)
    assert study.texts["Begin"] == "Beginnen"
    assert study.consent() == ["Ja?"]
    room = join(study)
    text = " ".join(room.view()["study"]["text"])
    assert "Sanitäter" in text and "zur Übung" in text
    view = say(room, "go on")
    assert view["goal"][0]["text"].startswith("Den Patienten in ")
    assert {choice["text"].split()[0] for choice in view["can"]} <= {"nach", "warten", "Verbandkasten"}
    assert open_design(tmp_path).texts.questions[1].text == "Der Roboter hat mir geholfen."
    assert json.loads((tmp_path / "study.json").read_text())["language"]["comment"] == "Noch etwas?"


def test_the_command_line_says_the_language_where_the_file_does_not(tmp_path: Path) -> None:
    (tmp_path / "study.toml").write_text(PLAIN)
    assert open_design(tmp_path, language="de").language == GERMAN
    assert open_design(tmp_path).language == GERMAN, "as it was begun"
    with pytest.raises(UsageError, match=r"^--language: the study in .* was begun with de; take another"):
        open_design(tmp_path, language="en")
    told = tmp_path / "told"
    told.mkdir()
    (told / "study.toml").write_text('language = "de"\n' + PLAIN)
    with pytest.raises(UsageError, match=r"^--language: .*study\.toml says de$"):
        open_design(told, language="en")


def test_a_file_of_the_study_is_a_language_too(tmp_path: Path) -> None:
    (tmp_path / "fr.toml").write_text('[texts]\nBegin = "Commencer"\n')
    assert language("fr.toml", tmp_path).texts == {"Begin": "Commencer"}
    assert language("en", tmp_path) == Language()


@pytest.mark.parametrize(
    ("name", "text", "fault"), [("xx", "", "expected one of en, de"), ("x.toml", "a = 1", "a")]
)
def test_what_is_no_language_is_refused(tmp_path: Path, name: str, text: str, fault: str) -> None:
    (tmp_path / "x.toml").write_text(text)
    with pytest.raises(InputError, match=fault):
        language(name, tmp_path)
