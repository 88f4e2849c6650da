//! No checkpoint with any numbers makes a simulation panic.
#![no_main]

use libfuzzer_sys::fuzz_target;

fuzz_target!(|data: &[u8]| {
    bowknot_tests::fuzz::restore(data);
});
