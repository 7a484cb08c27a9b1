"""What is public is there, and is written down: a change to it shows in the commit that makes it.

What type checkers are told of options is what ``Options`` takes; they see what is wrong in a user's program.
"""

import inspect
import json
import re
import shutil
import subprocess
import sys
from dataclasses import fields
from difflib import unified_diff
from importlib.util import find_spec
from pathlib import Path
from types import UnionType
from typing import Any, Literal, Union, get_args, get_origin, get_type_hints

import pytest

import serendipity
from serendipity.facade.session import AnytimeOptions, SessionOptions
from serendipity.model import Options, PlanOptions, UsageError
from serendipity.model.keywords import CHOICES, AnswerOptions, InterruptionOptions
from tests.release.surface import WRITTEN, surface

RENEW = "The public surface is another one (docs/reference/stability.md): `python -m tests.release.surface`"


@pytest.mark.skipif(find_spec("unified_planning") is None, reason="the extra `up` is not installed")
def test_the_public_surface_is_the_one_that_is_written_down() -> None:
    before, after = WRITTEN.read_text(encoding="utf-8").splitlines(), surface().splitlines()
    differing = unified_diff(before, after, "written", "now", lineterm="", n=0)
    assert before == after, "\n".join([RENEW, *differing])


ROOT = Path(__file__).resolve().parents[2]


@pytest.mark.parametrize("name", serendipity.__all__)
def test_every_public_name_loads(name: str) -> None:
    assert getattr(serendipity, name) is not None
    assert name in dir(serendipity)


def test_other_names_are_attribute_errors() -> None:
    with pytest.raises(AttributeError, match="'plans'"):
        serendipity.plans  # noqa: B018


PACKAGES = ("serendipity", "search", "verify", "serendipity_live", "serendipity_testing", "serendipity_up")


@pytest.mark.parametrize("package", PACKAGES)
def test_annotations_are_for_others_too(package: str) -> None:
    assert (ROOT / package / "py.typed").exists()


PROGRAM = Path(__file__).parent / "user_program.py"
WRONG = {
    number
    for number, line in enumerate(PROGRAM.read_text(encoding="utf-8").splitlines(), start=1)
    if re.search(r"# type: ignore\[", line)
}


@pytest.mark.slow  # in quick runs options are held to their types below
def test_mypy_sees_what_is_wrong(tmp_path: Path) -> None:
    command = [sys.executable, "-m", "mypy", "--strict", "--config-file=", f"--cache-dir={tmp_path}", PROGRAM]
    done = subprocess.run(command, capture_output=True, text=True, check=False, cwd=tmp_path)
    assert done.returncode == 0, done.stdout  # strict: a mark on a line that is right is an error, too


@pytest.mark.skipif(shutil.which("pyright") is None, reason="pyright is not installed")
def test_pyright_sees_what_is_wrong(tmp_path: Path) -> None:
    shutil.copy(PROGRAM, tmp_path)
    settings = {"typeCheckingMode": "strict", "enableTypeIgnoreComments": False}
    (tmp_path / "pyrightconfig.json").write_text(json.dumps(settings), encoding="utf-8")
    command = ["pyright", "--outputjson", "--pythonpath", sys.executable, "-p", str(tmp_path)]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    found = json.loads(done.stdout)["generalDiagnostics"]
    assert {each["range"]["start"]["line"] + 1 for each in found} == WRONG, found


DECLARED = get_type_hints(PlanOptions)
NEEDED = {"human_model": {"mode": "serendipity"}, "keep_prefix": {"mode": "communication"}}


def fits(value: object, hint: Any) -> bool:
    """Whether a type checker lets a value pass; it tells texts apart where they are listed."""
    if get_origin(hint) in (Union, UnionType):
        return any(fits(value, part) for part in get_args(hint))
    if get_origin(hint) is Literal:
        return value in get_args(hint)
    return type(value) is hint or (hint is float and type(value) is int)


def test_every_option_is_typed() -> None:
    assert set(DECLARED) == {field.name for field in fields(Options)}


@pytest.mark.parametrize("name", DECLARED)
def test_the_default_has_the_type(name: str) -> None:
    assert fits(getattr(Options(), name), DECLARED[name])


@pytest.mark.parametrize("name", DECLARED)
def test_names_none_and_flags_are_taken_where_the_type_says_so(name: str) -> None:
    for value in (None, True, *sum(CHOICES.values(), ())):
        try:
            Options(**{**NEEDED.get(name, {}), name: value})
            taken = True
        except UsageError:
            taken = False
        if not (isinstance(value, str) and str in get_args(DECLARED[name])):  # any text that says a number
            assert taken == fits(value, DECLARED[name]), value


@pytest.mark.parametrize(("name", "word"), [("horizon", "inf"), ("max_cost", "human")])
def test_words_are_typed(name: str, word: str) -> None:
    assert getattr(Options(mode="composite", **{name: word}), name) == word
    assert fits(word, DECLARED[name])


@pytest.mark.parametrize(
    ("function", "kind"),
    [
        (serendipity.plan, PlanOptions),
        (serendipity.plan_anytime, PlanOptions),
        (serendipity.Session, SessionOptions),
        (serendipity.Session.plan, SessionOptions),
        (serendipity.Session.plan_anytime, AnytimeOptions),
        (serendipity.explain, AnswerOptions),
        (serendipity.interruptions, InterruptionOptions),
    ],
)
def test_signatures_list_the_options(function: Any, kind: Any) -> None:
    listed = inspect.signature(function).parameters
    assert kind.__annotations__.keys() <= listed.keys()
    assert all(each.kind is not each.VAR_KEYWORD for each in listed.values())


def test_what_executions_hand_on_is_what_they_take() -> None:
    handed_on = inspect.signature(serendipity.execute).parameters
    taken = inspect.signature(serendipity.Execution).parameters
    for name in ("discount", "deadline", "setup", "beta", "mode", "interference"):
        assert handed_on[name].annotation == taken[name].annotation


@pytest.mark.parametrize("name", ["time_limit", "memory_limit"])
def test_a_limit_without_an_end_is_none(name: str) -> None:
    for endless in (float("inf"), "inf"):
        assert Options(**{name: endless}) == Options()  # JSON has no infinity
