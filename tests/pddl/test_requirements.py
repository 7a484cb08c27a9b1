"""What files say they require is read: what is supported may be missing, the rest is named."""

from pathlib import Path

import pytest

from serendipity import InputError
from serendipity.pddl.parsing.sections import SUPPORTED, UNSUPPORTED
from tests.pddl.texts import action, domain, one, problem

TEXT = domain(action("go", "(or (q) (exists (?x) (a ?x)))", "(p) (when (q) (r)) (increase (total-cost) 1)"))


def required(folder: Path, words: str) -> str:
    """The error of a domain that requires this in its line 3; empty if it loads."""
    text = TEXT.replace("(:types", f"\n(:requirements {words})\n(:types", 1)
    try:
        one(folder, text, problem("(q)"))
    except InputError as error:
        assert (error.file, error.line) == (str(folder / "domain.pddl"), 3)
        return error.message
    return ""


def test_what_is_supported_may_be_required_or_not(tmp_path: Path) -> None:
    assert required(tmp_path, " ".join(sorted(SUPPORTED))) == ""
    assert required(tmp_path, "") == ""
    assert one(tmp_path, TEXT, problem("(q)")).actions


@pytest.mark.parametrize("requirement", sorted(UNSUPPORTED))
def test_what_is_not_supported_is_named(tmp_path: Path, requirement: str) -> None:
    message = required(tmp_path, f":strips {requirement}")
    assert message.startswith(f"{UNSUPPORTED[requirement]} ('{requirement}') are not supported")


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (":strips :telepathy", "requirement ':telepathy' is not known"),
        ("strips", "expected a requirement, as ':typing', got 'strips'"),
        ("(:strips)", "expected a requirement, as ':typing', got '(:strips)'"),
    ],
)
def test_what_is_no_requirement(tmp_path: Path, words: str, message: str) -> None:
    assert message in required(tmp_path, words)


def test_brackets_in_requirements_that_never_close(tmp_path: Path) -> None:
    text = TEXT.replace("(:types", "(:requirements (((( \n(:types", 1)
    with pytest.raises(InputError, match=r"domain.pddl:7: the file ends too early: .* '\)' for line 2"):
        one(tmp_path, text, problem("(q)"))


def test_a_problem_may_require_as_well(tmp_path: Path) -> None:
    assert one(tmp_path, TEXT, problem("(q)", more="(:requirements :adl)")).actions
    with pytest.raises(InputError, match=r"problem.pddl:6: preferences"):
        one(tmp_path, TEXT, problem("(q)", more="(:requirements :preferences)"))
