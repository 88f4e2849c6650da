// The package bowknot with its module inside.
import load from "./bowknot.js";
import text from "./module.js";

export * from "./bowknot.js";

/** Starts the module; nothing else may be called before. */
export default async function init() {
    const bytes = Uint8Array.from(atob(text), (character) => character.charCodeAt(0));
    await load({ module_or_path: bytes });
}
