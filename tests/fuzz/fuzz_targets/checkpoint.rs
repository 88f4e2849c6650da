//! No checkpoint makes its reader panic, and what was read is resumed.
#![no_main]

use libfuzzer_sys::fuzz_target;

fuzz_target!(|data: &[u8]| {
    bowknot_tests::fuzz::checkpoint(data);
});
