//! Fuzzes the filter of POV-Ray SDL in untrusted scenes.
#![no_main]

use jabuka_fuzz::targets::sdl;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|text: &str| sdl(text));
