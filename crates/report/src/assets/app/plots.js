// Statistics over time, linked to the player: a line at the frame shown, a click goes there.

const { uPlot } = Libraries;

const LINES = ["#6cb0ff", "#f0a35e", "#57c794", "#d58be0", "#e6cf5c", "#ff7b7b", "#9aa6b8"];
const LINES_LIGHT = ["#1f6fd1", "#c8660f", "#16834f", "#9b3fae", "#94780a", "#c62f2f", "#667180"];
const lineColor = (k) => (theme() === "dark" ? LINES : LINES_LIGHT)[k % LINES.length];

/** Lengths [m] and times [s] below this are rounding: a logarithmic axis does not show their decades. */
const ROUNDING = 1e-12;

/**
 * What is plotted, as [column, name, how]; `mark`: points, a line otherwise. Series whose column is missing are left out, and plots without series. `idle`: so
 * are series that are always 0.
 */
const PLOTS = [
    { title: "Two-way steps and searches", series: [["two_way_steps", "steps"], ["searches", "searches"]] },
    { title: "Pairs and rows", log: true, series: [["pairs", "pairs"], ["contact_rows", "contact rows"], ["edge_rows", "edge rows"], ["active_rows", "active rows"]] },
    {
        title: "Seconds by stage", unit: "s", stacked: true,
        series: ["dynamics", "search", "evaluate", "backward", "forward", "other"].map((stage) => [`seconds.${stage}`, stage]),
    },
    { title: "Distance not travelled", unit: "m", log: true, series: [["remaining_m", "remaining"], ["stationarity_m", "stationarity"]] },
    { title: "Residual", unit: "m", log: true, idle: true, series: [["residual_m", "residual"], ["tolerance_m", "tolerance"], ["unsolved.residual_m", "unsolved", "mark"]] },
    { title: "Smallest gap", unit: "m", series: [["min_gap_m", "gap"]] },
    { title: "Largest stretch", series: [["max_stretch", "of rest length"], ["max_step_stretch", "within the step"]] },
    { title: "Energy", unit: "J", series: [] },
    { title: "Largest speed", unit: "m/s", series: [["max_speed", "speed"]] },
    { title: "Vertices asleep", idle: true, series: [["asleep_vertices", "asleep"]] },
    { title: "Linear solve", series: [["cg_iterations", "CG iterations"], ["newton_iterations", "Newton iterations"]] },
];

/** Residuals of the time steps that ended unsolved, as a column; none if all are solved, or the run does not say. */
function addUnsolved() {
    const { solved, residual_m: residuals } = columns;
    if (!residuals || !solved?.includes(0)) return;
    columns["unsolved.residual_m"] = residuals.map((residual, row) => (solved[row] === 0 ? residual : null));
}

/** The plots that this run has columns for; kinds of energy come from the columns, since bodies bring their own. */
function plotsOf() {
    const kinds = Object.keys(columns).filter((key) => key.startsWith("energy."));
    return PLOTS.map((plot) => {
        const series = plot.title === "Energy" ? kinds.map((key) => [key, key.slice("energy.".length)]) : plot.series;
        return { ...plot, series: series.filter(([key]) => key in columns && !(plot.idle && columns[key].every((value) => !value))) };
    }).filter((plot) => plot.series.length > 0);
}

/** Time of each row of the statistics [s], or the number of its time step. */
function rowTimes() {
    const own = columns.time ?? columns.step;
    return own ? own.map((time, row) => time ?? row) : [];
}

class Plots {
    /** `seek(x)` goes to a time, or to a time step where there are no times. */
    constructor(panel, seek) {
        this.panel = panel;
        this.seek = seek;
        addUnsolved();
        this.x = rowTimes();
        this.timed = "time" in columns;
        this.plots = this.x.length > 0 ? plotsOf() : [];
        this.now = 0;
        this.row = null;
        if (this.plots.length === 0) {
            panel.append(make("p", { className: "none", textContent: "This run has no statistics: stats.jsonl is missing or empty." }));
        }
        for (const plot of this.plots) this.frame(plot);
        this.build();
        new ResizeObserver(() => this.resize()).observe(panel);
    }

    /** The heading of a plot and the box that it is drawn in. */
    frame(plot) {
        plot.keys = make("div", { className: "keys" });
        plot.box = make("div");
        const heading = make("h2", {}, plot.title);
        const head = make("div", { className: "head" }, heading);
        if (!plot.stacked && plot.title !== "Energy" && plot.title !== "Largest stretch") {
            const button = make("button", { className: "log", textContent: "log", title: "Logarithmic axis", ariaPressed: String(!!plot.log) });
            button.addEventListener("click", () => {
                plot.log = !plot.log;
                button.ariaPressed = String(plot.log);
                this.draw(plot);
                this.label();
            });
            head.append(button);
        }
        this.panel.append(make("div", { className: "plot" }, head, plot.keys, plot.box));
    }

    build() {
        for (const plot of this.plots) this.draw(plot);
        this.label();
    }

    data(plot) {
        const values = plot.series.map(([key]) => columns[key]);
        if (plot.stacked) {
            const sums = [];
            const below = new Array(this.x.length).fill(0);
            for (const column of values) {
                column.forEach((value, row) => (below[row] += value ?? 0));
                sums.push([...below]);
            }
            // The whole is drawn first, its parts over it.
            return [this.x, ...sums.reverse()];
        }
        if (!plot.log) return [this.x, ...values];
        // What is far below the largest, 0 for instance, is drawn at the bottom of a logarithmic axis.
        plot.floor = this.floor(plot, values);
        return [this.x, ...values.map((column) => column.map((value) => (value === null ? null : Math.max(value, plot.floor))))];
    }

    /**
     * The lower end of a logarithmic axis: six decades below the largest value, or the smallest. Counts begin at 1, other
     * values where rounding begins.
     */
    floor(plot, values) {
        const positive = values.flat().filter((value) => value > 0);
        const high = positive.reduce((a, b) => Math.max(a, b), 0) || 1;
        const low = positive.reduce((a, b) => Math.min(a, b), high);
        const decade = Math.floor(Math.log10(Math.max(low, 1e-6 * high, ROUNDING)) + 1e-9);
        return 10 ** (plot.unit ? decade : 0);
    }

    /** Powers of ten, not too many. */
    decades(low, high) {
        const [from, to] = [Math.round(Math.log10(low)), Math.round(Math.log10(high))];
        const step = Math.ceil((to - from) / 4) || 1;
        return Array.from({ length: Math.floor((to - from) / step) + 1 }, (_, k) => 10 ** (from + k * step));
    }

    draw(plot) {
        const count = plot.series.length;
        const data = this.data(plot);
        plot.chart?.destroy();
        const isMark = (k) => plot.series[k][2] === "mark";
        const color = (k) => (isMark(k) ? cssColor("--bad") : lineColor(plot.stacked ? count - 1 - k : k));
        const muted = cssColor("--muted");
        const axis = {
            stroke: muted, font: "10.5px system-ui, sans-serif", ticks: { show: false },
            grid: { stroke: cssColor("--line"), width: 1 },
        };
        const series = plot.series.map((_, k) => ({
            stroke: color(k), width: plot.stacked ? 0 : 1.5, fill: plot.stacked ? color(k) : undefined,
            points: { show: isMark(k) || this.x.length < 3, size: 5, ...(isMark(k) && { fill: color(k) }) }, spanGaps: false,
            ...(isMark(k) && { paths: () => null }),
        }));
        const options = {
            width: Math.max(this.panel.clientWidth - 24, 100), height: 104, padding: [6, 16, 0, 0],
            legend: { show: false },
            cursor: { sync: { key: "run" }, y: false, drag: { setScale: false, x: false, y: false }, points: { show: !plot.stacked, size: 6 } },
            scales: { x: { time: false, range: (_, low, high) => this.ends(low, high) }, y: { distr: plot.log ? 3 : 1, range: this.range(plot) } },
            axes: [
                { ...axis, size: 24, gap: 5, values: (_, ticks) => ticks.map((x) => (this.timed ? `${Number(x.toPrecision(6))} s` : show(x))) },
                { ...axis, ...this.splits(plot), size: 58, gap: 4, space: 24, values: (_, ticks) => showTicks(ticks, plot.unit) },
            ],
            series: [{}, ...series],
            hooks: { setCursor: [(chart) => this.hover(chart)], ready: [(chart) => this.ready(chart, plot)] },
        };
        plot.chart = new uPlot(options, data, plot.box);
    }

    splits(plot) {
        if (!plot.log) return {};
        return { splits: (_, axis, low, high) => this.decades(low, high), filter: (_, splits) => splits };
    }

    /** Ends of the time axis: the initial state, frame 0, comes before the first row. */
    ends(low, high) {
        const from = Math.min(low ?? 0, 0);
        return [from, high > from ? high : from + 1];
    }

    /** Ends of the vertical axis. */
    range(plot) {
        const fromZero = plot.stacked || ["Pairs and rows", "Two-way steps and searches", "Smallest gap", "Largest speed", "Residual", "Linear solve"].includes(plot.title);
        return (_, low, high) => {
            if (low === null || high === null || !Number.isFinite(low)) return plot.log ? [1e-6, 1] : [0, 1];
            if (plot.log) return [plot.floor, Math.max(10 ** Math.ceil(Math.log10(high) - 1e-9), 10 * plot.floor)];
            if (fromZero) return [0, high > 0 ? 1.06 * high : 1];
            const margin = 0.06 * (high - low) || 0.05 * Math.abs(high) || 1;
            return [low - margin, high + margin];
        };
    }

    ready(chart, plot) {
        plot.line = make("div", { className: "now" });
        chart.over.append(plot.line);
        const seek = (event) => {
            const { left, width } = chart.over.getBoundingClientRect();
            const x = Math.max(0, Math.min(width, event.clientX - left));
            this.seek(chart.posToVal(x, "x"));
        };
        chart.over.addEventListener("pointerdown", (event) => {
            chart.over.setPointerCapture(event.pointerId);
            seek(event);
        });
        chart.over.addEventListener("pointermove", (event) => {
            if (event.buttons & 1) seek(event);
        });
        requestAnimationFrame(() => this.mark(plot));
    }

    /** The keys tell the values under the pointer while it is over a plot. */
    hover(chart) {
        const row = chart.cursor.left >= 0 ? chart.cursor.idx : null;
        if (row !== this.row) {
            this.row = row;
            this.label();
        }
    }

    /** Shows where the player is: a time, or a time step. */
    at(x) {
        this.now = x;
        for (const plot of this.plots) this.mark(plot);
        if (this.row === null) this.label();
    }

    mark(plot) {
        if (!plot.chart || !plot.line) return;
        const left = plot.chart.valToPos(this.now, "x");
        const inside = left >= -0.5 && left <= plot.chart.over.clientWidth + 0.5;
        plot.line.style.display = inside ? "" : "none";
        plot.line.style.transform = `translateX(${left - 0.75}px)`;
    }

    /** The row of the statistics that belongs to a time; none before the first. */
    rowAt(x) {
        let row = this.x.length - 1;
        while (row >= 0 && this.x[row] > x + 1e-9 * Math.abs(x)) row--;
        return row < 0 ? null : row;
    }

    label() {
        const row = this.row ?? this.rowAt(this.now);
        for (const plot of this.plots) {
            plot.keys.replaceChildren(...plot.series.map(([key, name, how], k) => {
                const value = row === null ? null : columns[key][row];
                return make("span", {}, make("i", { style: `background:${how === "mark" ? cssColor("--bad") : lineColor(k)}` }), name, make("b", { textContent: show(value, plot.unit) }));
            }));
        }
    }

    resize() {
        const width = Math.max(this.panel.clientWidth - 24, 100);
        for (const plot of this.plots) {
            if (plot.chart.width !== width) plot.chart.setSize({ width, height: 104 });
            requestAnimationFrame(() => this.mark(plot));
        }
    }
}
