"""What a study is before anybody takes part: what scenarios show, who gets what, what is refused.

In another language everything that participants read is from one file.
"""

import json
import re
from collections import Counter
from fractions import Fraction
from importlib.resources import files
from itertools import islice, pairwise
from pathlib import Path

import pytest

import serendipity
from serendipity.cli.app import main
from serendipity.model import InputError, UsageError
from serendipity_live.play.language import Language, language
from serendipity_live.play.round import CONDITIONS, RoundSetting
from serendipity_live.study.design import open_design
from serendipity_live.study.drawing import draw, fault, order, places, rehearse
from serendipity_live.tests.studies import PLAIN, join, opened, say

NAMES = tuple(CONDITIONS)


def test_drawn_scenarios_show_what_conditions_promise() -> None:
    drawn = list(draw(2, 5, NAMES, discount=Fraction(3, 5)))
    assert len({setting.name for setting, _ in drawn}) == 2
    for setting, played in drawn:
        alone = serendipity.plan(setting.task, mode="individual").cost
        assert (played["none"].helped, played["none"].cost) == (0, alone)
        assert alone > played["silent"].cost > played["announced"].cost
        assert played == rehearse(setting, NAMES)


@pytest.mark.slow
def test_in_the_default_study_conditions_differ_in_ten_of_ten() -> None:
    for seed in (1, 2, 3):
        for _, played in draw(10, seed, NAMES, discount=Fraction(3, 5)):
            assert len({played[name].human_cost for name in NAMES}) == 3


def test_scenarios_follow_from_the_seed() -> None:
    def names(seed: int) -> list[str]:
        return [setting.name for setting, _ in draw(1, seed, ("none", "silent"), discount=Fraction(3, 5))]

    assert names(1) == names(1)
    assert names(1) != names(2)


def test_a_scenario_in_which_conditions_do_not_differ_is_refused(folder: Path, capsys) -> None:
    text = PLAIN.replace('conditions = ["none", "silent"]', "")
    (folder / "study.toml").write_text(text)
    assert main(["play", "--quiet", "--study", str(folder)]) == 2
    said = capsys.readouterr().err
    assert said == (
        "Error: scenario handed over: silent and announced come to the same when somebody plays it who"
        " plays well\n"
    )
    (folder / "study.toml").write_text(PLAIN.replace("room2", "room7"))
    with pytest.raises(UsageError, match="silent robots save nothing"):
        open_design(folder)


def test_what_is_no_scenario_of_a_condition() -> None:
    played = rehearse(RoundSetting("taxis", serendipity.example("taxis"), Fraction(1, 2)), NAMES)
    assert fault(played, NAMES) is None
    assert fault({**played, "silent": played["none"]}, ("none", "silent")) == "silent robots save nothing"
    lost = {
        **played,
        "silent": rehearse(RoundSetting("x", serendipity.example("room2"), Fraction(0), most_epochs=3), ())[
            "none"
        ],
    }
    assert fault(lost, ("none", "silent")) == "the goal is not reached where robots are silent"


def test_the_report_says_what_conditions_come_to(folder: Path, capsys) -> None:
    assert main(["play", "--quiet", "--study", str(folder), "--report"]) == 0
    assert (
        "condition silent helps in 2 of 2, saves 0.5 in the mean (1.5 for the person)"
        in capsys.readouterr().out
    )


def test_conditions_and_orders_are_balanced() -> None:
    drawn = list(islice(places(NAMES, 4, seed=7), 24))
    for block in (drawn[:12], drawn[12:]):
        assert sorted(block) == sorted((name, row) for name in NAMES for row in range(4))
    names = [name for name, _ in drawn]
    for count in range(1, 25):
        spread = Counter(names[:count])
        assert max(spread.values()) - min(spread[name] for name in NAMES) <= 2


def test_nobody_can_tell_the_next_condition_from_those_before() -> None:
    last = set()
    for seed in range(60):
        names = [name for name, _ in islice(places(NAMES, 4, seed), 3)]
        last.add(len(set(names)))
    assert last == {2, 3}, "the third is not always the one that is left"


@pytest.mark.parametrize("count", range(1, 8))
def test_orders_are_balanced(count: int) -> None:
    rows = [order(row, count) for row in range(count * (1 + count % 2))]
    assert all(sorted(row) == list(range(count)) for row in rows)
    for place in range(count):
        assert len(set(Counter(row[place] for row in rows).values())) == 1
    behind = Counter(pair for row in rows for pair in pairwise(row))
    assert len(behind) == count * (count - 1)
    assert len(set(behind.values())) <= 1


def test_a_study_that_was_begun_otherwise_is_refused(folder: Path) -> None:
    first = open_design(folder, seed=4)
    assert open_design(folder).mark == first.mark
    with pytest.raises(UsageError, match=r"--seed: the study in .* was begun with 4"):
        open_design(folder, seed=5)
    with pytest.raises(UsageError, match=r"--discount: the study in .* was begun with 3/5"):
        open_design(folder, discount="9/10")
    (folder / "study.toml").write_text(PLAIN.replace("good", "bad"))
    with pytest.raises(InputError, match="not what the study was begun with"):
        open_design(folder)


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("consent = []", "consent: "),
        ('conditions = ["loud"]', "conditions: expected some of none, silent, announced"),
        ('[[questions]]\ntext = "a"\nkind = "choice"', "choices: go with kind = 'choice'"),
        ('[[questions]]\ntext = "a"\npoints = 100', "questions.0.points: "),
        ('[[scenarios]]\nname = "a"', "scenario a: expected an example, or files"),
        ('[[scenarios]]\nname = "a"\nexample = "x"', "scenario a: example: expected one of"),
        ('[[scenarios]]\nname = "a"\nfiles = ["x"]', "scenario a: "),
        ("speed = 3", "speed: extra inputs"),
        ("[[comprehension]]\ntext = 'Why?'", "each question says what to expect"),
        ("[[questions]]\ntext = 'Why?'\nexpect = 9", "expect: expected a whole number from 1 to 7"),
        ("tries = 0", "tries"),
        ('completion_link = "javascript:alert(1)"', "completion_link: "),
    ],
)
def test_a_wrong_study_file_is_one_line(text: str, said: str, tmp_path: Path, capsys) -> None:
    (tmp_path / "study.toml").write_text(text)
    assert main(["play", "--quiet", "--study", str(tmp_path)]) == 2
    error = capsys.readouterr().err
    assert said in error
    assert error.count("\n") == 1
    assert "study.toml" in error


PAGE = files("serendipity_live.play").joinpath("page")
CODE = ("play.js", "study.js")
SAID = [
    files("serendipity_live").joinpath(*where)
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
