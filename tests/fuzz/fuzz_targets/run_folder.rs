//! No damage to the folder of a run makes its report or export panic.
#![no_main]

use libfuzzer_sys::fuzz_target;

fuzz_target!(|data: &[u8]| {
    bowknot_tests::fuzz::run_folder(data);
});
