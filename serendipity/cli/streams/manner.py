"""How a command tells what it does on its way: quietly or not, how far it is, and a log."""

import sys
from contextvars import ContextVar
from typing import Annotated, Final

from serendipity.cli.choices import option
from serendipity.cli.groups import OptionGroup
from serendipity.model import UsageError

STYLES: Final = ("auto", "plain", "json", "none")
"""Of progress; ``auto``: a bar on a terminal, plain lines elsewhere."""

_quiet: ContextVar[bool] = ContextVar("quiet", default=False)
_style: ContextVar[str] = ContextVar("style", default=STYLES[0])
_verbosity: ContextVar[int] = ContextVar("verbosity", default=0)


def is_quiet() -> bool:
    """Whether neither warnings nor progress are wanted in this call of the command line."""
    return _quiet.get()


def style() -> str:
    """How progress is shown in this call of the command line."""
    return "none" if is_quiet() else _style.get()


def is_verbose() -> bool:
    """Whether more is wanted on stderr than what goes wrong in this call of the command line (``-v``)."""
    return _verbosity.get() > 0


def be_quiet(quiet: bool) -> None:
    """Set whether warnings and progress are wanted; what is logged of a missing kernel is a warning, too."""
    _quiet.set(quiet)
    if quiet or "logging" in sys.modules:
        import logging

        logging.getLogger("search.kernel").setLevel(logging.ERROR if quiet else logging.NOTSET)


def _choose(wanted: str) -> None:
    if wanted not in STYLES:
        raise UsageError(f"--progress: expected one of {', '.join(STYLES)}, got '{wanted}'")
    _style.set(wanted)


def start_logging(verbosity: int) -> None:
    """Log to stderr: nothing but warnings at 0, more at 1 (``-v``), everything at 2."""
    _verbosity.set(verbosity)
    if not verbosity and "logging" not in sys.modules:
        return  # it takes longer to load than many a plan to find
    import logging

    level = (logging.WARNING, logging.INFO, logging.DEBUG)[min(verbosity, 2)]
    handler = logging.StreamHandler(sys.stderr)
    handler.setFormatter(logging.Formatter("%(levelname)s %(name)s: %(message)s"))
    for name in ("serendipity", "search", "verify"):
        logger = logging.getLogger(name)
        logger.handlers = [handler]  # of this call; one of an earlier call would write everything twice
        logger.setLevel(level)


def log_origin() -> None:
    """Log where the error that is being handled came from (``-vv``)."""
    if "logging" in sys.modules:
        import logging

        logging.getLogger("serendipity").debug("the error came from here", exc_info=True)


class Manner(OptionGroup):
    """Options that every command has, and that none needs to know: each is heeded when it is read."""

    quiet: Annotated[
        bool, option("--quiet, -q", "No warnings and no progress on stderr.", callback=be_quiet)
    ] = False
    progress: Annotated[
        str,
        option(
            f"--progress {'|'.join(STYLES)}",
            "How progress is shown: a bar on a terminal, plain lines elsewhere; or JSON lines.",
            callback=_choose,
            show_default=False,
        ),
    ] = "auto"
    verbose: Annotated[
        int, option("--verbose, -v", "Log to stderr; -vv logs more.", count=True, callback=start_logging)
    ] = 0
