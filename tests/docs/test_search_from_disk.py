"""A page from disk gets no workers from the browser; the script of our own gives it what the search needs."""

from pathlib import Path
from typing import Any

import pytest

from tests.docs.blocks import ROOT

pytestmark = pytest.mark.browser

WORKER = """
const loaded = importScripts("more.js");
addEventListener("message", async (event) => {
  await loaded;
  postMessage([event.data + more, "IFrameWorker" in parent]);
});
"""
PAGE = """<!doctype html><body><script src="iframe-worker.js"></script><script>
  window.heard = [];
  const worker = new Worker("worker.js");
  worker.addEventListener("message", (event) => window.heard.push(event.data));
  worker.postMessage(1);
</script></body>"""


def test_a_worker_works_from_disk(browser: Any, tmp_path: Path) -> None:
    script = (ROOT / "docs/javascripts/iframe-worker.js").read_text(encoding="utf-8")
    files = {"iframe-worker.js": script, "worker.js": WORKER, "more.js": "var more = 1;", "page.html": PAGE}
    for name, text in files.items():
        (tmp_path / name).write_text(text, encoding="utf-8")
    page = browser.new_page()
    page.goto((tmp_path / "page.html").as_uri())
    page.wait_for_function("window.heard.length === 1")
    assert page.evaluate("window.heard") == [[2, True]]
    page.close()
