//! No file makes a reader panic, and what was read is sound.
#![no_main]

use libfuzzer_sys::fuzz_target;

fuzz_target!(|data: &[u8]| {
    bowknot_tests::fuzz::read_mesh(data);
});
