//! No arrays of an archive make a reader of problems or frames panic.
#![no_main]

use libfuzzer_sys::fuzz_target;

fuzz_target!(|data: &[u8]| {
    bowknot_tests::fuzz::arrays(data);
});
