"""The page in a real Chromium: it plays, listens to keys, asks for nothing, and fits every screen.

Skipped, with a message, where playwright or Chromium is absent; ``make test-browser`` installs them.
"""

import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

import serendipity
from serendipity.pictures import Scene, draw

pytestmark = pytest.mark.browser

LABELS = (Path(__file__).parent / "labels.js").read_text(encoding="utf-8")
_MARKS = re.compile(r"translate\(([-0-9.]+)px, ([-0-9.]+)px\)")


class Opened:
    """A page, and what it did that it must not do."""

    def __init__(self, browser: Any, file: Path, width: int, **options: Any) -> None:
        self.context = browser.new_context(viewport={"width": width, "height": 900}, **options)
        self.page = self.context.new_page()
        self.complaints: list[str] = []
        self.page.on("console", lambda message: self.complaints.append(message.text))
        self.page.on("pageerror", lambda error: self.complaints.append(str(error)))
        self.page.on("request", lambda request: self._requested(request.url, file))
        self.page.goto(file.as_uri())

    def _requested(self, url: str, file: Path) -> None:
        if url != file.as_uri() and not url.startswith("data:"):
            self.complaints.append(f"request for {url}")

    @property
    def epoch(self) -> int:
        return int(self.page.locator("#slider").input_value())

    def at(self, token: str) -> tuple[float, ...]:
        style = self.page.locator(f'[data-token="{token}"]').evaluate("token => token.style.transform")
        found = _MARKS.fullmatch(style)
        assert found, style
        return tuple(map(float, found.groups()))

    def close(self) -> None:
        self.context.close()
        assert self.complaints == []


@pytest.fixture(scope="module")
def file(room2: Scene, tmp_path_factory: pytest.TempPathFactory) -> Path:
    return written(room2, tmp_path_factory.mktemp("pages"))


def written(scene: Scene, folder: Path) -> Path:
    """The page of a scene."""
    page = folder / "page.html"
    page.write_text(str(draw(scene, ".html")), encoding="utf-8")
    return page


@pytest.fixture
def opened(browser: Any, file: Path) -> Iterator[Opened]:
    """The page of room2 on a wide screen; afterwards: no errors, no requests."""
    page = Opened(browser, file, 1600, reduced_motion="reduce")
    yield page
    page.close()


def test_the_slider_moves_everything(opened: Opened) -> None:
    start = opened.at("agent-1")
    opened.page.locator("#slider").fill("6")
    assert "Epoch 6" in opened.page.locator("#epoch").inner_text()
    assert opened.page.locator("#flag").inner_text() == "robot gives mk2 to commx in hall4"
    assert opened.page.locator("#cost").inner_text() == "7.6 of 12.6"
    assert opened.page.locator("#former-cost").inner_text() == "6 of 13"
    assert opened.at("agent-1") != start
    assert opened.at("object-1")[0] == opened.at("agent-0")[0]  # it is in the same frame
    assert "in-window" in (opened.page.locator("#map-scroller").get_attribute("class") or "")
    opened.page.locator("#slider").fill("7")
    assert "in-window" not in (opened.page.locator("#map-scroller").get_attribute("class") or "")


def test_the_path_grows_with_the_epochs(opened: Opened) -> None:
    lengths = []
    for epoch in (0, 1, 5, 11):
        opened.page.locator("#slider").fill(str(epoch))
        lengths.append(
            opened.page.locator('[data-trail="agent-0"]').evaluate("path => path.getTotalLength()")
        )
    assert lengths[0] == 0
    assert lengths == sorted(set(lengths))


def test_keys(opened: Opened) -> None:
    keyboard = opened.page.keyboard
    for key, epoch in (("ArrowRight", 1), ("ArrowRight", 2), ("ArrowLeft", 1), ("End", 13), ("Home", 0)):
        keyboard.press(key)
        assert opened.epoch == epoch
    keyboard.press("ArrowLeft")
    assert opened.epoch == 0


def test_keys_count_once_where_the_slider_or_a_button_has_the_focus(opened: Opened) -> None:
    opened.page.locator("#slider").focus()
    opened.page.keyboard.press("ArrowRight")
    assert opened.epoch == 1
    opened.page.locator("#forward").focus()
    opened.page.keyboard.press("Space")
    assert opened.epoch == 2
    opened.page.keyboard.press("ArrowRight")
    assert opened.epoch == 3
    opened.page.locator("#play").focus()
    opened.page.keyboard.press("Space")
    assert opened.page.locator("#play").get_attribute("aria-pressed") == "true"
    opened.page.keyboard.press("Space")
    assert opened.page.locator("#play").get_attribute("aria-pressed") == "false"


def test_buttons(opened: Opened) -> None:
    for button, epoch in (("forward", 1), ("forward", 2), ("back", 1), ("end", 13), ("first", 0)):
        opened.page.locator(f"#{button}").click()
        assert opened.epoch == epoch
    assert opened.page.locator("#back").is_disabled()


def test_it_plays_to_the_end_and_stops(browser: Any, file: Path) -> None:
    page = Opened(browser, file, 1600)
    page.page.clock.install()
    page.page.reload()
    page.page.keyboard.press("Space")
    assert page.page.locator("#play").get_attribute("aria-label") == "Pause"
    page.page.clock.run_for(3500)
    assert page.epoch == 3
    page.page.keyboard.press("Space")
    page.page.clock.run_for(5000)
    assert page.epoch == 3
    page.page.locator("#play").click()
    page.page.clock.run_for(60_000)
    assert page.epoch == 13
    assert page.page.locator("#play").get_attribute("aria-label") == "Play"
    page.close()


def test_a_click_on_the_timeline_jumps_there(opened: Opened) -> None:
    opened.page.locator('#lanes [data-act="9"]').first.click()
    assert opened.epoch == 9
    opened.page.locator('#lanes [data-column="2"]').first.click(position={"x": 40, "y": 10})
    assert opened.epoch == 2


@pytest.mark.parametrize("width", [400, 1600])
def test_it_fits_the_screen(width: int, browser: Any, file: Path) -> None:
    page = Opened(browser, file, width)
    for epoch in (1, 6, 11):
        page.page.locator("#slider").fill(str(epoch))
        assert page.page.evaluate("document.documentElement.scrollWidth") <= width
    page.page.locator("#slider").fill("11")
    cursor = page.page.locator("[data-cursor]")
    page.page.wait_for_function(
        """() => {
            const cursor = document.querySelector("[data-cursor]").getBoundingClientRect();
            const lanes = document.getElementById("lane-scroller").getBoundingClientRect();
            return cursor.left >= lanes.left - 2 && cursor.right <= lanes.right + 2;
        }"""
    )
    assert cursor.is_visible()
    for picture, least in (("#lanes", 10), ("#map", 8)):
        sizes = page.page.locator(f"{picture} text").evaluate_all(
            "texts => texts.map(text => text.getBoundingClientRect().height).filter(height => height > 0)"
        )
        assert min(sizes) >= least, picture
    for button in page.page.locator("button").all():
        box = button.bounding_box()
        assert box["width"] >= 44
        assert box["height"] >= 44
    page.close()


@pytest.mark.parametrize("width", [400, 1300])
def test_labels_stay_in_the_map_and_out_of_each_other(
    width: int, browser: Any, tmp_path: Path, parcels: Scene
) -> None:
    page = Opened(browser, written(parcels, tmp_path), width, reduced_motion="reduce")
    for epoch in range(len(parcels.frames)):
        page.page.locator("#slider").fill(str(epoch))
        wrong = page.page.evaluate(LABELS)
        assert wrong == [], epoch
    names = list(parcels.frames[0].objects)
    frame = page.page.locator(f'[data-token="frame-object-{names.index("van")}"]')
    page.page.locator("#slider").fill("3")
    assert frame.is_visible()
    assert frame.locator("title").text_content() == "van, dora, box"
    page.page.locator("#slider").fill("0")
    assert not frame.is_visible()
    page.close()


def test_what_has_the_focus_can_be_seen_and_everything_has_a_name(opened: Opened) -> None:
    named = []
    for _ in range(6):  # at the start two buttons are disabled
        opened.page.keyboard.press("Tab")
        outline, name = opened.page.evaluate(
            """() => {
                const e = document.activeElement;
                return [getComputedStyle(e).outlineStyle, e.getAttribute("aria-label") || e.textContent];
            }"""
        )
        assert outline == "solid", name
        assert name.strip()
        named.append(name)
    assert named[:4] == ["Play", "One epoch on", "To the end", "Epoch"]
    assert named[4].startswith("Timeline")
    assert named[5] == "The plan as a table"


def test_motion_is_reduced_where_that_is_preferred(browser: Any, file: Path) -> None:
    for preference, moves in (("reduce", False), ("no-preference", True)):
        page = Opened(browser, file, 1600, reduced_motion=preference)
        duration = page.page.locator('[data-token="agent-0"]').evaluate(
            "token => parseFloat(getComputedStyle(token).transitionDuration)"
        )
        assert (duration > 0) == moves
        page.close()


def test_another_scenario_takes_the_place_of_the_first_in_the_same_epoch(
    browser: Any, tmp_path: Path
) -> None:
    task = serendipity.example("room2")
    goals = [{"name": room, "goal": [f"conducted_triage commx {room}"]} for room in ("room1", "room3")]
    serendipity.show(task, serendipity.plan(task, discount="0.9", goals=goals)).save(tmp_path / "page.html")
    page = Opened(browser, tmp_path / "page.html", 400, reduced_motion="reduce")
    choice, played = page.page.locator("#scenario"), page.page.locator("header .played")
    page.page.locator("#slider").fill("6")
    met = page.page.locator("#flag").inner_text()
    assert met.startswith("robot gives") and played.inner_text().startswith("1 room1")
    for _ in range(2):
        choice.focus()
        page.page.keyboard.press("ArrowDown")
        assert page.epoch == 6 and not page.page.locator("#flag").is_visible()
        assert played.inner_text().startswith("2 room3")
        page.page.locator("#forward").click()
        assert page.epoch == 7, "the buttons work, once"
        page.page.locator("#back").click()
        choice.select_option("0")
        assert page.epoch == 6 and page.page.locator("#flag").inner_text() == met
        page.page.locator("#forward").click()
        assert page.epoch == 7
        page.page.keyboard.press("ArrowLeft")
    assert page.page.evaluate("document.documentElement.scrollWidth") <= 400
    page.close()


def test_a_task_without_map_plays_too(browser: Any, no_map: Scene, tmp_path: Path) -> None:
    page = Opened(browser, written(no_map, tmp_path), 400)
    assert not page.page.locator("#map-scroller").is_visible()
    page.page.keyboard.press("End")
    assert page.epoch == 2
    assert page.page.locator("#cost").inner_text() == "3 of 3"
    assert "Now true: p" in page.page.locator("#facts").inner_text()
    page.close()
