//! Tests how many bytes a first visit of the playground downloads.

use std::collections::BTreeMap;
use std::process::Command;

use crate::site::folder;
use crate::support::{root, stderr};

/// The largest size of all files that a first visit downloads, compressed by brotli with quality 9, bytes: 3 % more than they had when this test
/// was written. The small pictures of the gallery are downloaded when they are seen, and do not count.
const MAX_FIRST_VISIT_BYTES: u64 = 3_400_000;

#[test]
fn a_first_visit_downloads_no_more_than_its_budget() {
    let output =
        Command::new("node").arg(root().join("tests/playground/size.mjs")).arg(folder()).output().unwrap();
    assert!(output.status.success(), "{}", stderr(&output));
    let sizes: BTreeMap<String, u64> = serde_json::from_slice(&output.stdout).unwrap();
    let mut shares: BTreeMap<&str, u64> = BTreeMap::new();
    for (name, size) in &sizes {
        let part = name.split_once('/').map_or(name.as_str(), |(folder, _)| folder);
        *shares.entry(part).or_default() += size;
    }
    let total: u64 = shares.values().sum();
    assert!(sizes.contains_key("jabuka.wasm") && sizes.contains_key("main.js"), "{sizes:#?}");
    assert!(
        total <= MAX_FIRST_VISIT_BYTES,
        "{total} bytes are more than {MAX_FIRST_VISIT_BYTES}: {shares:#?}"
    );
}
