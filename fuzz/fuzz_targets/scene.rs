//! Fuzzes the parser and the checks of scenes.
#![no_main]

use jabuka_fuzz::targets::scene;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|text: &str| scene(text));
