//! A formula, wherever one may stand.
#![no_main]

use jabuka_fuzz::targets::formula;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|text: &str| formula(text));
