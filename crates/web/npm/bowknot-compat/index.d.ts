export * from "./bowknot.js";

/** Starts the module; nothing else may be called before. */
export default function init(): Promise<void>;
