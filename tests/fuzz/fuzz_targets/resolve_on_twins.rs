//! No scene is brought to intersect by the twins of the kernels, whatever its meshes and targets.
#![no_main]

use libfuzzer_sys::fuzz_target;

fuzz_target!(|data: &[u8]| {
    bowknot_tests::fuzz::resolve_on_twins(data);
});
