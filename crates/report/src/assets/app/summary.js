// The run in words: what it was, what it took, whether it was checked, what the page leaves out.

const present = (column) => (column ?? []).filter((value) => value !== null);
const sum = (column) => present(column).reduce((total, value) => total + value, 0);
const mean = (column) => (present(column).length > 0 ? sum(column) / present(column).length : null);
const largest = (column) => present(column).reduce((a, b) => Math.max(a, b), -Infinity);
const smallest = (column) => present(column).reduce((a, b) => Math.min(a, b), Infinity);

/** Number of vertices of deformable bodies or of obstacles, and of their elements. */
function counts() {
    const given = meta.summary ?? {};
    const own = (key, per) => bodiesRead.filter((body) => !body.obstacle).reduce((total, body) => total + body[key].length / per, 0);
    const obstacles = bodiesRead.filter((body) => body.obstacle && body.kind !== "half-space");
    return {
        vertices: given.vertices ?? bodiesRead.filter((body) => !body.obstacle).reduce((total, body) => total + body.vertices, 0),
        triangles: given.triangles ?? own("triangles", 3),
        tets: given.tets ?? 0,
        strand_edges: given.strand_edges ?? own("strands", 2),
        particles: given.particles ?? own("particles", 1),
        obstacle_vertices: given.obstacle_vertices ?? obstacles.reduce((total, body) => total + body.vertices, 0),
    };
}

/** The bodies once read; the summary counts them. */
let bodiesRead = [];

/** How the run ended, and what a check found, each as [words, class]. */
function verdicts() {
    const { summary } = meta;
    const list = [];
    if (!summary) list.push(["not ended", "warn"]);
    else if (meta.frames_asked !== null && summary.frames < meta.frames_asked) {
        list.push([`stopped after ${summary.frames} of ${meta.frames_asked} ${noun(meta.frames_asked, "time step", "time steps")}`, "warn"]);
    }
    if (summary && Number.isFinite(summary.intersections)) {
        const found = summary.intersections;
        list.push(found === 0 ? ["checked: no intersection", "good"] : [`checked: ${show(found)} ${noun(found, "intersection", "intersections")}`, "bad"]);
    } else list.push(["not checked", ""]);
    return list;
}

/** Number of time steps that ended unsolved; 0 if the run does not say. */
const unsolvedSteps = () => present(columns.solved).filter((solved) => solved === 0).length;

function chips() {
    const { vertices, triangles, tets, strand_edges: strands, particles } = counts();
    const list = [
        [vertices, "vertex", "vertices", ""], [triangles, "triangle", "triangles", "minor"], [tets, "tet", "tets", "minor"],
        [strands, "strand edge", "strand edges", "minor"], [particles, "particle", "particles", "minor"],
    ];
    const chip = (className, ...content) => make("span", { className: `chip ${className}` }, ...content);
    const unsolved = unsolvedSteps();
    const bold = (text) => make("b", { textContent: text });
    return [
        ...verdicts().map(([words, kind]) => chip(kind, words)),
        ...(unsolved > 0 ? [chip("warn", bold(show(unsolved)), ` ${noun(unsolved, "time step", "time steps")} unsolved`)] : []),
        ...list.filter(([count]) => count > 0).map(([count, one, many, kind]) => chip(kind, bold(show(count)), ` ${noun(count, one, many)}`)),
        ...(meta.dt ? [chip("minor", "time step ", bold(show(meta.dt, "s")))] : []),
        ...(meta.preset ? [chip("minor", "preset ", bold(meta.preset))] : []),
    ];
}

function tiles() {
    const tile = (value, name, kind = "") => make("div", { className: `tile ${kind}` }, make("b", { textContent: value }), make("span", { textContent: name }));
    const list = [];
    const has = (key) => present(columns[key]).length > 0;
    if (has("two_way_steps")) list.push(tile(show(mean(columns.two_way_steps)), `two-way steps a time step, at most ${show(largest(columns.two_way_steps))}`));
    if (has("seconds.total")) list.push(tile(show(sum(columns["seconds.total"]), "s"), "wall time of all time steps"));
    if (has("min_gap_m")) list.push(tile(show(smallest(columns.min_gap_m), "m"), "smallest gap"));
    if (has("max_stretch")) list.push(tile(show(largest(columns.max_stretch)), "largest stretch"));
    if (has("remaining_m")) list.push(tile(show(largest(columns.remaining_m), "m"), "largest distance not travelled"));
    if (has("converged")) list.push(tile(`${show(100 * mean(columns.converged))} %`, "of time steps met the stopping rule of collisions"));
    if (has("solved")) list.push(tile(`${show(100 * mean(columns.solved))} %`, "of time steps are solved", unsolvedSteps() > 0 ? "warn" : "good"));
    const peak = meta.summary?.peak_memory_bytes;
    if (peak) list.push(tile(show(peak, "B"), "memory at most"));
    return make("div", { className: "tiles" }, ...list);
}

function rows(heading, list) {
    const shown = list.filter(([, value]) => value !== null && value !== undefined && value !== "");
    if (shown.length === 0) return [];
    const table = make("table", {}, ...shown.map(([name, value]) => make("tr", {}, make("td", { textContent: name }), make("td", { textContent: value }))));
    return [make("h2", { textContent: heading }), table];
}

/** Where the time went. */
function shares() {
    const stages = ["dynamics", "search", "evaluate", "backward", "forward", "other"];
    const seconds = stages.map((stage) => sum(columns[`seconds.${stage}`]));
    const total = seconds.reduce((a, b) => a + b, 0);
    if (!(total > 0)) return [];
    const bar = make("div", { className: "shares" }, ...seconds.map((s, k) => make("div", { style: `width:${(100 * s) / total}%;background:${lineColor(k)}`, title: stages[k] })));
    const table = make("table", {}, ...stages.map((stage, k) => make("tr", {},
        make("td", {}, make("i", { style: `display:inline-block;width:9px;height:9px;border-radius:2px;margin-right:7px;background:${lineColor(k)}` }), stage),
        make("td", { textContent: show(seconds[k], "s") }),
        make("td", { textContent: `${Math.round((100 * seconds[k]) / total)} %` }),
    )));
    return [make("h2", { textContent: "Wall time by stage" }), bar, table];
}

/** Mean and largest of what a time step reports. */
function averages() {
    const list = [
        ["two_way_steps", "two-way steps"], ["searches", "searches"], ["pairs", "pairs"], ["contact_rows", "contact rows"], ["edge_rows", "edge rows"],
        ["active_rows", "active rows"], ["frozen_pairs", "frozen pairs"], ["newton_iterations", "Newton iterations"], ["cg_iterations", "CG iterations"],
        ["residual_m", "residual", "m"],
        ["max_speed", "largest speed", "m/s"], ["max_step_stretch", "stretch within a step"], ["seconds.total", "wall time", "s"], ["cpu_seconds", "processor time", "s"],
    ].filter(([key]) => present(columns[key]).length > 0);
    if (list.length === 0) return [];
    const line = (tag, cells) => make("tr", {}, ...cells.map((text) => make(tag, { textContent: text })));
    const body = list.map(([key, name, unit]) => line("td", [name, show(mean(columns[key]), unit), show(largest(columns[key]), unit)]));
    return [make("h2", { textContent: "A time step" }), make("table", {}, line("th", ["", "mean", "largest"]), ...body)];
}

/** How many time steps ended unsolved, and where the first of them is out of balance. */
function unsolved() {
    const count = unsolvedSteps();
    if (count === 0) return [];
    const { step, residual_m: residual, tolerance_m: tolerance, bodies, place_m: place } = meta.summary?.first_unsolved ?? {};
    const [one, other] = bodies ?? [];
    const names = other !== undefined && other === one ? `${one} and itself` : bodies?.join(" and ");
    const worst = largest(columns.residual_m);
    return rows("Unsolved time steps", [
        ["number", show(count)], ["first", step && show(step)], ["bodies", names],
        ["place", place && `(${place.map((length) => show(length, "m")).join(", ")})`],
        ["its residual", step && show(residual, "m")], ["largest residual", worst >= 0 ? show(worst, "m") : null], ["tolerance", tolerance > 0 ? show(tolerance, "m") : null],
    ]);
}

/** The speed at which the page begins to play, and why. */
function playing() {
    const duration = timeOf(meta.numbers.length - 1) - timeOf(0);
    const speed = firstSpeed(duration);
    if (!meta.times || speed === 1) return speedName(speed);
    return `${speedName(speed)} than real time: the run lasts ${show(duration, "s")}`;
}

function fillSummary(panel) {
    const n = counts();
    const { summary } = meta;
    const count = (value) => (value > 0 ? show(value) : null);
    const extent = summary?.extent?.map((length) => show(length, "m")).join(" × ");
    const steps = summary?.frames ?? present(columns.step).length;
    const licenses = make("details", {}, make("summary", { textContent: "Libraries in this page, and their licenses" }), document.getElementById("licenses").content.cloneNode(true));
    panel.replaceChildren(
        tiles(),
        ...rows("Scene", [
            ["scene", summary?.scene ?? meta.title], ["vertices", count(n.vertices)], ["triangles", count(n.triangles)], ["tetrahedra", count(n.tets)],
            ["strand edges", count(n.strand_edges)], ["particles", count(n.particles)], ["obstacle vertices", count(n.obstacle_vertices)],
            ["extent", extent], ["time step", meta.dt && show(meta.dt, "s")], ["time steps", meta.frames_asked && meta.frames_asked !== steps ? `${steps} of ${meta.frames_asked}` : count(steps)],
            ["preset", meta.preset], ["contact distance δ", meta.delta && show(meta.delta, "m")],
        ]),
        ...rows("Machine", [
            ["machine", summary?.machine], ["collisions on", summary?.backend], ["dynamics on", summary?.dynamics_backend], ["threads", summary?.threads && show(summary.threads)],
            ["processor time", present(columns.cpu_seconds).length > 0 ? show(sum(columns.cpu_seconds), "s") : null],
        ]),
        ...rows("Check", [["every accepted state and path", verdicts().map(([words]) => words).join("; ")]]),
        ...unsolved(),
        ...shares(),
        ...averages(),
        ...rows("This page", [
            ["frames", `${meta.numbers.length} of ${meta.frames_found}${meta.stride > 1 ? `, one in ${meta.stride}` : ""}`],
            ["plays at first", playing()],
            ["positions within", show(meta.position_error, "m")],
            ["folder", meta.folder], ["made by", `Bowknot ${meta.version}`],
        ]),
        ...(meta.left_out.length > 0 ? [make("h2", { textContent: "Left out" }), make("ul", {}, ...meta.left_out.map((text) => make("li", { textContent: text })))] : []),
        licenses,
    );
}
