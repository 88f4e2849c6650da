// What the viewer of the report knows of a run, for a simulation that goes on: its bodies, and how positions are kept.
"use strict";

const meta = { bodies: [], delta: null };

/** Positions are kept as they are [m]. */
function dequantize(body, positions, out) {
    out.set(positions);
}

/** An element with properties and children; text is text, never HTML. */
function make(tag, properties = {}, ...children) {
    const element = document.createElement(tag);
    for (const [key, value] of Object.entries(properties)) {
        if (key in element) element[key] = value;
        else element.setAttribute(key, value);
    }
    element.append(...children);
    return element;
}

/** The corners of a box around points from `start` to before `end`. */
function boxOf(positions, start, end) {
    const [low, high] = [[Infinity, Infinity, Infinity], [-Infinity, -Infinity, -Infinity]];
    for (let v = start; v < end; v++) {
        for (let k = 0; k < 3; k++) {
            low[k] = Math.min(low[k], positions[3 * v + k]);
            high[k] = Math.max(high[k], positions[3 * v + k]);
        }
    }
    return { low, high };
}

/** The elements all of whose vertices lie from `start` to before `end`, numbered from there. */
function elementsOf(elements, size, start, end) {
    const own = [];
    for (let k = 0; k < elements.length; k += size) {
        if (elements[k] >= start && elements[k] < end) for (let i = 0; i < size; i++) own.push(elements[k + i] - start);
    }
    return new Uint32Array(own);
}

/** Four corners of a large square in a half-space's plane, as the report has it: the foot and the normal follow from them. */
function squareOf([x, y, z, offset]) {
    const normal = new Libraries.Vector3(x, y, z);
    const across = Math.abs(z) < 0.9 ? new Libraries.Vector3(0, 0, 1) : new Libraries.Vector3(1, 0, 0);
    const u = across.cross(normal).normalize();
    const v = normal.clone().cross(u);
    const foot = normal.clone().multiplyScalar(offset);
    const corner = (a, b) => foot.clone().addScaledVector(u, a).addScaledVector(v, b).toArray();
    return new Float32Array([corner(-1, -1), corner(1, -1), corner(1, 1), corner(-1, 1)].flat());
}

/** The bodies of a simulation as the viewer has them. */
function bodiesOf({ bodies, triangles, edges, particles, planes, positions }) {
    const withMeshes = bodies.map(({ name, kind, start, end }) => ({
        name, kind, start, end, obstacle: kind === "obstacle", vertices: end - start, moves: true,
        triangles: elementsOf(triangles, 3, start, end),
        strands: elementsOf(edges, 2, start, end),
        particles: elementsOf(particles, 1, start, end),
        ...boxOf(positions, start, end),
    }));
    // Bodies fall: the picture has room down to the ground.
    const floors = Array.from({ length: planes.length / 4 }, (_, k) => (planes[4 * k + 2] > 0.99 ? planes[4 * k + 3] : Infinity));
    for (const body of withMeshes) if (!body.obstacle) body.low[2] = Math.min(body.low[2], ...floors);
    const none = new Uint32Array(0);
    const grounds = Array.from({ length: planes.length / 4 }, (_, k) => ({
        name: `plane ${k}`, kind: "half-space", obstacle: true, vertices: 4, moves: false, start: 0, end: 0,
        triangles: none, strands: none, particles: none, low: [0, 0, 0], high: [0, 0, 0],
        still: squareOf(planes.subarray(4 * k, 4 * k + 4)),
    }));
    return [...withMeshes, ...grounds].map((body, index) => ({ ...body, index }));
}
