// Puts the page together. `document.body.dataset` tells tools how far it is: `state` (loading, ready, failed), `frames`
// (unpacked), `plots`, `webgl` (yes, no), `errors`.
//
// The address takes what to show: #frame=12&field=stretch&theme=light&tab=summary&view=top&wire=1

const asked = new URLSearchParams(location.hash.slice(1));
const state = document.body.dataset;
const at = (id) => document.getElementById(id);

/** Says what went wrong where the picture would be. */
function notice(text, bad) {
    const box = at("notice");
    box.textContent = text;
    box.classList.toggle("bad", bad);
    box.hidden = text === "";
}

function fail(error) {
    state.errors = String(Number(state.errors ?? 0) + 1);
    state.state = "failed";
    notice(`The page cannot be shown: ${error?.message ?? error}`, true);
}
window.addEventListener("error", (event) => fail(event.error ?? event.message));
window.addEventListener("unhandledrejection", (event) => fail(event.reason));

/** The menu of colors, the legend, the bodies. */
class Colors {
    constructor(viewer, fields, player) {
        Object.assign(this, { viewer, fields, player, tables: new Map(), field: FIELDS[0] });
        const menu = at("field");
        menu.append(...FIELDS.map(({ id, name }) => make("option", { value: id, textContent: name })));
        menu.addEventListener("change", () => this.choose(menu.value));
        this.hidden = new Set();
        this.list();
    }

    choose(id) {
        this.field = FIELDS.find((field) => field.id === id) ?? FIELDS[0];
        at("field").value = this.field.id;
        this.legend();
        this.paint(true);
    }

    legend() {
        const { id, map, unit, note } = this.field;
        at("legend").replaceChildren();
        if (!map) return;
        const [low, high] = this.fields.range(id);
        at("legend").append(
            make("div", { className: "bar", style: `background:${gradient(map)}` }),
            make("div", { className: "ends" }, make("span", { textContent: show(low, unit) }), make("span", { textContent: `${id === "height" ? "" : "≥ "}${show(high, unit)}` })),
            make("div", { className: "unit", textContent: note }),
        );
    }

    /** Colors the frame shown; bodies that keep their color are left as they are unless `all`. */
    paint(all) {
        const { id, map } = this.field;
        for (const shape of this.viewer.shapes) {
            if (!shape) continue;
            if (!map || shape.body.obstacle) {
                if (all) shape.paintBody(bodyColor(shape.body));
                continue;
            }
            if (!this.tables.has(map)) this.tables.set(map, lookup(map));
            const values = this.fields.values(id, shape.body, this.player.frame);
            shape.paintValues(values, this.fields.range(id), this.tables.get(map));
        }
        this.viewer.draw();
    }

    list() {
        const { viewer } = this;
        at("bodies").replaceChildren(...viewer.bodies.map((body, index) => {
            const shown = !this.hidden.has(index);
            const color = body.kind === "half-space" ? scenery().grid : bodyColor(body);
            const button = make("button", { className: "body", ariaPressed: String(shown), title: `Show or hide: ${body.name}` },
                make("span", { className: "swatch", style: `background:${color}` }),
                make("span", { className: "name", textContent: body.name }),
                make("span", { className: "kind", textContent: body.kind }));
            button.addEventListener("click", () => {
                if (!this.hidden.delete(index)) this.hidden.add(index);
                const visible = !this.hidden.has(index);
                if (viewer.shapes[index]) viewer.shapes[index].visible = visible;
                if (viewer.grounds[index]) viewer.grounds[index].mesh.visible = visible;
                button.ariaPressed = String(visible);
                viewer.draw();
            });
            return button;
        }));
    }
}

function views(viewer) {
    const icon = (name, title, action) => {
        const button = make("button", { className: "icon", title, ariaLabel: title });
        if (name in ICONS) setIcon(button, name);
        else button.textContent = name;
        button.addEventListener("click", () => action(button));
        return button;
    };
    const wire = icon("wire", "Edges of the meshes (W)", (button) => {
        viewer.wired = !viewer.wired;
        button.ariaPressed = String(!!viewer.wired);
        for (const shape of viewer.shapes) shape?.showWire(viewer.wired, scenery().wire, viewer.group);
        viewer.draw();
    });
    at("views").append(
        icon("fit", "Fit (F)", () => viewer.view("fit")),
        icon("X", "From the side, along x", () => viewer.view("side")),
        icon("Y", "From the front, along y", () => viewer.view("front")),
        icon("Z", "From above, along z", () => viewer.view("top")),
        wire,
    );
    return { wire: () => wire.click() };
}

function tabs() {
    const choose = (name) => {
        for (const tab of ["plots", "summary"]) {
            at(`tab-${tab}`).ariaSelected = String(tab === name);
            at(tab).hidden = tab !== name;
        }
    };
    for (const tab of ["plots", "summary"]) at(`tab-${tab}`).addEventListener("click", () => choose(tab));
    if (asked.get("tab") === "summary") choose("summary");
}

function keys(actions) {
    window.addEventListener("keydown", (event) => {
        if (event.ctrlKey || event.metaKey || event.altKey || event.target.matches("select")) return;
        const action = actions[event.key.length === 1 ? event.key.toLowerCase() : event.key];
        if (!action || (event.key === " " && event.target.matches("button"))) return;
        event.preventDefault();
        action(event);
    });
}

async function start() {
    const preferred = window.matchMedia("(prefers-color-scheme: light)").matches ? "light" : "dark";
    document.documentElement.dataset.theme = ["light", "dark"].includes(asked.get("theme")) ? asked.get("theme") : preferred;
    tabs();
    notice("Unpacking…", false);
    bodiesRead = await readBodies();
    at("chips").append(...chips());
    fillSummary(at("summary"));

    let viewer = null;
    let colors = null;
    let frames = [];
    const player = new Player(meta.numbers.length, (frame) => {
        viewer?.move(frames, frame);
        if (colors?.field.map) colors.paint(false);
        plots.at(plots.timed && meta.times ? meta.times[frame] : meta.numbers[frame]);
    });
    const plots = new Plots(at("plots"), (x) => {
        player.pause();
        const places = plots.timed && meta.times ? meta.times : meta.numbers;
        let nearest = 0;
        places.forEach((place, frame) => {
            if (Math.abs(place - x) < Math.abs(places[nearest] - x)) nearest = frame;
        });
        player.go(nearest);
    });
    state.plots = String(plots.plots.length);
    state.webgl = hasWebGL() ? "yes" : "no";
    if (state.webgl === "yes") viewer = new Viewer(at("canvas"), bodiesRead);

    frames = await readFrames(bodiesRead, async (some) => {
        frames = some;
        player.loaded = some.length;
        state.frames = String(some.length);
        if (some.length === 1) {
            viewer?.shapes.forEach((shape) => shape?.paintBody(bodyColor(shape.body)));
            player.go(0);
        }
        notice(some.length < meta.numbers.length ? `Unpacking ${some.length} of ${meta.numbers.length} frames…` : "", false);
        // The browser draws in between.
        await new Promise((resolve) => setTimeout(resolve));
    });
    player.loaded = frames.length;
    state.frames = String(frames.length);
    notice("", false);

    const actions = {
        " ": () => player.toggle(), ArrowLeft: () => (player.pause(), player.go(player.frame - 1)), ArrowRight: () => (player.pause(), player.go(player.frame + 1)),
        Home: () => player.go(0), End: () => player.go(player.count - 1), l: () => player.setLoop(!player.loop), t: () => at("theme").click(),
    };
    if (viewer) {
        colors = new Colors(viewer, new Fields(bodiesRead, frames), player);
        colors.choose(asked.get("field"));
        const { wire } = views(viewer);
        Object.assign(actions, { f: () => viewer.view("fit"), w: wire });
        if (asked.has("view")) viewer.view(asked.get("view"));
        if (asked.has("wire")) wire();
    } else {
        for (const id of ["colors", "views"]) at(id).hidden = true;
        notice("This browser gives no WebGL 2, so that the run cannot be drawn.\nThe statistics follow the slider all the same.", false);
    }
    keys(actions);

    setIcon(at("theme"), "theme");
    at("theme").addEventListener("click", () => {
        document.documentElement.dataset.theme = theme() === "dark" ? "light" : "dark";
        plots.build();
        plots.at(plots.now);
        fillSummary(at("summary"));
        viewer?.theme();
        colors?.list();
        colors?.paint(true);
        for (const shape of viewer?.shapes ?? []) shape?.showWire(!!viewer.wired, scenery().wire, viewer.group);
    });
    const frame = meta.numbers.findIndex((number) => number >= Number(asked.get("frame") ?? 0));
    player.go(frame < 0 ? player.count - 1 : frame);
    // One picture has been drawn when the page calls itself ready, whether or not the tab is in front.
    viewer?.render();
    if (state.state !== "failed") state.state = "ready";
}

start().catch(fail);
