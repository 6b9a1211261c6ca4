//! Measures the gravitation of many stars, as ratios to other programs.
//!
//! - `cargo bench --bench gravitation`: the sum over all pairs of 10,000 stars, against a plain double loop in C (`cc -O3`) with the same
//!   result. Both are measured alternately, because the speed of a machine drifts. The ratio of the medians counts. It should stay below
//!   0.75.
//! - `cargo bench --bench gravitation -- tree [PYTHON]`: 100,000 stars by the tree, and by REBOUND's tree if that Python has REBOUND. A
//!   step should take at most 0.7 of REBOUND's processor time at the same angle, with smaller errors.

#![allow(
    clippy::unwrap_used,
    clippy::panic,
    clippy::print_stdout,
    clippy::cast_precision_loss,
    reason = "a benchmark stops at the first surprise, and prints"
)]

#[path = "gravitation/pairs.rs"]
mod pairs;
#[path = "gravitation/tree.rs"]
mod tree;

fn main() {
    // Cargo adds the argument `--bench`, which is skipped.
    let mut words = std::env::args().skip(1).filter(|word| word != "--bench");
    match words.next().as_deref() {
        None => pairs::measure(),
        Some("tree") => tree::measure(words.next().as_deref()),
        Some(word) => panic!("`{word}`: there is `tree`"),
    }
}

fn median(mut times: Vec<f64>) -> f64 {
    times.sort_unstable_by(f64::total_cmp);
    times[times.len() / 2]
}
