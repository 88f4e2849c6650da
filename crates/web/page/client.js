// The worker that computes, and what it says. The page never waits for it.
"use strict";

class Client {
    /** `on` has an action for each kind of message of the worker. */
    constructor(on) {
        this.on = on;
        this.worker = null;
    }

    /** Starts a worker, in place of one that has failed. */
    start() {
        this.worker?.terminate();
        this.worker = new Worker("worker.js", { type: "module" });
        this.worker.onmessage = ({ data }) => this.on[data.is](data);
        this.worker.onerror = (event) => {
            event.preventDefault();
            const reason = event.message ? `\n${event.message}` : "";
            this.on.failed({ message: `The part of the page that computes could not be loaded.${reason}` });
        };
    }

    tell(message, transfer = []) {
        this.worker.postMessage(message, transfer);
    }
}
