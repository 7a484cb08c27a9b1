"""The HTML report and the charts in it."""

import re
import sys
import xml.etree.ElementTree as ET
from pathlib import Path

import pytest

from serendipity.evaluation.measuring.plots import Labels, bars, lines
from serendipity.evaluation.reproduction import Reproduction, reproduce
from serendipity.evaluation.reproduction.report import html_report
from serendipity.evaluation.reproduction.tables import tables


@pytest.fixture(scope="module")
def run(suite: Path) -> Reproduction:
    return reproduce(suite, modes=["individual", "serendipity", "communication"], discounts=["0.6", "0.9"])


@pytest.mark.long
def test_the_page_needs_nothing_else(run: Reproduction) -> None:
    pytest.importorskip("matplotlib", reason="needs the extra 'plot'")
    page = html_report(run, tables(run))
    assert page.startswith("<!doctype html>")
    assert not re.search(r"<(script|link|img|iframe)|@import|(url\(|(src|href)=\")(?!#)", page)
    charts = re.findall(r"<svg.*?</svg>", page, re.S)
    assert len(charts) == 4
    for chart in charts:
        ET.fromstring(chart)
    names = re.findall(r'\bid="([^"]*)"', page)
    assert len(names) == len(set(names))
    assert "12.8667 (2)" in page  # serendipity at 0.6: two of six save 0.4


def test_a_page_without_opportunities(suite: Path) -> None:
    run = reproduce(suite, modes=["individual"], discounts=["0"])
    assert "<h1>" in html_report(run, tables(run))


def test_a_page_without_matplotlib_has_its_tables(run: Reproduction, monkeypatch: pytest.MonkeyPatch) -> None:
    for name in [name for name in sys.modules if name.startswith("matplotlib")]:
        monkeypatch.delitem(sys.modules, name)
    monkeypatch.setitem(sys.modules, "matplotlib", None)
    page = html_report(run, tables(run))
    assert "12.8667 (2)" in page
    assert "plots need matplotlib: pip install serendipity-planner[plot]" in page


def test_counts_have_whole_ticks() -> None:
    """Charts of one or two tasks had ticks at 0.2 and 1.5 of them."""
    pytest.importorskip("matplotlib", reason="needs the extra 'plot'")
    for chart in (
        lines(Labels("t", "", ""), {"a": [(0, 0), (1, 2)]}),
        bars(Labels("t", "", ""), ["g"], {"a": [1]}),
    ):
        axis = chart[chart.index('id="t-matplotlib.axis_2"') :]
        ticks = re.findall(r'text-anchor: end"[^>]*>([^<]*)<', axis)
        assert ticks in (["0", "1", "2"], ["0", "1"])
