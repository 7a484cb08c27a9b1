"""Makes docs/images again (``make pictures``): what `show` makes of examples.

Stills of those that are shipped beside the paper's, and of a policy; photographs of the page for its III-C,
and of `play`.
"""

import io
import sys
import tempfile
from pathlib import Path
from typing import Any

from PIL import Image

import serendipity
from serendipity.pictures import build_scene, draw
from serendipity_live.tests.server import serving
from tests.show.browser import chromium, chromium_path

IMAGES = Path(__file__).parent / "images"
STILLS = {"parcels": None, "flights": None, "taxis": None, "morning": 14, "office": 10}
"""Each with its epoch; None: the one that says most."""
EPOCHS = (1, 6, 11)
WALK = ("hall8", "hall7", "hall6", "hall5", "hall4")
"""Until the robot is met, in III-C."""
SIZE = {"width": 1300, "height": 900}
COLOURS = 256


def main() -> int:
    """Draw the stills, and photograph the page at some epochs."""
    for name, epoch in {**STILLS, "unsure": None}.items():
        still = IMAGES / f"{name}.svg"
        content = unsure() if name == "unsure" else str(drawn(name, "0.5", ".svg", epoch))
        still.write_text(content, encoding="utf-8")
        sys.stdout.write(f"{still.relative_to(Path.cwd())}\n")
    path = chromium_path()
    if path is None:
        sys.stderr.write("Error: there is no chromium (set CHROMIUM to its path)\n")
        return 2
    page_text = str(drawn("room2", "0.6", ".html"))
    with tempfile.TemporaryDirectory() as folder, chromium(path) as browser:
        file = Path(folder) / "room2.html"
        file.write_text(page_text, encoding="utf-8")
        page = browser.new_page(viewport=SIZE, reduced_motion="reduce")
        page.goto(file.as_uri())
        for epoch in EPOCHS:
            page.locator("#slider").fill(str(epoch))
            page.locator("#slider").blur()
            photograph(page, f"room2-epoch-{epoch}.png")
        with serving(command="play") as server:
            page.goto(server.url)
            page.click("#think")
            for place in WALK:
                page.click(f'.reach[data-place="{place}"]')
                page.wait_for_selector(f'.reach[data-place="{place}"]', state="detached")
            page.evaluate("scrollTo(0, 0)")
            photograph(page, "play-epoch-6.png", whole=False)
    return 0


def photograph(page: Any, name: str, *, whole: bool = True) -> None:
    """A page, or what of it is in sight, as an image of the documentation."""
    shot = Image.open(io.BytesIO(page.screenshot(full_page=whole))).convert("RGB")
    image = IMAGES / name
    # The default method has no colour for what is small: a green flag came out blue.
    few = shot.quantize(COLOURS, Image.Quantize.MAXCOVERAGE, kmeans=1, dither=Image.Dither.NONE)
    few.save(image, optimize=True)
    sys.stdout.write(f"{image.relative_to(Path.cwd())}\n")


def drawn(name: str, discount: str, suffix: str, epoch: int | None = None) -> str | bytes:
    """The picture of an example's answer."""
    task = serendipity.example(name)
    return draw(build_scene(task, serendipity.plan(task, discount=discount)), suffix, epoch)


def unsure() -> str:
    """The picture of the policy that docs/howto/unsure.md is about."""
    task, wanted = serendipity.example("room2"), {"room1": 2, "room3": 1, "room9": 1}
    named = {room: f"conducted_triage commx {room}" for room in wanted}
    goals = [{"name": fact, "goal": [fact], "prior": wanted[room]} for room, fact in named.items()]
    return serendipity.show(task, serendipity.plan(task, discount="0.9", goals=goals)).svg()


if __name__ == "__main__":
    sys.exit(main())
