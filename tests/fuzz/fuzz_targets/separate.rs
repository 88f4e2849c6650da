//! Certified widths never exceed distances.
#![no_main]

use libfuzzer_sys::fuzz_target;

fuzz_target!(|data: &[u8]| {
    bowknot_tests::fuzz::separate(data);
});
