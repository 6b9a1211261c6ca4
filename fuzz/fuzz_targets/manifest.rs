//! Fuzzes the reader of the manifest in a folder of scripts.
#![no_main]

use jabuka_fuzz::folder;
use jabuka_fuzz::targets::manifest;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    manifest(folder(), bytes);
});
