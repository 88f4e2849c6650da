"""The page: scenes run, a vertex is dragged, meshes are dropped."""

from __future__ import annotations

import time
from pathlib import Path

import pytest
from browser import Browser

#: Frames of each scene.
FRAMES = 50

LONG = [pytest.param(scene, marks=pytest.mark.long) for scene in ["stack", "tube", "trampoline", "sand"]]
SCENES = ["drape", "hair", *LONG]

BOX = """v 0 0 0
v 2 0 0
v 2 3 0
v 0 3 0
v 0 0 1
v 2 0 1
v 2 3 1
v 0 3 1
f 1 4 3 2
f 5 6 7 8
f 1 2 6 5
f 2 3 7 6
f 3 4 8 7
f 4 1 5 8
"""


def start(browser: Browser, address: str, scene: str, more: str = "") -> None:
    browser.open(f"{address}/web/index.html#scene={scene}&theme=dark{more}")
    browser.wait("document.body.dataset.state === 'ready'")


def drop(browser: Browser, name: str, text: str) -> None:
    """Drops a file on the page."""
    browser.evaluate(
        f"""{{ const files = new DataTransfer();
        files.items.add(new File([{text!r}], {name!r}));
        window.dispatchEvent(new DragEvent("drop", {{ dataTransfer: files, cancelable: true }})); }}"""
    )


@pytest.mark.parametrize("scene", SCENES)
def test_scenes_run_without_intersections(browser: Browser, address: str, pictures: Path, scene: str) -> None:
    start(browser, address, scene)
    began = time.monotonic()
    browser.wait(f"Number(document.body.dataset.frame) >= {FRAMES}", 120)
    seconds = time.monotonic() - began
    assert (browser.data("state"), browser.data("intersections")) == ("ready", "0")
    assert int(browser.data("judged") or 0) >= FRAMES
    assert browser.evaluate("page.positions.every(Number.isFinite)")
    vertices = browser.evaluate("meta.bodies.filter((b) => !b.obstacle).reduce((sum, b) => sum + b.vertices, 0)")
    rate = f"{int(browser.data('frame') or 0) / seconds:.0f} frames/s"
    print(
        f"\n  {scene}: {vertices} vertices, {rate}, last: step {browser.data('step')} ms, judge {browser.data('judge')} ms"
    )
    browser.picture(pictures / f"{scene}.png")


def test_a_vertex_is_dragged(browser: Browser, address: str, pictures: Path) -> None:
    start(browser, address, "drape")
    browser.wait("Number(document.body.dataset.frame) >= 60", 120)
    x, y = browser.evaluate(
        "(({ left, top, width, height }) => [left + width / 2, top + height / 2])(at('canvas').getBoundingClientRect())"
    )
    browser.mouse("mouseMoved", x, y)
    browser.mouse("mousePressed", x, y)
    vertex = browser.data("held")
    assert vertex, "nothing is under the pointer"
    place = f"Array.from(page.positions.subarray(3 * {vertex}, 3 * {vertex} + 3))"
    before = browser.evaluate(place)
    for k in range(20):
        browser.mouse("mouseMoved", x + 3 * k, y - 8 * k)
        time.sleep(0.05)
    frame = int(browser.data("frame") or 0)
    browser.wait(f"Number(document.body.dataset.frame) >= {frame + 20}", 60)
    after = browser.evaluate(place)
    browser.picture(pictures / "dragged.png")
    assert sum((a - b) ** 2 for a, b in zip(after, before, strict=True)) > 0.1**2, (before, after)
    # A second finger lets nothing go.
    browser.evaluate("window.dispatchEvent(new PointerEvent('pointerup', { pointerId: 77 }))")
    assert browser.data("held") == vertex
    # The camera has not moved along.
    assert browser.evaluate("page.viewer.controls.enabled") is False
    browser.mouse("mouseReleased", x + 57, y - 152)
    assert browser.data("held") == ""
    frame = int(browser.data("frame") or 0)
    browser.wait(f"Number(document.body.dataset.frame) >= {frame + 10}", 60)
    assert browser.evaluate(place)[2] < after[2], "what is let go falls"
    assert (browser.data("state"), browser.data("intersections")) == ("ready", "0")


def test_sliders_change_the_simulation(browser: Browser, address: str) -> None:
    start(browser, address, "stack")
    browser.wait("Number(document.body.dataset.frame) >= 3")

    def slide(name: str, value: float) -> None:
        browser.evaluate(
            f"{{ const s = at('{name}'); s.value = {value}; for (const e of ['input', 'change']) s.dispatchEvent(new Event(e)); }}"
        )

    slide("stiffness", 1)
    slide("friction", 0.8)
    frame = int(browser.data("frame") or 0)
    browser.wait(f"Number(document.body.dataset.frame) >= {frame + 5}")
    slide("time-step", 20)
    browser.wait("document.body.dataset.state === 'ready' && Number(document.body.dataset.frame) >= 5")
    assert browser.evaluate("at('time-step-value').textContent") == "20 ms"
    clock = browser.evaluate("[Number.parseFloat(at('time').textContent), Number(document.body.dataset.frame)]")
    assert abs(clock[0] - 0.02 * clock[1]) < 0.011, clock
    assert (browser.data("state"), browser.data("intersections")) == ("ready", "0")


@pytest.mark.parametrize("role", ["obstacle", "cloth"])
def test_a_mesh_is_dropped(browser: Browser, address: str, pictures: Path, role: str) -> None:
    start(browser, address, "stack", "&pause=1")
    browser.evaluate(f"at('role').value = '{role}'; page.playing = true")
    drop(browser, "my box.obj", BOX)
    browser.wait("meta.bodies.some((body) => body.name === 'your mesh' && body.vertices === 8)")
    browser.wait("document.body.dataset.state === 'ready' && Number(document.body.dataset.frame) >= 20", 60)
    assert browser.data("intersections") == "0"
    browser.picture(pictures / f"box-{role}.png")


@pytest.mark.parametrize(
    ("name", "text", "words"),
    [
        ("broken.obj", BOX.replace("f 1 2 6 5", "f 1 2 6 99"), "broken.obj:11: "),
        ("broken.obj", BOX.replace("v 2 3 0", "v 2 three 0"), "broken.obj:3: "),
        ("nothing.obj", "", "no vertices"),
        ("picture.png", "PNG", "not a mesh: only .obj"),
    ],
)
def test_a_broken_mesh_is_refused_in_words(browser: Browser, address: str, name: str, text: str, words: str) -> None:
    start(browser, address, "stack")
    browser.wait("Number(document.body.dataset.frame) >= 2")
    drop(browser, name, text)
    browser.wait(f"at('notice').textContent.includes({words!r})")
    # The scene that was there goes on.
    browser.evaluate("at('play').click()")
    frame = int(browser.data("frame") or 0)
    browser.wait(f"Number(document.body.dataset.frame) > {frame + 2}")
    assert browser.evaluate("at('notice').hidden")
    # And it is what Restart opens.
    browser.evaluate("at('restart').click()")
    browser.wait(f"document.body.dataset.state === 'ready' && Number(document.body.dataset.frame) <= {frame}")
    assert browser.data("scene") == "stack"


def test_a_mesh_that_cannot_start_is_refused_in_words(browser: Browser, address: str, pictures: Path) -> None:
    start(browser, address, "stack", "&pause=1")
    browser.evaluate("at('role').value = 'cloth'")
    # Two triangles through each other.
    crossed = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0.2 0.2 -1\nv 0.3 0.2 1\nv 0.2 0.3 1\nf 1 2 3\nf 4 5 6\n"
    drop(browser, "crossed.obj", crossed)
    browser.wait("at('notice').textContent.includes('intersect')")
    browser.picture(pictures / "refused.png")


def test_a_worker_that_fails_is_said_in_words_and_replaced(browser: Browser, address: str) -> None:
    start(browser, address, "stack", "&pause=1")
    browser.evaluate("client.worker.onerror(new ErrorEvent('error', { message: 'out of memory' }))")
    assert "out of memory" in browser.evaluate("at('notice').textContent")
    assert browser.data("state") == "failed"
    browser.evaluate("at('scenes').children[1].click()")
    browser.wait("document.body.dataset.state === 'ready' && Number(document.body.dataset.frame) >= 2")
    assert browser.evaluate("at('notice').hidden")
