//! Panics on a thread of the pool. They end that thread, and the one that called waits for it without end; so they are
//! told on a channel that the page listens to.

use std::sync::OnceLock;
use wasm_bindgen::prelude::wasm_bindgen;
// It exports `initThreadPool`.
use wasm_bindgen_rayon as _;

/// The name of the channel.
static CHANNEL: OnceLock<String> = OnceLock::new();

#[wasm_bindgen]
extern "C" {
    type BroadcastChannel;

    #[wasm_bindgen(constructor)]
    fn new(name: &str) -> BroadcastChannel;

    #[wasm_bindgen(method, js_name = postMessage)]
    fn post_message(this: &BroadcastChannel, message: &str);
}

/// Names the `BroadcastChannel` that gets the message of a fault on another thread than the one that calls, which then
/// waits without end: end its worker. The first name stays.
#[wasm_bindgen(js_name = tellFaultsOn)]
pub fn tell_faults_on(channel: String) {
    // A second name changes nothing.
    let _first = CHANNEL.set(channel);
}

/// Tells of a fault, if this is a thread of the pool.
pub fn tell(message: &str) {
    if let Some(channel) = CHANNEL.get().filter(|_| rayon::current_thread_index().is_some()) {
        BroadcastChannel::new(channel).post_message(message);
    }
}
