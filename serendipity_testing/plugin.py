"""A plugin of pytest: ``pytest --serendipity-planner package.module:function`` checks a planner.

It adds a test for each mode, against brute force, and one for each law (:mod:`serendipity_testing.laws`).
Nothing but options is added, and nothing loaded, where no planner is named.
"""

import shlex
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

import pytest

if TYPE_CHECKING:
    from serendipity_testing.checking import Check, Draw, Probed
    from serendipity_testing.judges import OutsideJudge

_PLANNER: Final = "--serendipity-planner"
_LISTS: Final = ("modes", "options")
_NUMBERS: Final = ("actions", "seed", "count")


def pytest_addoption(parser: pytest.Parser) -> None:
    """The options of the plugin."""
    group = parser.getgroup("serendipity", "checking a planner (serendipity_testing)")
    group.addoption(
        _PLANNER,
        action="append",
        default=[],
        metavar="PACKAGE.MODULE:FUNCTION",
        help="a planner to check, as for `serendipity crosscheck --judge`; may be repeated",
    )
    group.addoption(
        "--serendipity-modes",
        default="serendipity",
        metavar="MODE,...",
        help="what a planner of all modes is asked: serendipity, communication, composite, individual",
    )
    group.addoption(
        "--serendipity-options",
        default="discount,window_weight",
        metavar="NAME,...",
        help="options that calls differ in; also human_plan",
    )
    group.addoption(
        "--serendipity-actions", type=int, default=30, metavar="N", help="ground actions of a task at most"
    )
    group.addoption("--serendipity-seed", type=int, default=0, metavar="S", help="of the first random call")
    group.addoption("--serendipity-count", type=int, default=100, metavar="N", help="random calls of a check")
    group.addoption(
        "--serendipity-call-limit",
        type=float,
        default=60.0,
        metavar="SECONDS",
        help="for each call: a planner that takes longer is ended, and wrong",
    )
    group.addoption(
        "--serendipity-cases",
        type=Path,
        default=Path("serendipity-cases"),
        metavar="DIR",
        help="where smallest cases are written",
    )


@pytest.hookimpl(tryfirst=True)
def pytest_collection_modifyitems(
    session: pytest.Session, config: pytest.Config, items: list[pytest.Item]
) -> None:
    """Add the checks of the planners that were named."""
    names = config.getoption(_PLANNER)
    if not names:
        return
    from serendipity.model import UsageError
    from serendipity_testing.checking import checks
    from serendipity_testing.judges import by_name

    try:
        scope = _scope(config)
        for name in names:
            judge = by_name(name)
            added: list[pytest.Item | pytest.Collector] = [
                _PlannerItem.from_parent(
                    session, name=str(check), nodeid=f"{name}::{check}", asks=(judge, check, scope)
                )
                for check in checks(judge, scope)
            ]
            config.hook.pytest_collectreport(report=pytest.CollectReport(name, "passed", None, added))
            items += [item for item in added if isinstance(item, pytest.Item)]
    except UsageError as error:
        raise pytest.UsageError(f"serendipity: {error}") from None


def _scope(config: pytest.Config) -> "Draw":
    from serendipity_testing.checking import Draw

    given: dict[str, Any] = {name: config.getoption(f"--serendipity-{name}") for name in _NUMBERS}
    given["call_limit"] = config.getoption("--serendipity-call-limit")
    for name in _LISTS:
        words = config.getoption(f"--serendipity-{name}").replace("-", "_").split(",")
        given[name] = tuple(word.strip() for word in words if word.strip())
    return Draw(**given)


class _WrongError(Exception):
    """The planner is wrong; the text is the report."""


class _PlannerItem(pytest.Item):
    """One check of one planner."""

    def __init__(self, *, asks: "tuple[OutsideJudge, Check, Draw]", **given: Any) -> None:
        super().__init__(**given)
        self._judge, self._check, self._scope = asks

    def runtest(self) -> None:
        """Ask, and fail with the smallest case."""
        from serendipity_testing.checking import run
        from serendipity_testing.reporting import report

        outcome = run(self._judge, self._check, self._scope)
        if outcome.found is not None:
            folder = self.config.getoption("--serendipity-cases")
            again = self._again(outcome)
            raise _WrongError(report(self._judge, self._check, outcome, outcome.found, folder, again))
        if outcome.refused == outcome.calls:
            pytest.skip(f"{self._judge.name} has no answer to any of the {outcome.calls} calls")
        answered = outcome.calls - outcome.refused
        self.user_properties.append(("serendipity", f"{answered} of {outcome.calls} calls answered"))

    def _again(self, outcome: "Probed") -> str:
        words = ["pytest", _PLANNER, self._judge.name]
        for name in (*_LISTS, "actions"):
            value = getattr(self._scope, name)
            if value != getattr(type(self._scope)(), name):
                words += [f"--serendipity-{name}", str(value) if name == "actions" else ",".join(value)]
        words += ["--serendipity-seed", str(outcome.seed), "--serendipity-count", "1", "-k", self.name]
        return shlex.join(words)

    def repr_failure(self, excinfo: Any, style: Any = None) -> Any:
        """The report alone, where there is one."""
        if isinstance(excinfo.value, _WrongError):
            return str(excinfo.value)
        return super().repr_failure(excinfo, style)

    def reportinfo(self) -> tuple[Path, None, str]:
        """Its place, for summaries: nowhere, so its name."""
        return self.config.rootpath, None, self.nodeid
