//! No scene is brought to intersect, whatever its meshes and targets.
#![no_main]

use libfuzzer_sys::fuzz_target;

fuzz_target!(|data: &[u8]| {
    bowknot_tests::fuzz::resolve(data);
});
