//! Tests of common beginners' mistakes: the diagnostics suggest replacements, and these make the scene valid.
//!
//! Each scene in `tests/mistakes` is a test case.

use crate::support::{jabuka, stderr, stdout};
use jabuka::Scene;
use jabuka::diagnostic::Diagnostic;

/// The largest number of rounds of suggested replacements. One mistake can hide another, so a scene may need several.
const ROUNDS: usize = 4;

#[test]
fn each_mistake_is_mended_by_what_is_suggested() {
    insta::glob!("../mistakes", "*.toml", |path| {
        let mut text = std::fs::read_to_string(path).unwrap();
        let mut shown = String::new();
        for _ in 0..ROUNDS {
            let report = match Scene::parse(&text) {
                Ok(scene) if scene.warnings.diagnostics.is_empty() => break,
                Ok(scene) => scene.warnings,
                Err(report) => report,
            };
            shown.push_str(&report.to_text(false));
            let source = report.diagnostics.iter().find_map(Diagnostic::span).unwrap().source();
            let fixed = report.fixed(source);
            assert_ne!(fixed, text, "nothing is suggested for\n{shown}");
            text = fixed;
        }
        let warnings = Scene::parse(&text).unwrap_or_else(|report| panic!("{text}\n{report}")).warnings;
        assert!(warnings.diagnostics.is_empty(), "{text}\n{warnings}");
        insta::assert_snapshot!("mended", format!("{shown}{text}"));
    });
}

/// Checks that the output of `jabuka check --format json` contains all that an editor needs to apply a replacement.
#[test]
fn editors_get_the_text_and_its_place() {
    let folder = tempfile::tempdir().unwrap();
    let scene = folder.path().join("scene.toml");
    std::fs::write(&scene, "[body.ball]\nshape.sphere.radius = \"2 m\"\ncolour = 'red'\n").unwrap();
    let check = || jabuka().arg("check").arg(&scene).args(["--format", "json"]).output().unwrap();
    let entries: Vec<serde_json::Value> = serde_json::from_str(&stdout(&check())).unwrap();
    assert_eq!(entries.len(), 2, "{entries:?}");
    let mut lines: Vec<String> =
        std::fs::read_to_string(&scene).unwrap().lines().map(str::to_owned).collect();
    for fix in entries.iter().flat_map(|entry| entry["fix"].as_array().unwrap()) {
        let number = |key: &str| usize::try_from(fix[key].as_u64().unwrap()).unwrap() - 1;
        assert_eq!(number("line"), number("end_line"));
        lines[number("line")]
            .replace_range(number("column")..number("end_column"), fix["text"].as_str().unwrap());
    }
    assert_eq!(lines, ["[body.ball]", "shape.sphere.radius = 2", "material.color = 'red'"]);
    std::fs::write(&scene, lines.join("\n")).unwrap();
    assert!(check().status.success(), "{}", stderr(&check()));
}
