//! Fuzzes the reader of records that belong to rendered images.
#![no_main]

use jabuka_fuzz::folder;
use jabuka_fuzz::targets::record;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    record(folder(), bytes);
});
