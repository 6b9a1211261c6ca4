//! Families of tests: laws that hold for every scene, tried on scenes that are drawn at random.
//!
//! | what | where |
//! | --- | --- |
//! | a scene as data, and its text | `drawn` |
//! | random scenes | `draw` |
//! | changes of what is arbitrary in a scene: place, direction, units, names, order | `change` |
//! | runs, and how far two runs part | `motion` |
//! | the family: no result depends on what is arbitrary | `invariance` |
//! | thirty mechanisms of physics lessons | `lessons` |
//!
//! By default each family tries a few scenes. For a long run, `JABUKA_FAMILIES=10000 cargo test --test families -- --nocapture` draws that
//! number for each family, and `JABUKA_FAMILIES_SEED` sets the first seed. A failure prints its seed and the text of its scene.
#![allow(clippy::unwrap_used, clippy::panic, clippy::print_stdout, reason = "this is a test program")]

mod change;
mod draw;
mod drawn;
mod invariance;
mod lessons;
mod motion;
mod random;

use std::time::Instant;

use random::Random;

/// What became of one drawn scene.
pub(crate) enum Tried {
    /// The law holds. The number is the largest part of the tolerance that was used, from 0 to 1.
    Holds(f64),
    /// The scene cannot be run, for this reason: for example, its bodies overlap at the start, or its joints contradict each other.
    Refused(String),
    /// The law does not hold. The text says what is wrong, and has the scene.
    Broken(String),
}

/// Draws scenes, each from its own seed, and asserts that the law of the family holds for all of them. `least` is the smallest part of them
/// that can be run. Prints how many scenes were drawn.
pub(crate) fn family(name: &str, count: u64, least: f64, law: impl Fn(&mut Random) -> Tried) {
    let number = |variable: &str| std::env::var(variable).ok().and_then(|text| text.parse::<u64>().ok());
    let count = number("JABUKA_FAMILIES").unwrap_or(count);
    let first = number("JABUKA_FAMILIES_SEED").unwrap_or(1);
    let begun = Instant::now();
    let (mut refused, mut worst, mut broken) = (0, (0.0, first), Vec::new());
    for seed in first..first + count {
        match law(&mut Random::new(seed)) {
            Tried::Holds(used) if used > worst.0 => worst = (used, seed),
            Tried::Holds(_) => {}
            Tried::Refused(why) => {
                refused += 1;
                if count <= 10 {
                    println!("{name}: seed {seed} is refused: {why}");
                }
            }
            Tried::Broken(text) => broken.push((seed, text)),
        }
    }
    println!(
        "{name}: {count} scenes drawn, {refused} refused, {} broken, largest part of a tolerance {:.3} (seed {}), {:.1} s",
        broken.len(),
        worst.0,
        worst.1,
        begun.elapsed().as_secs_f64(),
    );
    for (seed, text) in broken.iter().take(3) {
        println!("{name}: JABUKA_FAMILIES=1 JABUKA_FAMILIES_SEED={seed}: {text}\n");
    }
    let seeds: Vec<u64> = broken.iter().map(|(seed, _)| *seed).collect();
    assert!(seeds.is_empty(), "{name}: seeds {seeds:?}");
    let run = (count - refused) as f64 / count.max(1) as f64;
    assert!(count < 10 || run >= least, "{name}: only {run} of the scenes can be run");
}
