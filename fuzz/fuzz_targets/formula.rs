//! Fuzzes formulas at each place of a scene where a formula may be written.
#![no_main]

use jabuka_fuzz::targets::formula;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|text: &str| formula(text));
