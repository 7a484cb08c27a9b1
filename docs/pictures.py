"""Makes docs/images again: the page of `show` for the paper's example III-C (``make pictures``)."""

import io
import sys
import tempfile
from pathlib import Path

from PIL import Image

import serendipity
from serendipity.show import build_scene, draw
from tests.show.browser import chromium, chromium_path

IMAGES = Path(__file__).parent / "images"
EPOCHS = (1, 6, 11)
SIZE = {"width": 1300, "height": 900}
COLOURS = 128


def main() -> int:
    """Photograph the page at some epochs."""
    path = chromium_path()
    if path is None:
        sys.stderr.write("Error: there is no chromium (set CHROMIUM to its path)\n")
        return 2
    task = serendipity.example("room2")
    page_text = str(draw(build_scene(task, serendipity.plan(task, discount="0.6")), ".html"))
    with tempfile.TemporaryDirectory() as folder, chromium(path) as browser:
        file = Path(folder) / "room2.html"
        file.write_text(page_text, encoding="utf-8")
        page = browser.new_page(viewport=SIZE, reduced_motion="reduce")
        page.goto(file.as_uri())
        for epoch in EPOCHS:
            page.locator("#slider").fill(str(epoch))
            page.locator("#slider").blur()
            shot = Image.open(io.BytesIO(page.screenshot(full_page=True))).convert("RGB")
            image = IMAGES / f"room2-epoch-{epoch}.png"
            shot.quantize(COLOURS, dither=Image.Dither.NONE).save(image, optimize=True)
            sys.stdout.write(f"{image.relative_to(Path.cwd())}\n")
    return 0


if __name__ == "__main__":
    sys.exit(main())
