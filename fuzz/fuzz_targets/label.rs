//! Fuzzes the texts of labels.
#![no_main]

use jabuka_fuzz::targets::label;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|text: &str| label(text));
