"""The HTML report and the charts in it."""

import re
import xml.etree.ElementTree as ET
from pathlib import Path

import pytest

from serendipity.evaluation.reproduction import Reproduction, reproduce
from serendipity.evaluation.reproduction.charts import Labels, bars, lines
from serendipity.evaluation.reproduction.report import html_report
from serendipity.evaluation.reproduction.tables import tables


@pytest.fixture(scope="module")
def run(suite: Path) -> Reproduction:
    return reproduce(suite, modes=["individual", "serendipity", "communication"], discounts=["0.6", "0.9"])


def test_the_page_needs_nothing_else(run: Reproduction) -> None:
    page = html_report(run, tables(run))
    assert page.startswith("<!doctype html>")
    assert not re.search(r"<(script|link|img|iframe)|@import|url\(|(src|href)=", page)
    charts = re.findall(r"<svg.*?</svg>", page, re.S)
    assert len(charts) == 4
    for chart in charts:
        ET.fromstring(chart)
    assert "12.8667 (2)" in page  # serendipity at 0.6: two of six save 0.4


def test_a_page_without_opportunities(suite: Path) -> None:
    run = reproduce(suite, modes=["individual"], discounts=["0"])
    assert "<h1>" in html_report(run, tables(run))


def test_lines_meet_their_points() -> None:
    chart = lines(Labels("t", "x", "y"), {"a": [(0, 0), (10, 5)], "b <": [(5, 2.5)]})
    root = ET.fromstring(chart)
    paths = [e.attrib["points"].split() for e in root.iter() if e.tag.endswith("polyline")]
    (first, last), (middle,) = [[tuple(map(float, p.split(","))) for p in path] for path in paths]
    assert first[0] < middle[0] < last[0]
    assert first[1] > middle[1] > last[1]
    assert middle == pytest.approx(((first[0] + last[0]) / 2, (first[1] + last[1]) / 2), abs=0.1)


def test_bars_are_as_high_as_their_values() -> None:
    root = ET.fromstring(bars(Labels("t", "x", "y"), ["g", "h"], {"a": [1, 2], "b": [0, 4]}))
    heights = [float(e.attrib["height"]) for e in root.iter() if e.tag.endswith("rect")]
    assert heights == pytest.approx([heights[3] / 4, 0, heights[3] / 2, heights[3]], abs=0.2)


def test_counts_have_whole_ticks() -> None:
    """Charts of one or two tasks had ticks at 0.2 and 1.5 of them."""
    counts = {"a": [(0.0, 0), (0.5, 2)]}
    for chart in (
        lines(Labels("t", "x", "tasks"), counts),
        bars(Labels("t", "x", "tasks"), ["g"], {"a": [1]}),
    ):
        ticks = [e.text for e in ET.fromstring(chart).iter() if e.attrib.get("text-anchor") == "end"]
        assert ticks in (["0", "1", "2"], ["0", "1"])
