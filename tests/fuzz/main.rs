//! Tries many inputs that are almost valid. None may cause a panic, and every error must have a message.
//!
//! By default each target gets 150 inputs. For a long run, `JABUKA_FUZZ=1000000 cargo test --test fuzz -- --nocapture` tries that number
//! on each target, `JABUKA_FUZZ_SEED` sets the first seed, and `JABUKA_FUZZ_SLOW=2` prints every input that takes more than 2 s. A failure
//! prints the seed of its input. `fuzz/` runs the same targets with cargo-fuzz.
#![allow(clippy::unwrap_used, clippy::panic, clippy::print_stdout, reason = "this is a test program")]

mod mutator;
#[allow(
    unreachable_pub,
    dead_code,
    reason = "a test program has no outside, and cargo-fuzz tries them one by one"
)]
mod targets;
mod texts;

use std::fs;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use jabuka::scene::grammar::{Kind, SCENE, TableSpec};
use mutator::{Random, mutate, mutate_lines, mutate_text};
use targets::{FILES, PLACES};

/// Runs a target with many inputs, each made from its own seed, and names the seed of an input that fails.
fn fuzz(name: &str, mut target: impl FnMut(&mut Random)) {
    let number = |variable: &str| std::env::var(variable).ok().and_then(|text| text.parse::<u64>().ok());
    let (count, first) = (number("JABUKA_FUZZ").unwrap_or(150), number("JABUKA_FUZZ_SEED").unwrap_or(1));
    let slow = number("JABUKA_FUZZ_SLOW").map_or(Duration::MAX, Duration::from_secs);
    let mut slowest = (Duration::ZERO, first);
    for seed in first..first + count {
        let begun = Instant::now();
        let tried = catch_unwind(AssertUnwindSafe(|| target(&mut Random::new(seed))));
        assert!(tried.is_ok(), "{name}: the input of JABUKA_FUZZ_SEED={seed} JABUKA_FUZZ=1 panics");
        let taken = begun.elapsed();
        if taken > slow {
            println!("{name}: the input of JABUKA_FUZZ_SEED={seed} takes {:.3} s", taken.as_secs_f64());
        }
        slowest = slowest.max((taken, seed));
    }
    println!("{name}: {count} inputs, the slowest {:.3} s (seed {})", slowest.0.as_secs_f64(), slowest.1);
}

/// Returns the project's files with this extension, to be mutated as inputs.
fn files(ending: &str) -> Vec<PathBuf> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let folders =
        ["scenes", "scenes/meshes", "tests/bad", "tests/bad/meshes", "tests/bad/csv", "tests/mistakes"];
    let entries = folders.iter().flat_map(|folder| fs::read_dir(root.join(folder)).unwrap());
    let mut files: Vec<PathBuf> = entries.map(|entry| entry.unwrap().path()).collect();
    files.retain(|path| path.extension().is_some_and(|found| found == ending));
    files.sort();
    assert!(!files.is_empty(), "{ending}");
    files
}

fn texts(ending: &str) -> Vec<String> {
    files(ending).iter().map(|path| String::from_utf8_lossy(&fs::read(path).unwrap()).into_owned()).collect()
}

#[test]
fn texts_of_scenes() {
    let seeds = texts("toml");
    fuzz("scenes", |random| {
        let (seed, other) = (random.choose(&seeds), random.choose(&seeds));
        targets::scene(&mutate_text(random, seed, other));
    });
}

#[test]
fn fixes_of_scenes_with_includes_and_settings() {
    let mut seeds = texts("toml");
    seeds.retain(|text| text.len() < 3000 && !text.contains("include"));
    let mut words = Vec::new();
    words_of(&SCENE, 6, &mut words);
    let folder = tempfile::tempdir().unwrap();
    let (mut said, mut fixes) = (0, 0);
    fuzz("scenes with includes and settings", |random| {
        let (seed, other) = (random.choose(&seeds), random.choose(&seeds));
        let text = mutate_lines(random, seed, other, &words);
        let (text, included) = match random.below(3) {
            0 => divided(random, &text),
            _ => (text, String::new()),
        };
        let settings: Vec<String> =
            (0..random.below(3)).map(|_| setting(random, seed, other, &words)).collect();
        let found = targets::texts_together(folder.path(), &text, &included, &settings);
        (said, fixes) = (said + found.0, fixes + found.1);
    });
    println!("scenes with includes and settings: {said} diagnostics, {fixes} fixes");
    assert!(said > 0 && fixes > 0);
}

/// Adds the keys of a table and of the tables in it, with the names that other programs use for them. `depth` bounds the nesting.
fn words_of(table: &'static TableSpec, depth: usize, words: &mut Vec<&'static str>) {
    for key in table.keys {
        words.push(key.name);
        words.extend(key.also);
        let inner = match &key.kind {
            Kind::Named(inner) => Some(*inner),
            kind => kind.table(),
        };
        if let (Some(inner), true) = (inner, depth > 0) {
            words_of(inner, depth - 1, words);
        }
    }
    words.sort_unstable();
    words.dedup();
}

/// Moves some lines of a scene to the file that it then includes.
fn divided(random: &mut Random, text: &str) -> (String, String) {
    let lines: Vec<&str> = text.split_inclusive('\n').collect();
    let (from, length) = (random.below(lines.len()), 1 + random.below(6));
    let to = (from + length).min(lines.len());
    let included = lines.get(from..to).unwrap_or_default().concat();
    let rest = [lines.get(..from), lines.get(to..)].map(|lines| lines.unwrap_or_default().concat()).concat();
    (format!("include = [\"{}\"]\n{rest}", targets::INCLUDED), included)
}

/// Makes a `--set` argument from a line of one scene, with the name of a table before its key in most cases.
fn setting(random: &mut Random, seed: &str, other: &str, words: &[&str]) -> String {
    let text = mutate_lines(random, other, seed, words);
    let lines: Vec<&str> = text.lines().filter(|line| line.contains('=')).collect();
    let headers: Vec<&str> =
        seed.lines().filter_map(|line| line.strip_prefix('[')?.strip_suffix(']')).collect();
    let line = if lines.is_empty() { "gravity = [0, -1, 0]" } else { *random.choose(&lines) };
    let (key, value) = line.split_once('=').unwrap_or((line, ""));
    let (key, value) = (key.trim(), value.trim());
    match random.below(3) {
        0 => format!("{key}={value}"),
        _ if headers.is_empty() => format!("simulation.{key}={value}"),
        _ => format!("{}.{key}={value}", random.choose(&headers)),
    }
}

#[test]
fn formulas_labels_and_sdl() {
    fuzz("formulas, labels, SDL", |random| {
        let (place, seed) = random.choose(&PLACES);
        let (_, other) = random.choose(&PLACES);
        targets::string(place, &mutate_text(random, seed, other));
    });
}

#[test]
fn short_texts() {
    let seeds = [
        "simulation.step=0.001",
        "body.ball.velocity=[1, 2, 3]",
        "0,50,90-100",
        "#ff8800",
        "rgb(1,2,3)",
        "a\u{202e}b\n",
    ];
    fuzz("short texts", |random| {
        let (seed, other) = (*random.choose(&seeds), *random.choose(&seeds));
        targets::argument(&mutate_text(random, seed, other));
    });
}

#[test]
fn files_that_scenes_name() {
    let table = b"t [s],body,x [m],y [m],z [m]\n0,ball,0,0,0\n1,ball,1,2,3\n2,ball,0,1,0\n".to_vec();
    let inputs = FILES.map(|(ending, scene)| {
        let mut inputs: Vec<Vec<u8>> = files(ending).iter().map(|path| fs::read(path).unwrap()).collect();
        inputs.extend((ending == "csv").then(|| table.clone()));
        (ending, scene, inputs)
    });
    let folder = tempfile::tempdir().unwrap();
    let mut read = 0;
    fuzz("meshes, heightfields, tables", |random| {
        let (ending, scene, inputs) = random.choose(&inputs);
        let (seed, other) = (random.choose(inputs).clone(), random.choose(inputs));
        // One input in eight stays unchanged; otherwise no file would be read to its end.
        let bytes = if random.below(8) == 0 { seed } else { mutate(random, &seed, other) };
        read += usize::from(targets::file(folder.path(), (ending, scene), &bytes));
    });
    assert!(read > 0, "no file was read to its end");
}

#[test]
fn manifests_and_records() {
    let folder = tempfile::tempdir().unwrap();
    let (manifest, record) = (targets::a_manifest(folder.path()), targets::a_record());
    assert!(targets::manifest(folder.path(), &manifest) && targets::record(folder.path(), &record));
    fuzz("manifests, records", |random| {
        targets::manifest(folder.path(), &mutate(random, &manifest, &record));
        targets::record(folder.path(), &mutate(random, &record, &manifest));
    });
}
