//! The wasm part of the npm package `bowknot`: typed arrays in, typed arrays and plain objects out.
//!
//! | file | does |
//! |---|---|
//! | `arrays.rs` | typed arrays as points and elements, and back |
//! | `error.rs` | exceptions, also of panics |
//! | `messages.rs` | warnings of the libraries, kept until they are taken |
//! | `options.rs` | what JavaScript passes as an object |
//! | `scene.rs`, `meshes.rs` | scenes; meshes in place of the files that a browser does not have |
//! | `simulator.rs`, `drive.rs` | simulations; what is changed between time steps |
//! | `resolver.rs` | the collision stage |
//! | `threads.rs` | what panics on another thread (feature `threads`) |
//! | `types.ts` | types of the objects that functions return |
//!
//! Without the feature `threads` rayon runs everything on the thread that calls; with it JavaScript starts the threads by
//! `initThreadPool`. Results have the bits of the native library, since they depend on no number of threads.

// For other targets than the web there is nothing here, see the manifest.
#![cfg(target_family = "wasm")]
// Results have the same bits on every machine.
#![warn(clippy::disallowed_methods)]

mod arrays;
mod drive;
mod error;
mod meshes;
mod messages;
mod options;
mod resolver;
mod scene;
mod simulator;
#[cfg(feature = "threads")]
mod threads;

use wasm_bindgen::prelude::wasm_bindgen;

#[wasm_bindgen(typescript_custom_section)]
const TYPES: &str = include_str!("types.ts");

/// Runs when the module has been loaded, on each thread.
#[wasm_bindgen(start)]
fn start() {
    error::throw_panics();
    bowknot::messages::listen();
}

/// The version of this package.
#[wasm_bindgen]
pub fn version() -> String {
    env!("CARGO_PKG_VERSION").to_owned()
}
