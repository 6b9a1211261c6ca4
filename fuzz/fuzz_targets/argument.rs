//! Fuzzes the parsers of command-line arguments.
#![no_main]

use jabuka_fuzz::targets::argument;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|text: &str| argument(text));
