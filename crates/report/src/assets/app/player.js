// Which frame is shown: play, pause, scrub, speed. Frames are shown as they are: between two of them there are many
// accepted states, and a straight line between frames would show intersections that never were.

const ICONS = {
    play: '<path class="solid" d="M7 4.5v15l12-7.5z"/>',
    pause: '<path class="solid" d="M6.5 5h4v14h-4zM13.5 5h4v14h-4z"/>',
    first: '<path d="M6 5v14"/><path class="solid" d="M19 5v14L8.5 12z"/>',
    last: '<path d="M18 5v14"/><path class="solid" d="M5 5v14l10.5-7z"/>',
    loop: '<path d="M4 11a7 7 0 0 1 7-6h6m0 0-3-3m3 3-3 3M20 13a7 7 0 0 1-7 6H7m0 0 3 3m-3-3 3-3"/>',
    theme: '<circle cx="12" cy="12" r="8"/><path class="solid" d="M12 4a8 8 0 0 1 0 16z"/>',
    fit: '<path d="M4 9V4h5M15 4h5v5M20 15v5h-5M9 20H4v-5"/>',
    wire: '<path d="M4 5h16v14H4zM4 12h16M12 5v14M4 12l8-7M12 19l8-7"/>',
    ground: '<path d="m12 8 10 5-10 5-10-5z"/>',
};

/** Puts an icon into a button. The text is our own. */
function setIcon(button, name) {
    if (button.dataset.icon === name) return;
    button.dataset.icon = name;
    button.innerHTML = `<svg viewBox="0 0 24 24" aria-hidden="true">${ICONS[name]}</svg>`;
}

/** Simulated time over the time that passes while it is shown. */
const SPEEDS = [0.05, 0.1, 0.25, 0.5, 1, 2, 4];

/** A speed in words. Without times there is no real time, and frames are counted. */
function speedName(speed) {
    if (!meta.times) return `${show(30 * speed)} frames/s`;
    if (speed === 1) return "real time";
    return speed < 1 ? `${show(1 / speed)}× slower` : `${show(speed)}× faster`;
}

/** The speed at first: real time; slower if the run takes less than a second, which would be over too soon. */
function firstSpeed(duration) {
    return SPEEDS.findLast((speed) => speed <= 1 && duration / speed >= 1) ?? SPEEDS[0];
}

class Player {
    /** `show(frame)` draws one of `count` frames. */
    constructor(count, show) {
        this.count = count;
        this.show = show;
        this.frame = 0;
        this.loaded = 1;
        this.playing = false;
        this.loop = true;
        this.duration = timeOf(count - 1) - timeOf(0);
        this.speed = firstSpeed(this.duration);
        this.scrub = document.getElementById("scrub");
        this.clock = document.getElementById("clock");
        this.wire();
    }

    wire() {
        const on = (id, icon, action) => {
            const button = document.getElementById(id);
            setIcon(button, icon);
            button.addEventListener("click", action);
            return button;
        };
        on("first", "first", () => this.go(0));
        on("last", "last", () => this.go(this.count - 1));
        this.button = on("play", "play", () => this.toggle());
        this.loopButton = on("loop", "loop", () => this.setLoop(!this.loop));
        this.setLoop(true);
        this.scrub.max = String(Math.max(this.count - 1, 0));
        this.scrub.addEventListener("input", () => {
            this.pause();
            this.go(Number(this.scrub.value));
        });
        const speed = document.getElementById("speed");
        speed.append(...SPEEDS.map((value) => make("option", { value: String(value), textContent: speedName(value) })));
        speed.value = String(this.speed);
        speed.addEventListener("change", () => (this.speed = Number(speed.value)));
    }

    setLoop(loop) {
        this.loop = loop;
        this.loopButton.ariaPressed = String(loop);
    }

    /** Goes to a frame, or the nearest that has arrived. */
    go(frame) {
        this.frame = Math.max(0, Math.min(frame, this.loaded - 1));
        this.time = timeOf(this.frame);
        this.scrub.value = String(this.frame);
        this.scrub.style.setProperty("--done", `${this.count > 1 ? (100 * this.frame) / (this.count - 1) : 0}%`);
        const number = (text) => make("span", { textContent: text });
        const time = meta.times ? [showTime(meta.times[this.frame]), number("  ·  ")] : [];
        this.clock.replaceChildren(...time, number("frame "), String(meta.numbers[this.frame]), number(` / ${meta.last_frame}`));
        this.show(this.frame);
    }

    toggle() {
        if (this.playing) this.pause();
        else this.play();
    }

    play() {
        if (this.count < 2) return;
        if (this.frame === this.count - 1) this.go(0);
        this.playing = true;
        setIcon(this.button, "pause");
        this.before = performance.now();
        requestAnimationFrame((now) => this.tick(now));
    }

    pause() {
        this.playing = false;
        setIcon(this.button, "play");
    }

    tick(now) {
        if (!this.playing) return;
        // A tab that was hidden, or a frame that took long, does not make it jump.
        this.time += Math.min((now - this.before) / 1000, 0.1) * this.speed;
        this.before = now;
        let frame = this.frame;
        while (frame + 1 < this.count && timeOf(frame + 1) <= this.time) frame++;
        if (frame !== this.frame) {
            const { time } = this;
            this.go(frame);
            this.time = time;
        }
        const hold = Math.min(0.5, 0.15 * this.duration) * this.speed;
        if (this.frame === this.count - 1 && this.time >= timeOf(this.count - 1) + (this.loop ? hold : 0)) {
            if (this.loop) this.go(0);
            else this.pause();
        }
        requestAnimationFrame((later) => this.tick(later));
    }
}
