// Colors of bodies, of values, and of the two themes.

const { Color } = Libraries;

/** One a deformable body, told apart in both themes and by most color-blind readers. */
const PALETTE = ["#4c93d9", "#e8855b", "#5fb58a", "#b07ccb", "#dcb14a", "#4fb3bd", "#dc6f8e", "#8a97e8", "#9bb356", "#b98a66"];

/** Stops of color maps from low to high. */
const MAPS = {
    // viridis of matplotlib (S. van der Walt, N. Smith, 2015), every ninth of the way.
    viridis: ["#440154", "#472d7b", "#3b528b", "#2c728e", "#21918c", "#28ae80", "#5ec962", "#addc30", "#fde725"],
    // From a neutral blue at rest through yellow to a warning.
    strain: ["#31578f", "#4d8fb5", "#8fbfae", "#e9d98a", "#f0a352", "#dd5f3e", "#a61c3c"],
};

/** A map as 256 linear RGB triples. */
function lookup(name) {
    const stops = MAPS[name].map((text) => new Color(text));
    const table = new Float32Array(3 * 256);
    const color = new Color();
    for (let i = 0; i < 256; i++) {
        const place = (i / 255) * (stops.length - 1);
        const stop = Math.min(Math.floor(place), stops.length - 2);
        color.lerpColors(stops[stop], stops[stop + 1], place - stop);
        color.toArray(table, 3 * i);
    }
    return table;
}

/** The map as a gradient for the legend. */
const gradient = (name) => `linear-gradient(90deg, ${MAPS[name].join(", ")})`;

/** Writes the colors of `values` between `low` and `high` into `out`. */
function paint(values, low, high, table, out) {
    const factor = high > low ? 255 / (high - low) : 0;
    for (let i = 0; i < values.length; i++) {
        const place = 3 * Math.max(0, Math.min(255, Math.round((values[i] - low) * factor)));
        out[3 * i] = table[place];
        out[3 * i + 1] = table[place + 1];
        out[3 * i + 2] = table[place + 2];
    }
}

/** Colors of what is not data, by theme. */
const SCENERY = {
    dark: { obstacle: "#7d8694", ground: "#2b313b", grid: "#454e5c", wire: "#05070a", sky: "#f2f5ff", earth: "#565b66" },
    light: { obstacle: "#a9b0bb", ground: "#e6e9ee", grid: "#b9c1cc", wire: "#1b2029", sky: "#ffffff", earth: "#b9bec7" },
};

const theme = () => document.documentElement.dataset.theme;
const scenery = () => SCENERY[theme()];
const cssColor = (name) => getComputedStyle(document.documentElement).getPropertyValue(name).trim();

/** The color of a body in words of CSS. */
function bodyColor(body) {
    if (body.obstacle) return scenery().obstacle;
    const deformable = meta.bodies.filter((other) => !other.obstacle);
    return PALETTE[deformable.indexOf(meta.bodies[body.index]) % PALETTE.length];
}
