"""Figures by matplotlib (the optional extra ``plot``), and the files and pages that they go to."""

import io
import re
from typing import TYPE_CHECKING, Final

from serendipity.model.errors import UsageError
from serendipity.model.printable import markup

if TYPE_CHECKING:
    from matplotlib.figure import Figure

COLOURS: Final = ("#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#000000")
"""The Okabe-Ito palette: told apart by everybody."""

SUFFIXES: Final = (".png", ".svg", ".pdf")


def figure(width: float, height: float) -> "Figure":
    """An empty figure, in inches.

    Raises:
        UsageError: matplotlib is not installed.
    """
    try:
        from matplotlib.backends.backend_agg import FigureCanvasAgg
        from matplotlib.figure import Figure
    except ImportError:
        raise UsageError("plots need matplotlib: pip install serendipity-planner[plot]") from None
    empty = Figure(figsize=(width, height), layout="constrained")
    FigureCanvasAgg(empty)
    return empty


def as_bytes(drawn: "Figure", suffix: str) -> bytes:
    """A figure as a file with that suffix."""
    buffer = io.BytesIO()
    drawn.savefig(buffer, format=suffix.removeprefix("."), dpi=120)
    return buffer.getvalue()


def as_svg(drawn: "Figure", title: str) -> str:
    """A figure as an element of a page.

    Args:
        drawn: the figure.
        title: of it; no other figure of the page has the same, for their parts are told apart by it.
    """
    from matplotlib import rc_context

    with rc_context({"svg.fonttype": "none", "svg.hashsalt": title}):
        text = as_bytes(drawn, ".svg").decode()
    element = re.sub(r"<metadata>.*?</metadata>", "", text[text.index("<svg") :], flags=re.S)
    own = re.sub(r"\W+", "-", title)
    element = re.sub(r'(\bid="|href="#|url\(#)', rf"\1{own}-", element)
    return element.replace("<svg", f'<svg role="img" aria-label="{markup(title)}"', 1)
