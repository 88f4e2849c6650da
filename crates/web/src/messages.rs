//! Warnings of the libraries, kept until they are taken.

use bowknot::messages;
use js_sys::JsString;
use wasm_bindgen::prelude::wasm_bindgen;

/// The warnings since the last call, such as of vertices that were left out.
#[wasm_bindgen(js_name = takeWarnings)]
pub fn take() -> Vec<JsString> {
    messages::take().into_iter().map(|message| JsString::from(message.text)).collect()
}
