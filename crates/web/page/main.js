// Puts the page together. `document.body.dataset` tells tools how far it is: `state` (loading, ready, failed), `scene`,
// `frame`, `judged`, `intersections`, `rate`, `held` (the vertex that the pointer holds), `threads`.
//
// The address takes what to show: #scene=drape&theme=light&pause=1
"use strict";

/** How all scenes are solved: one linear system to a loose tolerance per time step, which takes a third of the time. */
const SOLVER = [
    "contact.preset=quick", "simulation.newton_iterations=1", "solver.newton.correcting_iterations=0", "solver.newton.cg_tolerance=0.05",
];

const SCENES = [
    { scene: "drape", scale: 1, name: "Sheet on a ball" },
    { scene: "stack", scale: 0.3, name: "Four sheets" },
    { scene: "tube", scale: 0.3, name: "Twisted tube" },
    { scene: "trampoline", scale: 0.6, name: "Trampoline" },
    { scene: "hair", scale: 0.2, name: "Hair" },
    { scene: "sand", scale: 0.3, name: "Sand" },
];

const asked = new URLSearchParams(location.hash.slice(1));
const state = document.body.dataset;
const at = (id) => document.getElementById(id);

const page = {
    viewer: null,
    grab: null,
    /** What was opened last, to open it again. */
    opened: null,
    /** What is being opened. */
    opening: null,
    playing: !asked.has("pause"),
    stiffness: 1,
    friction: null,
    timeStep: null,
    frames: [],
};

/** Says what went wrong over the picture. */
function notice(text, bad = false) {
    const box = at("notice");
    box.textContent = text;
    box.classList.toggle("bad", bad);
    box.hidden = text === "";
}

/** The last warnings, such as of parts of a mesh that are left out. */
function warn(warnings) {
    const list = at("warnings");
    list.append(...warnings.map((text) => make("li", { textContent: text })));
    while (list.children.length > 5) list.firstChild.remove();
}

/** Shows positions, x y z of each vertex [m]. */
function show(positions) {
    page.positions = positions;
    const own = meta.bodies.map((body) => (body.moves ? positions.subarray(3 * body.start, 3 * body.end) : body.still));
    page.viewer?.move([own], 0);
}

/** A canvas without a picture of the scene before. */
function freshViewer() {
    page.grab?.close();
    page.viewer?.renderer.dispose();
    const old = at("canvas");
    const canvas = old.cloneNode();
    old.replaceWith(canvas);
    page.viewer?.renderer.forceContextLoss();
    page.viewer = new Viewer(canvas, meta.bodies);
    page.viewer.shapes.forEach((shape) => shape?.paintBody(bodyColor(shape.body)));
    page.grab = new Grab(page.viewer, (message) => {
        if (message.do !== "lead") state.held = message.do === "grab" ? String(message.vertex) : "";
        client.tell(message);
    });
}

/** Frames a second over the last second. */
function rate() {
    const now = performance.now();
    page.frames.push(now);
    while (now - page.frames[0] > 1000) page.frames.shift();
    const span = now - page.frames[0];
    return span > 200 ? (1000 * (page.frames.length - 1)) / span : null;
}

const client = new Client({
    loaded({ threads }) {
        state.threads = threads;
        at("threads").textContent = threads;
    },
    opened(layout) {
        page.opened = page.opening;
        mark(page.opened);
        meta.bodies = bodiesOf(layout);
        meta.delta = layout.contactDistance;
        page.frames = [];
        notice("");
        at("warnings").replaceChildren();
        warn(layout.warnings);
        if (page.viewer || hasWebGL()) freshViewer();
        else notice("This browser gives no WebGL 2, so that nothing can be drawn. The simulation runs all the same.");
        Object.assign(state, { scene: layout.name, frame: "0", judged: "0", intersections: "0", state: "ready", held: "" });
        if (page.timeStep === null) at("time-step").value = String(Math.round(1000 * layout.timeStep));
        at("time-step-value").textContent = `${Math.round(1000 * layout.timeStep)} ms`;
        show(layout.positions);
        play(page.playing);
    },
    frame({ frame, time, positions, judged, intersections, words, milliseconds }) {
        show(positions);
        client.tell({ do: "shown" });
        const frames = rate();
        Object.assign(state, { frame, judged, intersections, step: milliseconds.step.toFixed(1), judge: milliseconds.judge.toFixed(1) });
        if (frames !== null) state.rate = frames.toFixed(1);
        at("judged").textContent = judged.toLocaleString("en");
        at("intersections").textContent = intersections.toLocaleString("en");
        at("verdict").className = `chip ${intersections === 0 ? "good" : "bad"}`;
        at("rate").textContent = frames === null ? "–" : frames.toFixed(0);
        at("time").textContent = `${time.toFixed(2)} s`;
        if (words.length > 0) notice(`The judge has found what must not be:\n${words.join("\n")}`, true);
    },
    warned: ({ warnings }) => warn(warnings),
    /** What was asked for is not possible; the simulation is as it was. */
    refused({ message }) {
        state.refused = message;
        // A scene that could not be opened leaves the one before.
        if (state.state === "loading" && page.opened) {
            state.state = "ready";
            mark(page.opened);
        }
        play(false);
        notice(message, true);
    },
    /** The worker is of no use any more. */
    failed({ message }) {
        state.state = "failed";
        client.stop();
        play(false);
        notice(`${message}\n\nChoose a scene to begin anew.`, true);
    },
});

/** The settings that every scene is opened with. */
function settings() {
    const sets = [...SOLVER];
    if (page.timeStep !== null) sets.push(`simulation.dt=${page.timeStep}`);
    return { sets, stiffness: page.stiffness, friction: page.friction };
}

function open(what) {
    page.opening = what;
    state.state = "loading";
    delete state.refused;
    notice("Putting the scene together…");
    mark(what);
    client.tell({ ...what, ...settings() });
}

/** Marks the button of a scene. */
function mark(what) {
    for (const button of at("scenes").children) button.ariaChecked = String(button.dataset.scene === what.scene);
}

function play(playing) {
    page.playing = playing;
    at("play").ariaPressed = String(playing);
    at("play").textContent = playing ? "Pause" : "Play";
    client.tell({ do: playing ? "play" : "pause" });
}

/** Reads a file and makes a scene of it. The worker says what is wrong with it. */
async function openFile(file) {
    if (!file) return;
    const bytes = new Uint8Array(await file.arrayBuffer());
    open({ do: "file", name: file.name, bytes, role: at("role").value });
}

function controls() {
    at("scenes").append(...SCENES.map(({ scene, scale, name }) => {
        const button = make("button", { textContent: name, role: "radio" });
        button.dataset.scene = scene;
        button.addEventListener("click", () => {
            page.timeStep = null;
            page.playing = true;
            open({ do: "open", scene, scale });
        });
        return button;
    }));
    at("play").addEventListener("click", () => {
        if (!page.playing) notice("");
        play(!page.playing);
    });
    at("step").addEventListener("click", () => {
        play(false);
        client.tell({ do: "step" });
    });
    at("restart").addEventListener("click", () => open(page.opened ?? page.opening));
    const slider = (id, words, change) => {
        const input = at(id);
        const say = () => (at(`${id}-value`).textContent = words(Number(input.value)));
        input.addEventListener("input", say);
        input.addEventListener("change", () => change(Number(input.value)));
        say();
    };
    slider("stiffness", (power) => (power === 0 ? "of the scene" : `× ${(10 ** power).toPrecision(2)}`), (power) => {
        page.stiffness = 10 ** power;
        client.tell({ do: "stiffness", factor: page.stiffness });
    });
    slider("friction", (value) => value.toFixed(2), (value) => {
        page.friction = value;
        client.tell({ do: "friction", value });
    });
    at("friction-value").textContent = "of the scene";
    slider("time-step", (milliseconds) => `${milliseconds} ms`, (milliseconds) => {
        page.timeStep = milliseconds / 1000;
        open(page.opened ?? page.opening);
    });
    at("file").addEventListener("change", (event) => openFile(event.target.files[0]));
    for (const name of ["dragover", "dragleave", "drop"]) {
        window.addEventListener(name, (event) => {
            event.preventDefault();
            at("drop").classList.toggle("over", name === "dragover");
            if (name === "drop") openFile(event.dataTransfer.files[0]);
        });
    }
    at("theme").addEventListener("click", () => {
        document.documentElement.dataset.theme = theme() === "dark" ? "light" : "dark";
        page.viewer?.theme();
        page.viewer?.shapes.forEach((shape) => shape?.paintBody(bodyColor(shape.body)));
    });
}

function start() {
    const preferred = window.matchMedia("(prefers-color-scheme: light)").matches ? "light" : "dark";
    document.documentElement.dataset.theme = ["light", "dark"].includes(asked.get("theme")) ? asked.get("theme") : preferred;
    controls();
    const first = SCENES.find(({ scene }) => scene === asked.get("scene")) ?? SCENES[0];
    open({ do: "open", scene: first.scene, scale: first.scale });
}

start();
