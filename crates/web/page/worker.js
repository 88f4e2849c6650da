// Computes: makes a simulation of a scene, and one time step after the other. Nothing here touches the page.

import { sceneWith } from "./file.js";

/** Name of the pin by which the pointer holds a vertex. */
const HAND = "the pointer";

/** Most threads, so that a page leaves something of a large machine to others. */
const THREADS = 8;

/** The module, see `load`. */
let bowknot = null;
let simulator = null;
let playing = false;
/** How many times as stiff as by its scene all is. */
let stiff = 1;
let judged = 0;
let intersections = 0;
/** The vertex that is held, where it is to go, and its largest speed [m/s]. */
let hand = null;
/** Vertices that collide, which are drawn. */
let drawn = 0;
/** Frames that the page has not shown yet. */
let unshown = 0;
/** Whether the next time step is about to come. */
let pending = false;

/** Most of these: a page that draws slowly is not run away from. */
const AHEAD = 2;

const say = (message, transfer = []) => postMessage(message, transfer);
const loaded = load();
/** Told without a wait: timers of workers wait for some milliseconds at least. */
const soon = new MessageChannel();
soon.port1.onmessage = () => awaited();

/** The module with threads; none if the page is not isolated, the folder lacks it, or the browser refuses its memory. */
async function threaded(threads) {
    if (threads < 2) return null;
    try {
        const module = await import("./threads/bowknot.js");
        await module.default();
        module.tellFaultsOn(new URL(location.href).searchParams.get("faults"));
        await module.initThreadPool(threads);
        return module;
    } catch {
        return null;
    }
}

async function load() {
    const threads = globalThis.crossOriginIsolated ? Math.min(navigator.hardwareConcurrency, THREADS) : 1;
    const module = await threaded(threads);
    bowknot = module ?? (await import("./bowknot.js"));
    if (!module) await bowknot.default();
    say({ is: "loaded", threads: module ? threads : 1 });
}

function layout() {
    const { bodies, planes, timeStep, contactDistance } = simulator;
    drawn = Math.max(0, ...bodies.map((body) => body.end));
    const positions = new Float32Array(simulator.positions.subarray(0, 3 * drawn));
    const { triangles, edges, particles } = simulator;
    return { bodies, planes, timeStep, contactDistance, positions, triangles, edges, particles };
}

function open(scene, { stiffness, friction }) {
    const next = new bowknot.Simulator(scene);
    next.setMeasured(false);
    if (stiffness !== 1) next.scaleStiffness(stiffness);
    stiff = stiffness;
    if (friction !== null) next.setFrictionOfAll(friction);
    simulator?.free();
    [simulator, hand, judged, intersections] = [next, null, 0, 0];
    say({ is: "opened", name: scene.name, warnings: bowknot.takeWarnings(), ...layout() });
}

/** The body of a vertex, and its number in the body's mesh. */
function inMesh(vertex) {
    const { name } = simulator.bodies.find(({ start, end }) => vertex >= start && vertex < end);
    return { name, number: simulator.meshOrder(name).indexOf(vertex) };
}

/** Leads the vertex that is held, no faster than it may go. */
function lead() {
    const positions = simulator.positions.subarray(3 * hand.vertex, 3 * hand.vertex + 3);
    const way = hand.target.map((x, k) => x - positions[k]);
    const share = Math.min(1, (hand.speed * simulator.timeStep) / (Math.hypot(...way) || 1));
    simulator.setPinTargets(HAND, new Float64Array(way.map((d, k) => positions[k] + share * d)));
}

function step() {
    const began = performance.now();
    if (hand?.target) lead();
    const statistics = simulator.step();
    const stepped = performance.now();
    const verdict = simulator.check();
    const ended = performance.now();
    judged += 1;
    unshown += 1;
    intersections += verdict.count;
    const positions = new Float32Array(simulator.positions.subarray(0, 3 * drawn));
    const { step: frame, time, two_way_steps: twoWaySteps } = statistics;
    const milliseconds = { step: stepped - began, judge: ended - stepped };
    say({ is: "frame", frame, time, positions, judged, intersections, words: verdict.intersections, twoWaySteps, milliseconds }, [positions.buffer]);
    const warnings = bowknot.takeWarnings();
    if (warnings.length > 0) say({ is: "warned", warnings });
    return ended - began;
}

/** The next time step, no sooner than in real time; `shown` goes on where the page lags behind. */
function advance() {
    if (!playing || pending || unshown >= AHEAD) return;
    guarded(() => {
        const wait = 1000 * simulator.timeStep - step();
        pending = true;
        if (wait > 4) setTimeout(awaited, wait);
        else soon.port2.postMessage(null);
    });
}

function awaited() {
    pending = false;
    advance();
}

const actions = {
    /** A built-in scene, with settings of its keys. */
    open: ({ scene, scale, sets, ...settings }) => open(bowknot.Scene.builtin(scene, scale).withSets(sets), settings),
    /** A scene around the mesh of a file, whose bytes are given. */
    file: ({ name, bytes, role, sets, ...settings }) => {
        const [low, high] = [0, 3].map((k) => Array.from(bowknot.boundsOf(name, bytes).subarray(k, k + 3)));
        const scene = bowknot.Scene.fromToml(sceneWith(name, role, low, high), { [name]: bytes });
        open(scene.withSets(sets), settings);
    },
    play: () => {
        if (playing) return;
        playing = true;
        advance();
    },
    pause: () => (playing = false),
    /** The page has shown a frame. */
    shown: () => {
        unshown -= 1;
        advance();
    },
    step: () => step(),
    stiffness: ({ factor }) => {
        simulator.scaleStiffness(factor / stiff);
        stiff = factor;
    },
    friction: ({ value }) => simulator.setFrictionOfAll(value),
    grab: ({ vertex, speed }) => {
        const { name, number } = inMesh(vertex);
        try {
            simulator.addPin(HAND, name, new Uint32Array([number]));
            hand = { vertex, speed, target: null };
        } catch (error) {
            if (error.name !== "InputError") throw error;
            // A pin of the scene holds it: no reason to stop.
            say({ is: "warned", warnings: [error.message] });
        }
    },
    lead: ({ target }) => hand && (hand.target = target),
    release: () => {
        if (!hand) return;
        hand = null;
        simulator.removePin(HAND);
    },
};

/** Does something; says what is refused, and what has failed for good. */
function guarded(action) {
    try {
        action();
    } catch (error) {
        playing = false;
        const isRefusal = error.name === "InputError" || error.name === "IntersectionError";
        say({ is: isRefusal ? "refused" : "failed", message: error.message ?? String(error) });
    }
}

onmessage = async ({ data }) => {
    try {
        await loaded;
    } catch (error) {
        return say({ is: "failed", message: `WebAssembly could not be started: ${error.message}` });
    }
    const needsScene = !["open", "file", "pause", "shown"].includes(data.do);
    if (simulator || !needsScene) guarded(() => actions[data.do](data));
};
