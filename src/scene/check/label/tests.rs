//! Tests labels with random text.

use proptest::prelude::*;

use crate::Scene;
use crate::diagnostic::Report;

/// Returns the diagnostics of a scene with a single label that has this text.
fn said_of(label: &str) -> Report {
    let scene = format!(
        "[variables]\n'K' = 1\n[body.b]\nshape.sphere.radius = 1\n[label.note]\ntext = {}\n",
        serde_json::Value::from(label)
    );
    match Scene::parse(&scene) {
        Ok(scene) => scene.warnings,
        Err(report) => report,
    }
}

#[test]
fn a_letter_of_several_bytes_before_a_measure_is_an_error_at_its_place() {
    for (text, letter, column) in
        [("${2·b.speed}", '·', 12), ("${−b.y}", '−', 11), ("e ${2*b.x×b.x}", '×', 18)]
    {
        let report = said_of(text);
        let [error] = report.diagnostics.as_slice() else { panic!("{text}: {report}") };
        assert_eq!(error.message, format!("`{letter}` is no part of a formula"), "{text}");
        let span = error.span().unwrap();
        assert_eq!(report.sources.start(span).column, column, "{text}: {report}");
    }
}

/// Generates a piece of a label's text. Most pieces are valid syntax.
fn piece() -> impl Strategy<Value = String> {
    const KNOWN: [&str; 29] = [
        "${", "}", "{", "$", "b", "b.", ".", "b.speed", "b.é", "t", ":.2", ":", ":.2e", "K.x", "2", "·", "−",
        "×", "²", "é", "\u{301}", "🙂", "_", "(", "\"", "\\", "\n", "1e", "1e999",
    ];
    prop_oneof![9 => prop::sample::select(&KNOWN[..]).prop_map(str::to_owned), 1 => any::<String>()]
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 3000, ..ProptestConfig::default() })]

    #[test]
    fn no_label_panics(before in piece(), inner in prop::collection::vec(piece(), 0..6), after in piece()) {
        // Render the report as well: it slices the text at the spans of the errors and must not panic.
        for text in [format!("{before}${{{}}}{after}", inner.concat()), inner.concat()] {
            said_of(&text).to_text(true);
        }
    }
}
