// What the page holds: facts, columns of statistics, bodies, frames. The inverse of codec.rs.

const meta = JSON.parse(document.getElementById("meta").textContent);
const columns = JSON.parse(document.getElementById("columns").textContent);

/** Bytes of base64 text. */
function fromBase64(text) {
    if (Uint8Array.fromBase64) return Uint8Array.fromBase64(text);
    const binary = atob(text);
    const bytes = new Uint8Array(binary.length);
    for (let i = 0; i < binary.length; i++) bytes[i] = binary.charCodeAt(i);
    return bytes;
}

/** Bytes of deflated (zlib) base64 text; a damaged stream is an error. */
async function unpack(text) {
    if (text === "") return new Uint8Array(0);
    const stream = new Blob([fromBase64(text)]).stream().pipeThrough(new DecompressionStream("deflate"));
    return new Uint8Array(await new Response(stream).arrayBuffer());
}

/** Indices from their differences, the four bytes of each apart. */
function decodeIndices(bytes) {
    const count = bytes.length / 4;
    const indices = new Uint32Array(count);
    let before = 0;
    for (let i = 0; i < count; i++) {
        const z = bytes[i] | (bytes[count + i] << 8) | (bytes[2 * count + i] << 16) | (bytes[3 * count + i] << 24);
        before = (before + ((z >>> 1) ^ -(z & 1))) | 0;
        indices[i] = before;
    }
    return indices;
}

/**
 * Quantized positions of one body in one frame, x y z of each vertex, from `offset` in `bytes`; `past` are those of
 * the frame before and of the one before that.
 */
function decodePositions(bytes, offset, count, past) {
    const mode = bytes[offset];
    const order = mode & 3;
    const neighbor = (mode & 4) !== 0;
    const [last, beforeLast] = past;
    const positions = new Uint16Array(3 * count);
    for (let axis = 0; axis < 3; axis++) {
        const low = offset + 1 + 2 * axis * count;
        const high = low + count;
        let before = 0;
        for (let i = 0, k = axis; i < count; i++, k += 3) {
            const z = bytes[low + i] | (bytes[high + i] << 8);
            let miss = (z >>> 1) ^ -(z & 1);
            if (neighbor) miss += before;
            before = miss & 0xffff;
            const base = order === 0 ? 0 : order === 1 ? last[k] : 2 * last[k] - beforeLast[k];
            // The array takes it modulo 2^16, as the encoder does.
            positions[k] = base + miss;
        }
    }
    return positions;
}

/** The bodies with their elements; those that never move with their positions. */
async function readBodies() {
    return Promise.all(meta.bodies.map(async (body, index) => {
        const [triangles, strands, particles, still] = await Promise.all(
            [body.triangles, body.strands, body.particles, body.still].map(unpack),
        );
        const step = body.high.map((high, axis) => (high - body.low[axis]) / 65535);
        return {
            ...body,
            index,
            step,
            triangles: decodeIndices(triangles),
            strands: decodeIndices(strands),
            particles: decodeIndices(particles),
            still: body.moves ? null : decodePositions(still, 0, body.vertices, [null, null]),
        };
    }));
}

/**
 * Reads all frames in order, a list of quantized positions a frame, one array a body; calls `arrived(frames)` after each
 * few. Resolves to the list.
 */
async function readFrames(bodies, arrived) {
    const element = document.getElementById("frames");
    const lines = element.textContent.trimEnd().split("\n");
    // The text is not needed again; without this it stays in memory beside the numbers.
    element.remove();
    const frames = [];
    for (let index = 0; index < meta.numbers.length; index++) {
        const bytes = await unpack(lines[index]);
        lines[index] = null;
        let offset = 0;
        frames.push(bodies.map((body, b) => {
            if (!body.moves) return body.still;
            const past = [1, 2].map((back) => frames[index - back]?.[b]);
            const positions = decodePositions(bytes, offset, body.vertices, past);
            offset += 1 + 6 * body.vertices;
            return positions;
        }));
        if (offset !== bytes.length) throw new Error(`frame ${meta.numbers[index]} of the page is damaged`);
        if (index === 0 || index % 8 === 7) await arrived(frames);
    }
    return frames;
}

/** Writes a body's positions [m] into `out`. */
function dequantize(body, quantized, out) {
    const [x, y, z] = body.low;
    const [sx, sy, sz] = body.step;
    for (let k = 0; k < quantized.length; k += 3) {
        out[k] = x + quantized[k] * sx;
        out[k + 1] = y + quantized[k + 1] * sy;
        out[k + 2] = z + quantized[k + 2] * sz;
    }
}

/** Time of a frame shown [s]; without times frames are a thirtieth of a second apart. */
const timeOf = (frame) => (meta.times ? meta.times[frame] : frame / 30);

/** A time [s] with as many digits as its steps need. */
function showTime(time) {
    const digits = meta.dt ? Math.max(2, Math.min(6, Math.ceil(-Math.log10(meta.dt) - 1e-9))) : 3;
    return `${time.toFixed(digits)} s`;
}

const PREFIXES = [[1e9, "G"], [1e6, "M"], [1e3, "k"], [1, ""], [1e-3, "m"], [1e-6, "µ"], [1e-9, "n"]];

/** A number with `digits` digits, and with a unit prefix where there is a unit; a number without one has a digit more. */
function show(value, unit = "", digits = 3) {
    if (value === null || value === undefined || !Number.isFinite(value)) return "–";
    const size = Math.abs(value);
    if (unit === "") {
        if (Number.isInteger(value) || (size >= 1e4 && digits <= 3)) return Math.round(value).toLocaleString("en");
        return size >= 1e-3 ? String(Number(value.toPrecision(digits + 1))) : value.toExponential(digits - 1);
    }
    if (size === 0) return `0 ${unit}`;
    // Below the prefixes that readers know, as residuals of rounding are.
    if (size < 0.9995e-10) return `${Number(value.toPrecision(digits)).toExponential()} ${unit}`;
    const [factor, prefix] = PREFIXES.find(([factor]) => size >= 0.9995 * factor) ?? PREFIXES.at(-1);
    return `${Number((value / factor).toPrecision(digits))} ${prefix}${unit}`;
}

/** Labels of the ticks of an axis, with as many digits as it takes to tell them apart. */
function showTicks(values, unit = "") {
    const label = (value, digits) => (value === null ? "" : value === 0 ? "0" : show(value, unit, digits));
    const differ = (labels) => new Set(labels.filter((text) => text !== "")).size === values.filter((value) => value !== null).length;
    const labels = (digits) => values.map((value) => label(value, digits));
    return [3, 4, 5, 6, 7, 8].map(labels).find(differ) ?? labels(8);
}

/** The noun that belongs to a count. */
const noun = (count, one, many) => (count === 1 ? one : many);

/** An element with properties and children; text is text, never HTML. */
function make(tag, properties = {}, ...children) {
    const element = document.createElement(tag);
    for (const [key, value] of Object.entries(properties)) {
        if (key in element && key !== "style") element[key] = value;
        else element.setAttribute(key, value);
    }
    element.append(...children);
    return element;
}
