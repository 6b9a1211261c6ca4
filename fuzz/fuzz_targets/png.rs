//! Fuzzes the reader of PNG heightfields.
#![no_main]

use jabuka_fuzz::folder;
use jabuka_fuzz::targets::{FILES, file};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    file(folder(), FILES[2], bytes);
});
