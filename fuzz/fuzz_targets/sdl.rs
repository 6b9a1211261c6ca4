//! POV-Ray's own words, which the filter of untrusted scenes looks through.
#![no_main]

use jabuka_fuzz::targets::sdl;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|text: &str| sdl(text));
