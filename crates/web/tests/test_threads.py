"""The module with threads: the page where it is isolated, the bits, faults on other threads."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from browser import Browser
from conftest import TARGET
from test_module import compared, run
from test_page import FRAMES, start

pytestmark = pytest.mark.skipif(
    not (TARGET / "web/threads").is_dir(), reason="no module with threads: cargo xtask web --test --threads"
)

PACKAGE = "npm/bowknot/threads/bowknot.js"


def test_an_isolated_page_has_threads(browser: Browser, isolated: str, pictures: Path) -> None:
    start(browser, isolated, "drape")
    if browser.evaluate("navigator.hardwareConcurrency") < 2:
        pytest.skip("one core has no threads")
    browser.wait(f"Number(document.body.dataset.frame) >= {FRAMES}", 120)
    assert (browser.data("state"), browser.data("intersections")) == ("ready", "0")
    cores = browser.evaluate("navigator.hardwareConcurrency")
    assert int(browser.data("threads") or 0) == min(cores, 8)
    print(f"\n  drape, {browser.data('threads')} threads: {browser.data('rate')} frames/s, step {browser.data('step')} ms")
    browser.picture(pictures / "threads.png")


def test_the_package_exports_it() -> None:
    folder = TARGET / "npm/bowknot"
    export = json.loads((folder / "package.json").read_text())["exports"]["./threads"]
    assert (folder / export["types"]).is_file() and (folder / export["default"]).is_file()


def test_other_pages_have_one(browser: Browser, address: str) -> None:
    start(browser, address, "drape", "&pause=1")
    assert browser.data("threads") == "1"


@pytest.mark.parametrize(("scene", "scale", "frames"), [("drape", 0.4, 30), ("hair", 0.3, 15)])
def test_positions_are_those_of_the_command(
    browser: Browser, isolated: str, tmp_path: Path, scene: str, scale: float, frames: int
) -> None:
    compared(browser, isolated, tmp_path, scene, scale, frames, "quick", PACKAGE)


def test_the_page_listens_to_its_channel(browser: Browser, isolated: str) -> None:
    """So a fault of a thread that its worker waits for ends the wait. The test stands for the thread."""
    start(browser, isolated, "drape", "&pause=1")
    browser.evaluate("new BroadcastChannel(client.faults.name).postMessage('internal error: a test')")
    browser.wait("document.body.dataset.state === 'failed'")
    assert "internal error: a test" in browser.evaluate("at('notice').textContent")
    assert run(browser, isolated, "module.tellFaultsOn('faults'); return crossOriginIsolated;", PACKAGE, True) is True
