// The worker that computes, and what it says. The page never waits for it.
"use strict";

class Client {
    /** `on` has an action for each kind of message of the worker. */
    constructor(on) {
        this.on = on;
        this.worker = null;
        // A fault on one of the worker's threads leaves the worker waiting for it.
        const name = `bowknot-${crypto.randomUUID?.() ?? Math.random()}`;
        this.faults = new BroadcastChannel(name);
        this.faults.onmessage = ({ data }) => this.worker && on.failed({ message: data });
    }

    start() {
        this.worker = new Worker(`worker.js?faults=${this.faults.name}`, { type: "module" });
        this.worker.onmessage = ({ data }) => this.on[data.is](data);
        this.worker.onerror = (event) => {
            event.preventDefault();
            const reason = event.message ? `\n${event.message}` : "";
            this.on.failed({ message: `The part of the page that computes has stopped.${reason}` });
        };
    }

    /** Ends a worker that has failed. */
    stop() {
        this.worker?.terminate();
        this.worker = null;
    }

    /** Asks for something. A scene or a file to open starts a worker if there is none. */
    tell(message) {
        if (!this.worker && message.do !== "open" && message.do !== "file") return;
        if (!this.worker) this.start();
        this.worker.postMessage(message);
    }
}
