"""``serendipity interruptions`` on the command line."""

import json
import xml.etree.ElementTree as ET
from pathlib import Path
from typing import Any

import pytest

import serendipity
from tests.cli.conftest import Runs


@pytest.fixture
def data(run: Runs) -> dict[str, Any]:
    """The report on room2 as JSON."""
    read: dict[str, Any] = json.loads(run("interruptions --example room2 --discount 0.6 --format json").out)
    return read


def test_table_json_and_map_agree(run: Runs, data: dict[str, Any], tmp_path: Path) -> None:
    shown = run("interruptions --example room2 --discount 0.6 --all --heat-map map.svg")
    assert (shown.code, shown.err) == (0, "")
    assert data["schema"] == "serendipity.interruptions/1"
    assert data["interruptible"]
    rows = [line.split() for line in shown.out.splitlines()[3:]]
    assert len(rows) == len(data["windows"]) == 91
    drawn = [e.text or "" for e in ET.parse(tmp_path / "map.svg").iter() if e.tag.endswith("}title")][1:]
    for i, (row, entry) in enumerate(zip(rows, data["windows"], strict=True)):
        window = f"[{entry['window']['start']}, {entry['window']['end']})"
        assert " ".join(row[:2]) == window
        costs = [entry[name] for name in ("human_cost", "team_cost", "human_saving", "team_saving")]
        assert [float(cell) for cell in row[2:6]] == costs
        assert drawn[i] == f"{window}: saves {entry['human_saving']:.3g}"
        assert drawn[91 + i] == f"{window}: saves {entry['team_saving']:.3g}"


def test_only_windows_that_say_something_are_printed(run: Runs, data: dict[str, Any]) -> None:
    lines = run("interruptions --example room2 --discount 0.6").out.splitlines()
    assert lines[1].startswith("4 of 91 windows")
    printed = [" ".join(line.split()[:2]) for line in lines[4:]]
    assert printed == ["[5, 6)", "[6, 7)", "[7, 8)", "[8, 9)"]
    informative = [e["window"] for e in data["windows"] if e["informative"]]
    assert printed == [f"[{window['start']}, {window['end']})" for window in informative]


@pytest.mark.parametrize("discount", ["0.6", "0.9"])
def test_no_window_within_an_informative_one_saves_as_much(discount: str) -> None:
    report = serendipity.interruptions(serendipity.example("room5"), discount=discount)
    for entry in report.windows:
        within = [
            other
            for other in report.windows
            if entry.window.start <= other.window.start
            and other.window.end <= entry.window.end
            and other.window != entry.window
        ]
        news = False
        for saving in ("human_saving", "team_saving"):
            own = getattr(entry, saving) or 0
            news |= own > 0 and all(own > (getattr(other, saving) or 0) for other in within)
        assert entry.informative == news


def test_a_human_without_a_plan(run: Runs, tmp_path: Path) -> None:
    serendipity.generate_usar(tmp_path / "task", rooms=5, medkits=1, seed=1)
    for problem in (tmp_path / "task").glob("*/problem.pddl"):
        lines = problem.read_text().splitlines()
        problem.write_text("\n".join(line for line in lines if "(at mk1" not in line))
    done = run("interruptions task")
    assert done.code == 3, done
    assert "no plan to interrupt" in done.out


def test_progress_counts_two_searches_for_each_window() -> None:
    seen: list[tuple[int, int]] = []
    report = serendipity.interruptions(
        serendipity.example("room2"), on_progress=lambda done, total: seen.append((done, total))
    )
    assert seen == [(done, 2 * len(report.windows)) for done in range(1, 2 * len(report.windows) + 1)]


def test_the_map_as_png(run: Runs, tmp_path: Path) -> None:
    pytest.importorskip("matplotlib", reason="needs the extra serendipity-planner[plot]")
    assert run("interruptions --example room2 --discount 0.6 --heat-map map.png").code == 0
    assert (tmp_path / "map.png").read_bytes().startswith(b"\x89PNG")
