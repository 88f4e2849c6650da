"""The module: the bits of the native library, the resolver, the packages."""

from __future__ import annotations

import base64
import json
import os
import shutil
import subprocess
from pathlib import Path

import numpy as np
import pytest
from browser import Browser
from conftest import TARGET
from numpy.typing import NDArray

COMMAND = os.environ.get("BOWKNOT_COMMAND", "bowknot")

#: Scenes, their scales, and time steps until the comparison.
CASES = [("drape", 0.4, 30), ("tube", 0.3, 20), ("trampoline", 0.4, 20), ("hair", 0.3, 15), ("sand", 0.3, 20)]

#: What the packages hold beside their code.
FILES = ["README.md", "LICENSE-MIT", "LICENSE-APACHE", "LICENSES-OF-DEPENDENCIES.txt"]

MODULE = """
const toBase64 = (array) => {
    const bytes = new Uint8Array(array.buffer, array.byteOffset, array.byteLength);
    let text = "";
    for (let k = 0; k < bytes.length; k += 4096) text += String.fromCharCode(...bytes.subarray(k, k + 4096));
    return btoa(text);
};
const module = await import(PATH);
await module.default();
"""


def run(browser: Browser, address: str, code: str, package: str = "web/bowknot.js", in_worker: bool = False) -> object:
    """What code in the page, or in a worker of it, returns; `module` is the package."""
    if not (browser.evaluate("location.href") or "").startswith(f"{address}/npm"):
        browser.open(f"{address}/npm/bowknot/README.md")
    script = f"(async () => {{ {MODULE.replace('PATH', json.dumps(f'{address}/{package}'))} {code} }})()"
    if in_worker:
        source = json.dumps(f"postMessage(await {script})")
        script = f"""new Promise((done, failed) => {{
            const worker = new Worker(URL.createObjectURL(new Blob([{source}], {{ type: "text/javascript" }})), {{ type: "module" }});
            worker.onmessage = ({{ data }}) => done(data);
            worker.onerror = (event) => failed(new Error(event.message));
        }})"""
    return browser.evaluate(script)


@pytest.mark.parametrize(("scene", "scale", "frames"), CASES)
@pytest.mark.parametrize("preset", ["quick", pytest.param("fast", marks=pytest.mark.long)])
def test_positions_are_those_of_the_command(
    browser: Browser, address: str, tmp_path: Path, scene: str, scale: float, frames: int, preset: str
) -> None:
    compared(browser, address, tmp_path, scene, scale, frames, preset)


def compared(
    browser: Browser,
    address: str,
    folder: Path,
    scene: str,
    scale: float,
    frames: int,
    preset: str,
    threaded: str | None = None,
) -> None:
    """Asserts that a scene has the bits of the command; `threaded` is a package with threads, run in a worker."""
    out = folder / "run"
    arguments = (
        f"run {scene} --scale {scale} --frames {frames} --set contact.preset={preset} --format npz --out".split()
    )
    subprocess.run([COMMAND, *arguments, out], check=True, capture_output=True)
    native = np.load(next(out.rglob("*.npz")))["X"][-1]
    text = run(
        browser,
        address,
        f"""{"await module.initThreadPool(3);" if threaded else ""}
        const scene = module.Scene.builtin("{scene}", {scale}).withSets(["contact.preset={preset}"]);
        const simulator = new module.Simulator(scene);
        for (let k = 0; k < {frames}; k++) simulator.step();
        const count = Math.max(...simulator.bodies.map((body) => body.end));
        return toBase64(simulator.positions.slice(0, 3 * count));""",
        threaded or "web/bowknot.js",
        threaded is not None,
    )
    web = np.frombuffer(base64.b64decode(str(text)), dtype="<f8").reshape(-1, 3)
    # Frames end with the corners of squares that stand for half-spaces.
    native = native[: len(web)]
    error = np.abs(web - native).max()
    print(f"\n  {scene}, {preset}: {len(native)} vertices after {frames} frames, largest error {error:.1e} m")
    assert web.shape == native.shape and web.tobytes() == native.astype("<f8").tobytes()


def points(array: object) -> NDArray[np.float64]:
    return np.array(array, dtype=float).reshape(-1, 3)


def test_the_resolver_keeps_two_triangles_apart(browser: Browser, address: str) -> None:
    result = run(
        browser,
        address,
        """const rest = new Float64Array([0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 0.1, 1, 0, 0.1, 0, 1, 0.1]);
        const resolver = new module.Resolver({ rest, triangles: [0, 1, 2, 3, 4, 5], bodies: [0, 0, 0, 1, 1, 1] });
        const target = Float64Array.from([...rest.subarray(9), ...rest.subarray(0, 9)]);
        const { positions, converged, info } = resolver.resolve(rest, target);
        return { x: Array.from(positions), converged, steps: info.steps, count: resolver.countIntersections(positions) };""",
    )
    assert isinstance(result, dict)
    x = points(result["x"])
    assert result["converged"] and result["count"] == 0 and result["steps"] > 0
    assert (x[3:, 2] > x[:3, 2]).all(), "they do not pass through each other"


def test_errors_are_named_and_in_words(browser: Browser, address: str) -> None:
    cases = {
        "new module.Resolver({ rest: [0, 0, 0], faces: [] })": ("InputError", "unknown key faces"),
        "new module.Resolver({ rest: [0, 0] })": ("InputError", "not a multiple of 3"),
        "new module.Resolver({ rest: [0, 0, 'x'] })": ("InputError", "rest must be an Array of numbers"),
        "new module.Resolver({ rest: [0, 0, 0], particles: [NaN] })": ("InputError", "particles must be an Array of"),
        "new module.Resolver({ rest: [0, 0, 0], particles: [0], masses: NaN })": ("InputError", "mass"),
        "new module.Resolver({ rest: new Float64Array(9), triangles: [0, 1, 7] })": ("InputError", "7"),
        'module.Scene.builtin("drap")': ("InputError", "drape"),
        'module.Scene.fromToml("[[body]]\\nmesh = \\"a.obj\\"")': ("InputError", "no mesh a.obj is given"),
        'module.Scene.fromToml("[[body]]\\nmesh = \\"a.obj\\"", { "a.obj": "v 0 0 0\\nf 1 2 3" })': (
            "InputError",
            "a.obj:2: ",
        ),
        'module.Scene.builtin("drape", 0.2).withSets(["contact.dleta=1"])': ("InputError", "delta"),
        'new module.Simulator(module.Scene.builtin("drape", 0.2)).removePin("none")': ("InputError", "none"),
        """new module.Simulator(module.Scene.fromToml('[[body]]\\nmesh = "m"', { m: { positions: [0, 0, 0, 1, 0, 0, 0, 1, 0,
            0.2, 0.2, -1, 0.3, 0.2, 1, 0.2, 0.3, 1], triangles: [0, 1, 2, 3, 4, 5] } }))""": (
            "IntersectionError",
            "intersect",
        ),
    }
    for code, (name, words) in cases.items():
        result = run(browser, address, f"try {{ {code} }} catch (error) {{ return [error.name, error.message] }}")
        assert isinstance(result, list) and result[0] == name and words in result[1], (code, result)


def test_a_pin_leads_a_corner_and_a_checkpoint_returns(browser: Browser, address: str) -> None:
    result = run(
        browser,
        address,
        """const simulator = new module.Simulator(module.Scene.builtin("drape", 0.3));
        simulator.addPin("hand", "sheet", new Uint32Array([0]));
        const vertex = simulator.meshOrder("sheet")[0];
        const place = () => Array.from(simulator.positions.subarray(3 * vertex, 3 * vertex + 3));
        const goal = place().map((x, k) => x + [0.02, 0.03, 0.04][k]);
        simulator.setPinTargets("hand", new Float64Array(goal));
        const before = simulator.checkpoint();
        const { step } = simulator.step();
        const led = place();
        simulator.step();
        const later = simulator.positions;
        simulator.restore(before);
        simulator.step();
        simulator.step();
        const same = simulator.positions.every((x, k) => Object.is(x, later[k]));
        return { step, goal, led, same, index: simulator.stepIndex };""",
    )
    assert isinstance(result, dict)
    assert np.allclose(result["led"], result["goal"], atol=1e-9)
    assert result["step"] == 1 and result["index"] == 2 and result["same"]


def test_the_package_with_the_module_inside_runs(browser: Browser, address: str) -> None:
    code = 'return new module.Simulator(module.Scene.builtin("drape", 0.2)).check().count;'
    assert run(browser, address, code, "npm/bowknot-compat/index.js") == 0
    assert run(browser, address, code, "npm/bowknot/bowknot.js") == 0


def test_the_package_with_the_module_inside_runs_in_node(tmp_path: Path) -> None:
    if shutil.which("node") is None:
        assert os.environ.get("CI") != "true", "CI needs Node to run the package in: apt-get install nodejs"
        pytest.skip("no Node on this machine (Debian: apt-get install nodejs)")
    # A project beside which the package is installed, as `npm install FOLDER` links it.
    (tmp_path / "node_modules").mkdir()
    (tmp_path / "node_modules/bowknot-compat").symlink_to((TARGET / "npm/bowknot-compat").resolve())
    script = tmp_path / "main.mjs"
    script.write_text(
        """import init, { Scene, Simulator } from "bowknot-compat";
        await init();
        const simulator = new Simulator(Scene.builtin("drape", 0.2));
        for (let frame = 0; frame < 5; frame++) simulator.step();
        console.log(simulator.stepIndex, simulator.positions.every(Number.isFinite), simulator.check().count);"""
    )
    done = subprocess.run(["node", script], cwd=tmp_path, capture_output=True, text=True)
    assert done.stdout.split() == ["5", "true", "0"], done.stderr


def test_packages_have_what_npm_asks_for() -> None:
    for name in ["bowknot", "bowknot-compat"]:
        folder = TARGET / "npm" / name
        manifest = json.loads((folder / "package.json").read_text())
        assert manifest["name"] == name and manifest["version"] != "0.0.0"
        for file in [manifest["main"], manifest["types"], *FILES]:
            assert (folder / file).is_file(), f"{name}: {file}"
        assert "rayon v" in (folder / FILES[-1]).read_text()
        types = (folder / "bowknot.d.ts").read_text()
        for word in ["class Simulator", "class Resolver", "interface ResolverOptions", "step(): StepStatistics"]:
            assert word in types, f"{name}: {word}"
