"""What type checkers are told of options is what ``Options`` takes."""

import inspect
from dataclasses import fields
from types import UnionType
from typing import Any, Literal, Union, get_args, get_origin, get_type_hints

import pytest

import serendipity
from serendipity.facade.session import AnytimeOptions, SessionOptions
from serendipity.model import Options, PlanOptions, UsageError
from serendipity.model.keywords import CHOICES, AnswerOptions, InterruptionOptions

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
