// Values of vertices that colors show: stretch, speed, height.

/** Edges of a body, each once: those of triangles and of strands. */
function edgesOf(body) {
    const seen = new Set();
    const edges = [];
    const add = (i, j) => {
        const key = i < j ? i * body.vertices + j : j * body.vertices + i;
        if (!seen.has(key)) {
            seen.add(key);
            edges.push(i, j);
        }
    };
    const { triangles, strands } = body;
    for (let k = 0; k < triangles.length; k += 3) {
        add(triangles[k], triangles[k + 1]);
        add(triangles[k + 1], triangles[k + 2]);
        add(triangles[k + 2], triangles[k]);
    }
    for (let k = 0; k < strands.length; k += 2) add(strands[k], strands[k + 1]);
    return new Uint32Array(edges);
}

function lengthsOf(edges, positions) {
    const lengths = new Float32Array(edges.length / 2);
    for (let e = 0; e < lengths.length; e++) {
        const i = 3 * edges[2 * e];
        const j = 3 * edges[2 * e + 1];
        lengths[e] = Math.hypot(positions[i] - positions[j], positions[i + 1] - positions[j + 1], positions[i + 2] - positions[j + 2]);
    }
    return lengths;
}

/** What a field needs of a run: positions of any frame. */
class Fields {
    constructor(bodies, frames) {
        this.bodies = bodies;
        this.frames = frames;
        this.ranges = new Map();
        this.rest = bodies.map(() => null);
    }

    positions(body, frame) {
        const out = new Float32Array(3 * body.vertices);
        dequantize(body, this.frames[frame][body.index], out);
        return out;
    }

    /** Largest ratio to its length in the first frame of the edges at each vertex. */
    stretch(body, frame) {
        const rest = (this.rest[body.index] ??= (() => {
            const edges = edgesOf(body);
            return { edges, lengths: lengthsOf(edges, this.positions(body, 0)) };
        })());
        const lengths = lengthsOf(rest.edges, this.positions(body, frame));
        const values = new Float32Array(body.vertices).fill(rest.edges.length > 0 ? 0 : 1);
        for (let e = 0; e < lengths.length; e++) {
            const ratio = rest.lengths[e] > 0 ? lengths[e] / rest.lengths[e] : 1;
            for (const v of [rest.edges[2 * e], rest.edges[2 * e + 1]]) values[v] = Math.max(values[v], ratio);
        }
        return values;
    }

    /** Distance between the frames before and after, over the time between them [m/s]. */
    speed(body, frame) {
        const values = new Float32Array(body.vertices);
        const before = Math.max(frame - 1, 0);
        const after = Math.min(frame + 1, this.frames.length - 1);
        const time = timeOf(after) - timeOf(before);
        if (!body.moves || !(time > 0)) return values;
        const a = this.positions(body, before);
        const b = this.positions(body, after);
        for (let i = 0; i < values.length; i++) {
            values[i] = Math.hypot(b[3 * i] - a[3 * i], b[3 * i + 1] - a[3 * i + 1], b[3 * i + 2] - a[3 * i + 2]) / time;
        }
        return values;
    }

    /** z [m]. */
    height(body, frame) {
        return this.positions(body, frame).filter((_, k) => k % 3 === 2);
    }

    values(field, body, frame) {
        return this[field](body, frame);
    }

    /** Ends of the colors: over deformable bodies and some frames of the whole run, but for the last half percent. */
    range(field) {
        if (this.ranges.has(field)) return this.ranges.get(field);
        const deformable = this.bodies.filter((body) => !body.obstacle);
        const total = deformable.reduce((sum, body) => sum + body.vertices, 0);
        const count = Math.min(this.frames.length, Math.max(4, Math.min(24, Math.floor(4e6 / Math.max(total, 1)))));
        const values = [];
        for (let k = 0; k < count; k++) {
            const frame = count > 1 ? Math.round((k * (this.frames.length - 1)) / (count - 1)) : 0;
            for (const body of deformable) {
                const all = this.values(field, body, frame);
                const stride = Math.max(1, Math.floor(total / 4000));
                for (let i = 0; i < all.length; i += stride) values.push(all[i]);
            }
        }
        values.sort((a, b) => a - b);
        const at = (share) => values[Math.round(share * (values.length - 1))] ?? 0;
        let range = [at(0), at(0.995)];
        if (field === "stretch") range = [1, Math.max(at(0.995), 1.02)];
        if (field === "speed") range = [0, Math.max(at(0.995), 1e-6)];
        if (!(range[1] > range[0])) range[1] = range[0] + 1e-6;
        this.ranges.set(field, range);
        return range;
    }
}

/** What the menu offers. */
const FIELDS = [
    { id: "body", name: "Body" },
    { id: "stretch", name: "Stretch", map: "strain", unit: "", note: "edges, to their length at the start" },
    { id: "speed", name: "Speed", map: "viridis", unit: "m/s", note: "between the frames shown" },
    { id: "height", name: "Height", map: "viridis", unit: "m", note: "z" },
];
